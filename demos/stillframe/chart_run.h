#pragma once
// The measurements of a chart: what a frame costs, and how far it is from its reference.

#include <functional>
#include <string>
#include <vector>

#include "demos/stillframe/mode.h"
#include "demos/stillframe/reference_cache.h"

namespace still::command {

struct ChartPoint {
    std::string scene, segment, preset;
    int threads = 1;
    double ms = 0;    ///< median of the whole frame
    double psnr = 0;  ///< dB, of the mean squared error, at most kBestPsnrDb
    double flip = 0;  ///< mean
    bool psnr_front = false, flip_front = false;  ///< among its scene, segment and threads
};

/// Frames of a scene that belong together.
struct ChartSegment {
    std::string scene, name;
    const Scene* content = nullptr;
    FrameSettings view;  ///< size and camera
    int frames = 64;
    int reference_samples = 256;
};

/// Frames that are compared, and frames whose time counts, begin here: histories have settled.
int settledFrame(int frames);

/// True for the frames of a segment that are compared with a reference.
bool isCompared(const ChartSegment& segment, int frame);

/// Measures all modes with each number of threads. Within one number, the modes take turns frame by
/// frame, so that whatever else the machine does falls on all of them. Supersampling renders the
/// compared frames only. `advance` is called once for each reference and each frame.
Outcome<std::vector<ChartPoint>> measureSegment(const ChartSegment& segment,
                                                const std::vector<Mode>& modes,
                                                const std::vector<int>& threads,
                                                const FileCache& cache,
                                                const std::function<void()>& advance);

/// Calls of `advance` that measureSegment() will make.
int chartSteps(const ChartSegment& segment, size_t thread_counts);

}  // namespace still::command
