#pragma once
// The preconditions of DrawList as functions, for whoever makes lists out of what may be wrong. The
// rasterizer itself checks nothing: what these find, it must not be given.
//
// They are about what is made once: meshes, textures, materials, lights, and the numbers that point
// from one to the other. Transforms and cameras are made anew for every frame and may be anything,
// infinite and NaN included: what has no place in the picture is not drawn, and colours that have
// no value are 0.

#include <cmath>
#include <span>

#include "rasterizer/draw_list.h"

namespace still {

constexpr float kMaxPosition = 1e18f;      ///< of a mesh's coordinates and of lights, either way
constexpr float kMaxUnitLength = 1.001f;   ///< of normals' and tangents' components
constexpr float kMaxTexcoord = 32768.0f;   ///< where a float still resolves 1/256 of a repeat
constexpr float kMaxColour = 1e12f;        ///< of light, in colours, which are not negative
constexpr float kMaxTextureOffset = 1e6f;  ///< of Material::u_offset and v_offset
constexpr uint32_t kMaxTextureSize = 16384;

/// False for NaN, too.
inline bool within(float value, float limit) {
    return std::fabs(value) <= limit;
}
inline bool isSound(const VertexAttributes& a) {
    return within(a.nx, kMaxUnitLength) && within(a.ny, kMaxUnitLength) &&
           within(a.nz, kMaxUnitLength) && within(a.u, kMaxTexcoord) && within(a.v, kMaxTexcoord);
}
inline bool isSound(const VertexTangent& t) {
    return within(t.x, kMaxUnitLength) && within(t.y, kMaxUnitLength) &&
           within(t.z, kMaxUnitLength) && std::fabs(t.handedness) == 1.0f;
}

/// What is wrong, as "mesh: an index beyond the vertices", or null. A mesh with `materials` to
/// choose from.
const char* flawOf(const Mesh& mesh, std::span<const Material> materials);
/// The same without a look at its coordinates, attributes and tangents.
const char* flawOfIndices(const Mesh& mesh, std::span<const Material> materials);
/// Levels, layout and size; texels may be anything.
const char* flawOf(const Texture& texture);
const char* flawOf(const AlphaTexture& texture);
/// With so many textures to choose from.
const char* flawOf(const Material& material, size_t textures, size_t alpha_textures);
const char* flawOf(const Lighting& lighting);
/// Everything. About 1 ms for a million triangles.
const char* flawOf(const DrawList& list);

}  // namespace still
