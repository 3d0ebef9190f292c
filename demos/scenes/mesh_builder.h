#pragma once
// Grows a mesh triangle by triangle. Everything is computed in double in a written order and
// rounded to float once, when the vertex is stored.

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "rasterizer/draw_list.h"

namespace still::scenes {

using glm::dmat4;
using glm::dvec2;
using glm::dvec3;

/// v / |v|; v is not zero.
dvec3 unit(const dvec3& v);

class MeshBuilder {
  public:
    explicit MeshBuilder(uint32_t material = 0) : material_(material) {}

    /// Triangles from here on have this material; a change starts a new part.
    void useMaterial(uint32_t material) { material_ = material; }

    /// `normal` need not be of unit length. Returns the vertex's index.
    uint32_t vertex(const dvec3& position, const dvec3& normal, const dvec2& uv);
    /// Counter-clockwise seen from outside. Triangles without area are left out.
    void triangle(uint32_t a, uint32_t b, uint32_t c);

    /// Triangles of a grid of vertices that starts at `first`: `columns` + 1 vertices in a row,
    /// the next row above it, seen from outside.
    void gridTriangles(uint32_t first, int columns, int rows);

    /// Flat parallelogram with edges `right` and `up` from `corner`; outside is right × up.
    /// Texture coordinates grow from `uv` by the edges' lengths / `metres_per_uv`.
    void rectangle(const dvec3& corner, const dvec3& right, const dvec3& up, double metres_per_uv,
                   const dvec2& uv = dvec2{0.0});
    /// Flat convex polygon, counter-clockwise; texture coordinates as given.
    void polygon(std::span<const dvec3> corners, std::span<const dvec2> uvs);

    /// Box between two corners; texture coordinates are world metres / `metres_per_uv`, so that
    /// boxes side by side continue each other's pattern.
    void box(const dvec3& min, const dvec3& max, double metres_per_uv);

    /// A copy of `mesh` under an affine transform, all of it in the current material.
    void append(const Mesh& mesh, const dmat4& transform);

    uint32_t vertexCount() const { return mesh_.vertexCount(); }

    /// The finished mesh; the builder is empty afterwards.
    Mesh take();
    /// As take(), with tangents for normal maps: the direction of +u, averaged over the triangles
    /// around a vertex (Lengyel, "Computing Tangent Space Basis Vectors for an Arbitrary Mesh",
    /// 2001).
    Mesh takeWithTangents();

  private:
    Mesh mesh_;
    uint32_t material_;
};

}  // namespace still::scenes
