#include "demos/stillframe/race.h"

#include <algorithm>
#include <memory>

#include "demos/stillframe/bench_scaling.h"
#include "demos/stillframe/case_loop.h"
#include "demos/stillframe/statistics.h"

namespace still::command {
namespace {

class Race {
  public:
    Race(const AtlasCase& atlas, const Scene& scene, const std::vector<Mode>& modes, size_t base,
         Size size)
        : atlas_(atlas), scene_(scene), modes_(modes), base_(base), times_ms_(modes.size()) {
        for (const Mode& mode : modes) {
            loops_.push_back(std::make_unique<CaseLoop>(
                atlas, scene, mode.settings({.width = size.width, .height = size.height})));
        }
    }
    std::vector<SegmentTimes> run();

  private:
    void renderFrame(int frame, bool counts);
    SegmentTimes result() const;

    const AtlasCase& atlas_;
    const Scene& scene_;
    const std::vector<Mode>& modes_;
    size_t base_;
    std::vector<std::unique_ptr<CaseLoop>> loops_;
    std::vector<std::vector<double>> times_ms_;  ///< of each mode, for the segment's frames
};

/// Another mode begins in each frame, so that none is always next to the same one.
void Race::renderFrame(int frame, bool counts) {
    for (size_t turn = 0; turn < modes_.size(); ++turn) {
        const size_t i = (turn + size_t(frame)) % modes_.size();
        if (!counts && !modes_[i].temporal()) {
            continue;
        }
        const double start_ms = threadTimeMs();
        loops_[i]->render(frame);
        if (counts) {
            times_ms_[i].push_back(threadTimeMs() - start_ms);
        }
    }
}

SegmentTimes Race::result() const {
    const std::vector<double>& base_ms = times_ms_[base_];
    if (base_ms.size() < 2) {
        return std::nullopt;
    }
    std::vector<RaceTime> results;
    for (const std::vector<double>& mode_ms : times_ms_) {
        std::vector<double> shares;
        for (size_t i = 0; i < mode_ms.size(); ++i) {
            shares.push_back(mode_ms[i] / base_ms[i]);
        }
        results.push_back({statisticsOf(mode_ms).median, statisticsOf(shares).median});
    }
    return results;
}

std::vector<SegmentTimes> Race::run() {
    std::vector<SegmentTimes> results;
    int frame = lastCut(scene_, {}, atlas_.segments.front().first);
    for (const AtlasSegment& segment : atlas_.segments) {
        for (auto& mode_ms : times_ms_) {
            mode_ms.clear();
        }
        for (; frame <= segment.last; ++frame) {
            renderFrame(frame, frame >= segment.first);
        }
        results.push_back(result());
    }
    return results;
}

}  // namespace

std::vector<SegmentTimes> race(const AtlasCase& atlas, const Scene& scene,
                               const std::vector<Mode>& modes, size_t base, Size size) {
    return Race(atlas, scene, modes, base, size).run();
}

}  // namespace still::command
