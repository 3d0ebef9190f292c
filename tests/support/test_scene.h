#pragma once
// Small draw lists for tests: owns what a DrawList only points at, and draws it.

#include <array>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <random>
#include <vector>

#include "rasterizer/rasterizer.h"

namespace still::test {

struct TestVertex {
    float x = 0, y = 0, z = 0;
    VertexAttributes attributes{0, 0, 1, 0, 0};
};

/// Owns a draw list. After the last change call list(), which numbers the surfaces.
struct TestScene {
    std::vector<Mesh> meshes;
    std::vector<Material> materials = std::vector<Material>(1);
    std::vector<Texture> textures;
    std::vector<AlphaTexture> alpha_textures;
    std::vector<Instance> instances;
    Lighting lighting{.ambient = {1, 1, 1}, .sun = {}, .points = {}};

    /// Appends a triangle as a part, so a surface, of its own to the last mesh.
    void addTriangle(const TestVertex& a, const TestVertex& b, const TestVertex& c,
                     uint32_t material = 0);
    /// Two triangles a b c, a c d in one part.
    void addQuad(const std::array<TestVertex, 4>& corners, uint32_t material = 0);
    /// Starts a new mesh with one instance that does not move.
    Instance& addMesh();
    DrawList list();
};

/// Pixel coordinates → object coordinates for a view whose view_projection is the identity.
/// z is reversed depth, 1 = near.
TestVertex atPixel(const FrameView& view, double x_px, double y_px, double depth);

/// Right-handed perspective, looking along −z, from the origin; OpenGL clip space.
glm::dmat4 perspective(double focal, double aspect, double near, double far);
/// Rigid motion: rotation by `turns` around y, then translation.
glm::dmat4 rigid(double turns, double x, double y, double z);
Affine toAffine(const glm::dmat4& m);

constexpr PlaneSet kAllPlanes{.normal = true, .motion = true, .albedo = true};

/// One frame on a serial scheduler.
void draw(const DrawList& list, const FrameView& view, GBuffer& out,
          const RasterSettings& settings = {.planes = kAllPlanes});

/// Uniform numbers that are the same with every standard library.
class Random {
  public:
    explicit Random(uint64_t seed) : engine_(seed) {}
    /// In [low, high).
    double real(double low, double high);
    /// In [low, high].
    int integer(int low, int high);

  private:
    std::mt19937_64 engine_;
};

}  // namespace still::test
