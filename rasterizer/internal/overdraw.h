#pragma once
// How many triangles hold each sample: for people who look at a picture, not for the picture.

#include "rasterizer/image.h"
#include "rasterizer/internal/binner.h"

namespace still::internal {

/// Writes the pixels of tile (tx, ty). Every triangle of the tile's bins counts where its edges
/// hold the sample, whatever lies in front of it.
void countOverdraw(const FrameBins& bins, int tx, int ty, ImageView<uint16_t> out);

}  // namespace still::internal
