#pragma once
// Bytes that the stages of a frame must move, whatever the program: the scene in, planes and
// history through, the picture out. What a stage keeps for itself (transformed vertices, bins, the
// history's further frames) is not counted, so time is held against the least that memory allows.

#include <array>

#include "engine/frame_loop.h"

namespace still::command {

/// The stages in the order in which they are reported.
struct StageColumn {
    const char* name;
    double StageTimes::*time_ms;
};
constexpr std::array<StageColumn, 8> kStageColumns{{{"transform", &StageTimes::transform_ms},
                                                    {"bin", &StageTimes::bin_ms},
                                                    {"visibility", &StageTimes::visibility_ms},
                                                    {"shade", &StageTimes::shade_ms},
                                                    {"light", &StageTimes::light_ms},
                                                    {"denoise", &StageTimes::denoise_ms},
                                                    {"taa", &StageTimes::taa_ms},
                                                    {"output", &StageTimes::output_ms}}};
/// One number per stage.
using StageBytes = std::array<double, kStageColumns.size()>;

struct SceneSize {
    double triangles = 0, vertices = 0;  ///< over all objects
};
SceneSize sizeOf(const Scene& scene);

/// The bytes of the frame that `result` shows; `counters` are its.
StageBytes compulsoryBytes(const SceneSize& scene, const FrameResult& result,
                           const RasterCounters& counters, int sample_cap);

}  // namespace still::command
