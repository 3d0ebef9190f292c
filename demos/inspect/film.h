#pragma once
// What all panes of a session look at: the scene, and which camera and instant each frame had.

#include <vector>

#include "engine/scene.h"
#include "engine/timeline.h"

namespace still::inspect {

struct Film {
    Scene scene{};
    std::vector<WindingBits> windings{};  ///< of the scene's meshes
    bool noisy = false;      ///< frames of a film that stands differ: stochastic transparency, sampled light
    CameraFile recording{};  ///< one entry per drawn frame

    int lastFrame() const { return int(recording.frames.size()) - 1; }
    CameraChoice camera() const { return {.file = &recording}; }
    /// Nothing moved between the frame before and this one, or there is none before.
    bool stands(int frame) const;
    /// Both show the same instant from the same place.
    bool sameView(int frame, int other) const;
};

}  // namespace still::inspect
