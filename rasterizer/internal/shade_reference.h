#pragma once
// The scalar truth of shading, one pixel at a time. Steps are the same, in the same order, as in
// shade-inl.h.

#include "rasterizer/internal/kernels.h"

namespace still::internal {

/// Whether the sample exists: alpha test, or the stochastic draw of this pixel.
bool alphaPasses(const TileContext& tile, const ShadeTriangle& triangle, int x, int y);

/// Writes all wanted planes of one tile-local pixel. `triangle` is null for the background.
void shadePixel(const TileContext& tile, const ShadeTriangle* triangle, int x, int y, float depth);

}  // namespace still::internal
