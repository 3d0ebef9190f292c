#include "tests/stability/atlas_run.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <iterator>

#include "demos/stillframe/atlas.h"

namespace still::test {
namespace {

using namespace command;

bool isPublished(const std::string& mode) {
    const TaaPreset* preset = findPreset(mode);
    return preset != nullptr && preset->policy.method == Method::recursive;
}

template <class T>
T orFail(Outcome<T> outcome) {
    if (!outcome) {
        FAIL(outcome.error().message);
    }
    return std::move(*outcome);
}

}  // namespace

AtlasCase atlasCase(const std::string& scene) {
    const AtlasCase* found = findAtlasCase(scene);
    if (found == nullptr) {
        FAIL("no case named " << scene);
    }
    return *found;
}

AtlasCase quickCase(const std::string& scene) {
    AtlasCase atlas = atlasCase(scene);
    for (AtlasSegment& segment : atlas.segments) {
        if (segment.ssaa_samples < 1024) {  // where each frame needs a reference of its own
            segment.ssaa_samples = 64;
        }
    }
    return atlas;
}

MeasuredScene::MeasuredScene(const AtlasCase& atlas, const std::string& modes, Size size) {
    Interruption interruption;
    FileCache cache = orFail(FileCache::open(STILL_STABILITY_CACHE, interruption));
    AtlasReport report = orFail(measureAtlas(
        {.cases = {&atlas}, .modes = orFail(parseModes(modes, "modes")), .resolution = size},
        std::move(cache)));
    results_ = std::move(report.results);
}

const SegmentMeasures& MeasuredScene::at(const std::string& segment,
                                         const std::string& mode) const {
    const auto found =
        std::find_if(results_.begin(), results_.end(), [&](const AtlasResult& result) {
            return result.segment == segment && result.preset == mode;
        });
    if (found == results_.end()) {
        FAIL("not measured: " << segment << " " << mode);
    }
    return found->measures;
}

double MeasuredScene::leadDb(const std::string& segment, const std::string& mode) const {
    return at(segment, "still").psnr - at(segment, mode).psnr;
}

double MeasuredScene::leadOfPublishedDb(const std::string& segment) const {
    double best_db = 0;
    for (const AtlasResult& result : results_) {
        if (result.segment == segment && isPublished(result.preset)) {
            best_db = std::max(best_db, result.measures.psnr);
        }
    }
    return at(segment, "still").psnr - best_db;
}

double MeasuredScene::frameLeadDb(const std::string& segment, int frame) const {
    const std::vector<FrameError>& ours = at(segment, "still").frames;
    const std::vector<FrameError>& raw = at(segment, "raw").frames;
    for (size_t i = 0; i < ours.size(); ++i) {
        if (ours[i].frame == frame) {
            return 20 * std::log10(raw[i].rms / ours[i].rms);
        }
    }
    FAIL("frame " << frame << " is not compared");
    return 0;
}

double MeasuredScene::flipAboveRaw(const std::string& segment) const {
    const std::vector<FrameError>& ours = at(segment, "still").frames;
    const std::vector<FrameError>& raw = at(segment, "raw").frames;
    double most = 0;
    for (size_t i = 0; i < ours.size(); ++i) {
        most = std::max(most, ours[i].flip - raw[i].flip);
    }
    return most;
}

}  // namespace still::test
