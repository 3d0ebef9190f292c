#pragma once
// Once per frame: the scene as the light sampler wants it, and what of it changed.

#include <vector>

#include "rasterizer/internal/light_scene.h"
#include "rasterizer/internal/matrix.h"
#include "rasterizer/workers.h"

namespace still::internal {

/// Trees of meshes, built once; the tree of instances, built anew when one of them stands
/// elsewhere.
class TreeKeeper {
  public:
    void update(const DrawList& list, SceneTree& tree, Workers& workers);

  private:
    const Mesh* meshes_of_ = nullptr;
    std::vector<MeshTree> meshes_;
    std::vector<Affine> transforms_;  ///< of the instances that the tree is of
};

/// Lights, surfaces; not the trees.
void setUpLights(const DrawList& list, LightScene& scene);

/// Whether rays are needed at all.
bool traces(const SampledLight& sampled);

/// What decides about the light of a surface, apart from where instances stand.
struct LightState {
    Lighting lighting;
    std::vector<Material> materials;

    void take(const DrawList& list);
    bool same(const DrawList& list) const;
};

/// From where an instance was to where it is.
struct Carry {
    bool moved = false;
    Affine points{};
    float normals[9] = {};
};
Carry carryOf(const Instance& instance);

/// From pixels (x, y, reversed z) to surface points.
class PixelRays {
  public:
    explicit PixelRays(const FrameView& view);

    /// Normal: of unit length. The rays' origin lies off the surface by what snapping of vertices
    /// and rounding of depth may have moved it.
    LitPoint pointAt(int x, int y, float depth, const Float3& normal) const;

  private:
    Matrix to_world_;
    double offset_x_, offset_y_;  ///< of the sample in its pixel
    double pixel_size_;           ///< at w = 1
    Float3 eye_;
};

}  // namespace still::internal
