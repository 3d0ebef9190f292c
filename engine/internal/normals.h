#pragma once
// Normals for corners that have none, and tangents for normal maps.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "rasterizer/draw_list.h"

namespace still {

using Vector3f = std::array<float, 3>;

/// Faces that meet at more than this angle keep a hard edge. (Cosine of 60°.)
constexpr double kCreaseCosine = 0.5;

/// Fills the normals that are (0, 0, 0); the others stay. `triangles` and `normals` go corner by
/// corner, three to a triangle; `triangles` holds numbers of positions. A corner gets the mean of
/// the faces around its place (equal coordinates count as one place) that meet its own face at less
/// than the crease angle. Triangles must not be degenerate. Results are of unit length.
void generateNormals(std::span<const Vector3f> positions, std::span<const uint32_t> triangles,
                     std::span<Vector3f> normals);

/// `v` divided by its length; (0, 0, 0) when that is 0 or not finite.
Vector3f normalised(const Vector3f& v);

/// Whether the texture is mirrored on this triangle (a, b, c are its u, v).
bool isMirrored(std::array<float, 2> a, std::array<float, 2> b, std::array<float, 2> c);

/// One tangent per vertex of the mesh, along +u, made orthogonal to the normal. Where a vertex has
/// no usable texture coordinates any orthogonal direction is taken.
std::vector<VertexTangent> generateTangents(const Mesh& mesh);

}  // namespace still
