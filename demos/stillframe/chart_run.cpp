#include "demos/stillframe/chart_run.h"

#include <algorithm>
#include <memory>

#include "demos/stillframe/cell.h"
#include "demos/stillframe/clock.h"
#include "demos/stillframe/pareto.h"
#include "demos/stillframe/statistics.h"
#include "postfx/flip.h"
#include "postfx/metrics.h"

namespace still::command {
namespace {

constexpr int kCompareStep = 4;
/// Medians of the same work differ by so much.
constexpr double kTimeTolerance = 0.03;

/// One mode under measurement.
struct Contender {
    const Mode* mode = nullptr;
    std::unique_ptr<FrameLoop> loop;
    std::vector<double> times_ms;
    PixelError error;
    double flip_sum = 0;
    int compared = 0;
};

class SegmentRun {
  public:
    SegmentRun(const ChartSegment& segment, const std::vector<Mode>& modes,
               const std::function<void()>& advance)
        : segment_(segment), modes_(modes), advance_(advance) {}

    Outcome<void> makeReferences(const FileCache& cache, int threads);
    /// Errors do not depend on the number of threads, so they are measured once.
    std::vector<ChartPoint> run(int threads, bool with_errors);

  private:
    void turn(Contender& contender, int frame, bool with_errors, Workers& workers);

    const ChartSegment& segment_;
    const std::vector<Mode>& modes_;
    const std::function<void()>& advance_;
    std::vector<Reference> references_;  ///< of the compared frames, in order
};

Outcome<void> SegmentRun::makeReferences(const FileCache& cache, int threads) {
    Workers workers(threads);
    ReferenceMaker maker(*segment_.content, segment_.view, segment_.reference_samples, cache,
                         workers);
    for (int frame = 0; frame < segment_.frames; ++frame) {
        if (!isCompared(segment_, frame)) {
            continue;
        }
        auto made = maker.make(frame);
        if (!made) {
            return tl::make_unexpected(made.error());
        }
        references_.push_back(std::move(*made));
        advance_();
    }
    return {};
}

void SegmentRun::turn(Contender& contender, int frame, bool with_errors, Workers& workers) {
    const bool compared = isCompared(segment_, frame);
    if (!compared && contender.mode->anti_aliasing == AntiAliasing::ssaa) {
        return;
    }
    const double start_ms = nowMs();
    const FrameResult result = contender.loop->render(frame);
    const double time_ms = nowMs() - start_ms;
    if (frame >= settledFrame(segment_.frames)) {
        contender.times_ms.push_back(time_ms);
    }
    if (compared && with_errors) {
        const auto reference = references_[size_t(contender.compared++)].picture.view();
        contender.error += pixelError(result.output, reference);
        contender.flip_sum += meanFlip(reference, result.output, {}, workers);
    }
}

std::vector<ChartPoint> SegmentRun::run(int threads, bool with_errors) {
    Workers workers(threads);
    std::vector<Contender> contenders(modes_.size());
    for (size_t i = 0; i < modes_.size(); ++i) {
        contenders[i].mode = &modes_[i];
        contenders[i].loop = std::make_unique<FrameLoop>(
            *segment_.content, modes_[i].settings(segment_.view), workers);
    }
    for (int frame = 0; frame < segment_.frames; ++frame) {
        for (Contender& contender : contenders) {
            turn(contender, frame, with_errors, workers);
        }
        advance_();
    }
    std::vector<ChartPoint> points;
    for (const Contender& contender : contenders) {
        ChartPoint point{.scene = segment_.scene,
                         .segment = segment_.name,
                         .preset = contender.mode->name,
                         .threads = threads,
                         .ms = statisticsOf(contender.times_ms).median};
        if (with_errors) {
            point.psnr = std::min(kBestPsnrDb, psnrDb(contender.error));
            point.flip = contender.flip_sum / contender.compared;
        }
        points.push_back(std::move(point));
    }
    return points;
}

/// Marks the points that nothing beats.
void markFronts(std::vector<ChartPoint>& points) {
    std::vector<Offer> by_psnr, by_flip;
    for (const ChartPoint& point : points) {
        by_psnr.push_back({point.ms, -point.psnr});
        by_flip.push_back({point.ms, point.flip});
    }
    for (size_t i : paretoFront(by_psnr, kTimeTolerance)) {
        points[i].psnr_front = true;
    }
    for (size_t i : paretoFront(by_flip, kTimeTolerance)) {
        points[i].flip_front = true;
    }
}

}  // namespace

int settledFrame(int frames) {
    return frames / 4;
}

bool isCompared(const ChartSegment& segment, int frame) {
    const int since = frame - settledFrame(segment.frames);
    return since >= 0 && since % kCompareStep == 0;
}

Outcome<std::vector<ChartPoint>> measureSegment(const ChartSegment& segment,
                                                const std::vector<Mode>& modes,
                                                const std::vector<int>& threads,
                                                const FileCache& cache,
                                                const std::function<void()>& advance) {
    SegmentRun run(segment, modes, advance);
    if (auto made = run.makeReferences(cache, threads.back()); !made) {
        return tl::make_unexpected(made.error());
    }
    std::vector<ChartPoint> all;
    for (size_t t = 0; t < threads.size(); ++t) {
        std::vector<ChartPoint> points = run.run(threads[t], t == 0);
        for (size_t i = 0; t > 0 && i < points.size(); ++i) {
            points[i].psnr = all[i].psnr;
            points[i].flip = all[i].flip;
        }
        markFronts(points);
        all.insert(all.end(), points.begin(), points.end());
    }
    return all;
}

int chartSteps(const ChartSegment& segment, size_t thread_counts) {
    int steps = segment.frames * int(thread_counts);
    for (int frame = 0; frame < segment.frames; ++frame) {
        steps += isCompared(segment, frame) ? 1 : 0;
    }
    return steps;
}

}  // namespace still::command
