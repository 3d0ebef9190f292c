#pragma once
// The measurements of `stillframe bench`: one scene in one motion, with one or several numbers of
// threads.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "demos/stillframe/bench_traffic.h"
#include "demos/stillframe/options.h"

namespace still::command {

/// How a frame divides among workers; means over some frames. See bench_scaling.h.
struct Scaling {
    double work_ms = 0, span_ms = 0, serial_ms = 0;
    std::vector<std::pair<int, double>> simulated_ms;  ///< workers, time
};

struct BenchResult {
    std::string scene, motion;
    uint64_t triangles = 0;
    FrameSettings settings;
    int threads = 1;
    struct Frame {
        int frame = 0;
        StageTimes times;
        double total_ms = 0;
        uint64_t hash = 0;  ///< of the 8-bit picture
    };
    std::vector<Frame> frames;

    // Of the last frame.
    RasterCounters counters;
    uint64_t tiles_skipped = 0;
    uint64_t history_taps = 0;  ///< samples that the pixels were made from
    StageBytes bytes{};

    /// Of the whole process, since the scene was loaded; 0 when others were measured beside it.
    uint64_t peak_bytes = 0;
    std::optional<Scaling> scaling;
};

struct BenchCase {
    std::string scene, motion;
    const Scene* content = nullptr;
    FrameSettings settings;  ///< size, SIMD target
    std::vector<int> threads;
    int frames = 72;
};

/// Renders the frames with each number of threads, in turns frame by frame so that whatever else
/// the machine does falls on all of them. Times count from a quarter of the frames on; those in
/// which the picture was finished before they began are a result of their own, motion "frozen".
std::vector<BenchResult> measureCase(const BenchCase& bench);

/// Frames that measureCase() does not report.
int warmUpFrames(int frames);

}  // namespace still::command
