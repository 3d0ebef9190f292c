#pragma once
// Times of the peer's passes, from a finished pipeline to a finished pipeline.

#include <vector>

#include "tests/bench/peer/gpu_scene.h"
#include "tests/bench/peer/passes.h"

namespace still::peer {

constexpr int kMultisamples = 4;

/// Milliseconds, one entry a frame; `threads` of the driver at work.
struct PeerTimes {
    std::vector<double> depth_ms;    ///< depth alone
    std::vector<double> lambert_ms;  ///< the G-buffer with Lambert × texture alone
    std::vector<double> gbuffer_ms;  ///< the G-buffer
    std::vector<double> taa_ms;      ///< the resolve
    std::vector<double> output_ms;   ///< encoding to 8 bits
    std::vector<double> msaa_ms;     ///< the G-buffer with kMultisamples, and averaging its colour
    std::vector<double> frame_ms;    ///< G-buffer and resolve, finished only at the end of both
};

/// A scene under one motion, its drawer and its planes.
struct PeerFrames {
    const Gl& gl;
    const Scene& scene;
    GpuScene& drawer;
    Passes& passes;
    int width = 0, height = 0;

    /// Draws frame `frame` and takes it into the history.
    Result<void> render(int frame, Pass pass = Pass::gbuffer);
};

/// Takes the times of `frames` ≥ 1 frames after some that are not measured, kind by kind. Targets
/// for multisampling are large, so that is measured only when asked for.
Result<PeerTimes> measure(PeerFrames& peer, int frames, bool multisampling);

}  // namespace still::peer
