#pragma once
// Pixels that stand still: exact sums of their samples.

#include "postfx/internal/ring.h"

namespace still::taa {

/// What is known about a tile whose camera stands still.
enum class Stillness : uint8_t {
    all,     ///< nothing moved or changed here or next door
    tested,  ///< each pixel whose window holds nothing that moved or changed is still
};

struct SumsResult {
    bool finished = true;  ///< every pixel has job.sample_cap samples
    bool settled = true;   ///< every pixel has kSettled samples
    bool changed = false;  ///< some pixel took a sample or lost its sum
};

/// Adds this frame's samples to the sums and shows the settled ones. `restart`: there are no sums
/// yet. A pixel that is not still loses its sum.
SumsResult accumulateTileReference(const Job& job, const TileRect& tile, Stillness stillness,
                                   bool restart) noexcept;

/// Fills flags[x − tile.x0] for the pixels of row y: 1 where the 3×3 window holds a sample of an
/// object that moved, or of a surface whose shading changed in this frame.
void disturbedRow(const Job& job, const TileRect& tile, int y, uint8_t* flags) noexcept;

}  // namespace still::taa
