#include "demos/stillframe/bench_run.h"

#include <algorithm>
#include <memory>
#include <numeric>

#include "demos/stillframe/bench_scaling.h"
#include "demos/stillframe/clock.h"
#include "demos/stillframe/peak_memory.h"
#include "engine/hash.h"
#include "engine/jitter.h"

namespace still::command {
namespace {

constexpr int kRecordedFrames = 8;
constexpr int kSimulatedWorkers[] = {1, 2, 4, 8, 16, 32, 64};

uint64_t sumOf(ImageView<const uint8_t> plane) {
    uint64_t sum = 0;
    for (int y = 0; y < plane.height; ++y) {
        sum = std::accumulate(plane.row(y), plane.row(y) + plane.width, sum);
    }
    return sum;
}

bool isFinished(ImageView<const uint8_t> samples) {
    return sumOf(samples) == uint64_t(samples.width) * uint64_t(samples.height) * kTaaPeriod;
}

/// One number of threads.
class Contender {
  public:
    Contender(const BenchCase& bench, int threads)
        : workers_(threads), loop_(*bench.content, bench.settings, workers_) {
        result_.scene = bench.scene;
        result_.motion = bench.motion;
        result_.triangles = bench.content->triangleCount();
        result_.settings = bench.settings;
        result_.threads = threads;
        frozen_ = result_;
        frozen_.motion = "frozen";
        size_ = sizeOf(*bench.content);
    }

    void render(int frame, bool counts) {
        const double start_ms = nowMs();
        const FrameResult shown = loop_.render(frame);
        const double total_ms = nowMs() - start_ms;
        if (counts) {
            BenchResult& result = finished_ ? frozen_ : result_;
            result.frames.push_back({frame, shown.times, total_ms, hashPlane(shown.output)});
            note(shown, result);
        }
        finished_ = result_.motion == "still" && isFinished(shown.sample_count);
    }

    /// What was measured: one result, or two.
    void take(std::vector<BenchResult>& results) {
        for (BenchResult* result : {&result_, &frozen_}) {
            if (!result->frames.empty()) {
                results.push_back(std::move(*result));
            }
        }
    }

  private:
    void note(const FrameResult& shown, BenchResult& result) const {
        const RasterCounters& counters = loop_.counters();
        const auto tiles_along = [](int pixels) {
            return uint64_t(pixels + kTileSize - 1) / kTileSize;
        };
        result.counters = counters;
        result.tiles_skipped =
            tiles_along(shown.output.width) * tiles_along(shown.output.height) - counters.tiles;
        result.history_taps = counters.tiles == 0 ? 0 : sumOf(shown.sample_count);
        result.bytes = compulsoryBytes(size_, shown, counters, int(kTaaPeriod));
    }

    Workers workers_;
    FrameLoop loop_;
    SceneSize size_;
    BenchResult result_, frozen_;
    bool finished_ = false;
};

/// Renders some more frames on one thread, with a note of every task.
Scaling measureScaling(const BenchCase& bench) {
    Workers workers(1);
    FrameSettings settings = bench.settings;
    settings.clock_ms = {};
    settings.ticks = nullptr;
    FrameLoop loop(*bench.content, settings, workers);
    const int first = warmUpFrames(bench.frames);
    const int end = std::min(bench.frames, first + kRecordedFrames);
    WorkRecorder recorder;
    Scaling scaling;
    for (int workers_count : kSimulatedWorkers) {
        scaling.simulated_ms.emplace_back(workers_count, 0.0);
    }
    for (int frame = 0; frame < end; ++frame) {
        if (frame < first) {
            loop.render(frame);
            continue;
        }
        workers.observe(&recorder);
        recorder.beginFrame();
        loop.render(frame);
        const FrameWork work = recorder.endFrame();
        const double share = 1.0 / (end - first);
        scaling.work_ms += share * workMs(work);
        scaling.span_ms += share * spanMs(work);
        scaling.serial_ms += share * work.serial_ms;
        for (auto& [count, time_ms] : scaling.simulated_ms) {
            time_ms += share * simulatedMs(work, count);
        }
    }
    return scaling;
}

}  // namespace

int warmUpFrames(int frames) {
    return frames / 4;
}

std::vector<BenchResult> measureCase(const BenchCase& bench) {
    std::vector<BenchResult> results;
    resetPeakMemory();
    {
        std::vector<std::unique_ptr<Contender>> contenders;
        for (int threads : bench.threads) {
            contenders.push_back(std::make_unique<Contender>(bench, threads));
        }
        for (int frame = 0; frame < bench.frames; ++frame) {
            for (const auto& contender : contenders) {
                contender->render(frame, frame >= warmUpFrames(bench.frames));
            }
        }
        for (const auto& contender : contenders) {
            contender->take(results);
        }
    }
    const uint64_t peak_bytes = peakMemoryBytes();
    const Scaling scaling = measureScaling(bench);
    for (BenchResult& result : results) {
        result.peak_bytes = bench.threads.size() == 1 ? peak_bytes : 0;
        if (result.motion == bench.motion) {
            result.scaling = scaling;
        }
    }
    return results;
}

}  // namespace still::command
