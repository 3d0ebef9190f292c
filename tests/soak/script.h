#pragma once
// What happens in a soak run, drawn from a seed: one life after the other of a frame loop, and what
// the camera, the picture's size and the rest do meanwhile.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/frame_loop.h"

namespace still::soak {

/// How frames are made, which must not show.
struct Engine {
    SimdTarget simd = SimdTarget::scalar;
    int threads = 1;
    Schedule schedule = Schedule::pooled;
    Shading shading = Shading::deferred;

    std::string text() const;
};

/// One frame.
struct Step {
    CameraFileFrame camera;
    int width = 0, height = 0;
    bool resize = false;   ///< to this size, which may be the one there is
    int ratio_fx8 = 0;     ///< set before the frame; 0: stays
    bool repeats = false;  ///< nothing differs from the frame before
    /// The second loop is destroyed and another one, with this engine, goes on. Only at cuts.
    bool restart = false;
    Engine engine{};
    bool move = false;  ///< the first loop is moved to another place
};

struct Life {
    std::string scene;
    std::string policy;  ///< for people
    FrameSettings settings;
    bool alone = false;  ///< no threads beside the calling one
    Engine engines[2];
    std::vector<Step> steps;  ///< of one cycle, which begins with a cut
    int cycles = 3;           ///< how often they happen, the frames' numbers going on

    std::string text() const;
};

/// Life `number` of the run with this seed.
Life makeLife(uint64_t seed, int number);

/// Of all lives. They stay, so they are made before memory is watched.
void makeScenes();
const Scene& sceneNamed(const std::string& name);

}  // namespace still::soak
