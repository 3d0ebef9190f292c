#pragma once
// Ambient occlusion out of the depth plane, for scenes that need no rays: at every other pixel in
// x and y some random places above the surface are held against what is seen there (Mittring
// 2007, along rays). What is hidden from the eye, or outside of the picture, occludes
// nothing.

#include "rasterizer/image.h"
#include "rasterizer/internal/light_scene.h"
#include "rasterizer/internal/light_setup.h"

namespace still::internal {

class ScreenOcclusion {
  public:
    /// Of a G-buffer with normals. `distance` in world units.
    void find(const GBuffer& gbuffer, const FrameView& view, float distance,
              const PixelNumbers& numbers, Workers& workers);

    /// How much of the hemisphere over a pixel's surface is open, 0 … 1: of the values found around
    /// it, those of the same surface.
    float openAt(const GBuffer& gbuffer, int x, int y) const;

  private:
    int offset_x_ = 0, offset_y_ = 0;  ///< of the pixel in its 2 × 2 that was looked at
    Image<uint8_t> open_;              ///< kRays = all
};

}  // namespace still::internal
