#include "demos/stillframe/cell.h"

#include <algorithm>

#include "demos/stillframe/bench_scaling.h"
#include "demos/stillframe/case_loop.h"
#include "demos/stillframe/segment_meter.h"

namespace still::command {
namespace {

/// From one run to the next: as many as no run has, and no period of the jitter.
constexpr int kTrailRunSamples = 509;

const CaseFrame* findFrame(const std::vector<CaseFrame>& frames, int frame) {
    const auto found = std::find_if(frames.begin(), frames.end(),
                                    [&](const CaseFrame& each) { return each.frame == frame; });
    return found == frames.end() ? nullptr : &*found;
}

bool isWithin(const AtlasSegment& segment, int frame) {
    return frame >= segment.first && frame <= segment.last;
}

int lastFrame(const AtlasCase& atlas) {
    int last = 0;
    for (const AtlasSegment& segment : atlas.segments) {
        last = std::max(last, segment.last);
    }
    return last;
}

/// Steps through the frames of a case.
class CellRun {
  public:
    CellRun(const PreparedCase& prepared, const Mode& mode)
        : prepared_(prepared),
          mode_(mode),
          loop_(*prepared.atlas, prepared.scene, mode.settings(prepared.view)) {
        for (const AtlasSegment& segment : prepared.atlas->segments) {
            meters_.emplace_back(segment, prepared.atlas->event_frame);
        }
    }
    void run() {
        const int first = prepared_.atlas->segments.front().first;
        const int last = lastFrame(*prepared_.atlas);
        for (int frame = lastCut(prepared_.scene, {}, first); frame <= last; ++frame) {
            runFrame(frame);
        }
    }
    Outcome<std::vector<SegmentMeasures>> finish();

  private:
    void runFrame(int frame);
    bool isCompared(int frame) const;
    /// The frame begins a new picture: a cut, or another size.
    bool isCut(int frame) const;
    /// Samples that a history has taken when it comes to the frame.
    int samplesBefore(int frame) const;
    std::vector<double> startedAnew(size_t segment) const;
    double trail(size_t segment) const;

    const PreparedCase& prepared_;
    const Mode& mode_;
    CaseLoop loop_;
    std::vector<SegmentMeter> meters_;
};

bool CellRun::isCompared(int frame) const {
    return std::any_of(prepared_.segments.begin(), prepared_.segments.end(),
                       [&](const auto& frames) { return findFrame(frames, frame) != nullptr; });
}

bool CellRun::isCut(int frame) const {
    return lastCut(prepared_.scene, {}, frame) == frame || prepared_.atlas->resize_frame == frame;
}

int CellRun::samplesBefore(int frame) const {
    return isCut(frame) ? 0 : frame - lastCut(prepared_.scene, {}, frame);
}

void CellRun::runFrame(int frame) {
    if (!mode_.temporal() && !isCompared(frame)) {
        return;
    }
    const double start_ms = threadTimeMs();
    const FrameResult result = loop_.render(frame);
    const double time_ms = threadTimeMs() - start_ms;
    for (size_t i = 0; i < meters_.size(); ++i) {
        if (isWithin(prepared_.atlas->segments[i], frame)) {
            meters_[i].addTime(time_ms);
        }
        if (const CaseFrame* compared = findFrame(prepared_.segments[i], frame)) {
            meters_[i].compare(*compared, result.output, isCut(frame));
        }
    }
}

/// coarseRms() of the compared frames from the event on, of a run that begins at the event and
/// takes the same samples.
std::vector<double> CellRun::startedAnew(size_t segment) const {
    const AtlasCase& atlas = *prepared_.atlas;
    const AtlasSegment& within = atlas.segments[segment];
    if (!atlas.event_frame || !isWithin(within, *atlas.event_frame)) {
        return {};
    }
    Scene scene = prepared_.scene;
    scene.cuts = {*atlas.event_frame};
    FrameSettings settings = mode_.settings(prepared_.view);
    settings.first_sample = samplesBefore(*atlas.event_frame);
    CaseLoop loop(atlas, scene, settings);
    std::vector<double> errors;
    for (int frame = *atlas.event_frame; frame <= within.last; ++frame) {
        const FrameResult result = loop.render(frame);
        if (const CaseFrame* compared = findFrame(prepared_.segments[segment], frame)) {
            errors.push_back(coarseRms(result.output, compared->reference.picture.view()));
        }
    }
    return errors;
}

/// What is left behind in the segment's frames, in the mean of several runs.
double CellRun::trail(size_t segment) const {
    const std::vector<CaseFrame>& compared = prepared_.segments[segment];
    std::vector<PictureMean> means(compared.size());
    for (int run = 0; run < kTrailRuns; ++run) {
        FrameSettings settings = mode_.settings(prepared_.view);
        settings.first_sample = run * kTrailRunSamples;
        CaseLoop loop(*prepared_.atlas, prepared_.scene, settings);
        const int first = lastCut(prepared_.scene, {}, compared.front().frame);
        for (int frame = first; frame <= compared.back().frame; ++frame) {
            const CaseFrame* wanted = findFrame(compared, frame);
            if (wanted != nullptr || mode_.temporal()) {
                const FrameResult result = loop.render(frame);
                if (wanted != nullptr) {
                    means[size_t(wanted - compared.data())].add(result.output);
                }
            }
        }
    }
    std::vector<ImageView<const Rgb8>> references;
    double most = 0;
    for (size_t i = 0; i < compared.size(); ++i) {
        references.push_back(compared[i].reference.picture.view());
        most = std::max(most, trailCodes(references, means[i]));
    }
    return most;
}

Outcome<std::vector<SegmentMeasures>> CellRun::finish() {
    std::vector<SegmentMeasures> results;
    for (size_t i = 0; i < meters_.size(); ++i) {
        auto measures = meters_[i].finish(startedAnew(i));
        if (!measures) {
            return tl::make_unexpected(measures.error());
        }
        if (prepared_.atlas->trail) {
            measures->trail = trail(i);
        }
        results.push_back(std::move(*measures));
    }
    return results;
}

}  // namespace

std::vector<int> comparedFrames(const AtlasSegment& segment) {
    std::vector<int> frames;
    for (int frame = segment.first; frame <= segment.last; frame += segment.step) {
        frames.push_back(frame);
    }
    return frames;
}

Size sizeAt(const AtlasCase& atlas, Size full, int frame) {
    const bool half = atlas.resize_frame && frame < *atlas.resize_frame;
    return half ? Size{std::max(1, full.width / 2), std::max(1, full.height / 2)} : full;
}

void findRevealed(PreparedCase& prepared) {
    FrameSettings settings = prepared.view;
    settings.anti_aliasing = AntiAliasing::none;
    settings.planes.motion = true;
    CaseLoop loop(*prepared.atlas, prepared.scene, settings);
    for (size_t i = 0; i < prepared.segments.size(); ++i) {
        const AtlasSegment& segment = prepared.atlas->segments[i];
        RevealMask mask;
        // One more, of which only the surfaces are taken.
        const int first = std::max(0, segment.first - kRevealFrames - 1);
        for (int frame = first; frame <= segment.last; ++frame) {
            const bool cut = frame == first || lastCut(prepared.scene, {}, frame) == frame;
            const auto revealed = mask.next(*loop.render(frame).gbuffer, cut);
            for (CaseFrame& compared : prepared.segments[i]) {
                if (compared.frame == frame) {
                    compared.revealed.resize(revealed.width, revealed.height);
                    for (int y = 0; y < revealed.height; ++y) {
                        std::copy_n(revealed.row(y), revealed.width,
                                    compared.revealed.view().row(y));
                    }
                }
            }
        }
    }
}

Outcome<std::vector<SegmentMeasures>> measureCell(const PreparedCase& prepared, const Mode& mode) {
    CellRun run(prepared, mode);
    run.run();
    return run.finish();
}

}  // namespace still::command
