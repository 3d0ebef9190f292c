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

/// +1 when the interpolated normals of triangle `triangle` of the mesh look towards the eye, −1
/// when they have to be turned. The side that is seen is the geometric one; which way its normal
/// counts as outward is told by the vertex normals, so that models with inconsistent winding are
/// lit right, too.
float shadingFlip(const Surface& s, const InstanceSetup& instance, uint32_t triangle,
                  bool counter_clockwise);

/// Fills the corners' attributes and what follows from them; `index` are the corners' vertices, the
/// planes stand there already.
void copyAttributes(const Surface& s, const uint32_t index[3], ShadeTriangle& out);

}  // namespace still::internal
