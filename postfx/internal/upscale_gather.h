#pragma once
// An output pixel from the raw samples that fell near it during the last frames.

#include "postfx/internal/upscale_job.h"

namespace still::upscale {

/// The output pixels of a frame's tile, except those that the sums have shown already. Every
/// slot's record is complete.
void gatherTileReference(const Job& job, const TileRect& tile, bool sums_valid) noexcept;

}  // namespace still::upscale
