#pragma once
// What a scene asks of the rasterizer.

#include <vector>

#include "engine/timeline.h"
#include "rasterizer/rasterizer.h"

namespace still {

/// The rasterizer's own word on each surface of frame `frame` ≥ 0: surface s is element s − 1, in
/// the order of the objects' mesh parts. Nothing is drawn.
std::vector<SurfaceWork> sceneWork(const Scene& scene, const CameraChoice& choice, int frame);

}  // namespace still
