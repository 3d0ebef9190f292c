#pragma once
// Shadow map of the sun (Williams 1978): what the sun sees, as heights over the plane across its
// direction, looked up along a ray at random places, so that shadows of a disc grow softer with
// the way to what casts them. For scenes that need no exact shadows: of what lies over each other
// the map knows the topmost only, and details of less than a texel are lost.

#include <vector>

#include "rasterizer/internal/light_scene.h"
#include "rasterizer/rasterizer.h"

namespace still::internal {

class SunMap {
  public:
    /// Draws what the sun of `list` sees, unless it is as it was. A texel is about as large as the
    /// scene's shadow is in a picture of `pixels` across.
    void update(const DrawList& list, int pixels, SimdTarget simd, Workers& workers);

    /// Whether something is in the way of a ray towards the sun's disc. `random` spreads the places
    /// that are looked at.
    bool blocks(const LitPoint& point, const Ray& ray, const RandomPair& random) const;

  private:
    /// Of the scene, along the axes of the map.
    struct Box {
        double low[3], high[3];
    };
    Box boundsOf(const DrawList& list, SimdTarget simd);
    void place(const Box& box, int size);
    bool isOf(const DrawList& list, int size) const;
    void remember(const DrawList& list);

    // What the map was drawn of.
    std::vector<Affine> transforms_;
    std::vector<Material> materials_;
    DirectionalLight sun_;
    const Mesh* meshes_ = nullptr;

    Float3 across_u_{}, across_v_{}, up_{};
    // Of the map's corner, and heights: the lowest, and up to the highest. In the world, as a
    // texel.
    float origin_u_ = 0, origin_v_ = 0, base_ = 0, range_ = 1, texel_ = 1;
    FrameView view_;
    Rasterizer rasterizer_;
    GBuffer drawn_;
};

}  // namespace still::internal
