#pragma once
// What shading needs of a triangle: b/w planes over the tile and the side that is seen.

#include "rasterizer/internal/binner.h"

namespace still::internal {

/// Fills the tile's record for shading triangle `i`, which comes from `chunk`.
void makeShadeTriangle(TileContext& tile, const Chunk& chunk, uint32_t i);

/// The same, unless it was done before.
inline void prepareTriangle(TileContext& tile, const Chunk& chunk, uint32_t i) {
    if (tile.shade_ready[i] == 0) {
        tile.shade_ready[i] = 1;
        makeShadeTriangle(tile, chunk, i);
    }
}

/// True when the normals of a triangle's vertices lie on the side that sees it counter-clockwise.
bool windingAgrees(const float* x, const float* y, const float* z, const float* attributes,
                   const uint32_t index[3]);

/// +1 when the interpolated normals of triangle `triangle` of the mesh look towards the eye, −1
/// when they have to be turned. The side that is seen is the geometric one; which way its normal
/// counts as outward is told by the vertex normals, so that models with inconsistent winding are
/// lit right, too.
inline float shadingFlip(const Surface& s, const InstanceSetup& instance, uint32_t triangle,
                         bool counter_clockwise) {
    const bool agrees =
        s.windings != nullptr
            ? (s.windings[triangle / 32] >> triangle % 32 & 1u) != 0
            : windingAgrees(s.x, s.y, s.z, s.attributes, s.indices + size_t(triangle) * 3);
    return (counter_clockwise != instance.mirrored) == agrees ? 1.0f : -1.0f;
}

/// Of the tangent at the first of a triangle's vertices; 0 without tangents.
inline float handednessOf(const Surface& s, const uint32_t index[3]) {
    const bool mapped = (s.features & (kShadeNormalMap | kShadeHeightMap)) != 0;
    return mapped ? s.tangents[size_t(index[0]) * kTangentStride + 3] : 0.0f;
}

/// Fills what only some surfaces need of a triangle's corners: tangents and positions.
inline void copyExtras(const Surface& s, const uint32_t index[3], ShadeTriangle& out) {
    if ((s.features & (kShadeNormalMap | kShadeHeightMap)) != 0) {
        for (int k = 0; k < 3; ++k) {
            const float* tangent = s.tangents + size_t(index[k]) * kTangentStride;
            out.tx[k] = tangent[0];
            out.ty[k] = tangent[1];
            out.tz[k] = tangent[2];
        }
    }
    if ((s.features & (kShadePosition | kShadeMoved | kShadeHeightMap)) != 0) {
        for (int k = 0; k < 3; ++k) {
            out.x[k] = s.x[index[k]];
            out.y[k] = s.y[index[k]];
            out.z[k] = s.z[index[k]];
        }
    }
}

}  // namespace still::internal
