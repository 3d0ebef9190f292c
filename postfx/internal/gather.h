#pragma once
// A pixel from the raw samples that fell into it during the last frames.

#include "postfx/internal/ring.h"

namespace still::taa {

/// Writes the pixel's resolved colour into job.shown. Every slot's record is complete.
void gatherPixel(const Job& job, int x, int y) noexcept;

/// The tile's pixels, except those that the sums have shown already.
void gatherTileReference(const Job& job, const TileRect& tile, bool sums_valid) noexcept;

/// Where the past gave less than a frame of samples, the rest is this frame, filtered in space.
void mixSpatial(const Job& job, int x, int y, int old_weight, int rgb[3]) noexcept;

}  // namespace still::taa
