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

/// Adds this frame's samples to the sums, of which the settled ones are shown. `restart`: there are
/// no sums yet. A pixel where something moved loses its sum; one where shading changed, or light
/// since its first sample, starts anew.
SumsResult accumulateTileReference(const Job& job, const TileRect& tile, Stillness stillness,
                                   bool restart) noexcept;

/// The worst that the 3×3 window of a pixel holds: a surface whose shading changed in this frame,
/// or an object that moved.
constexpr uint8_t kChanged = 1;
constexpr uint8_t kMoved = 2;
/// Fills flags[x − tile.x0] for the pixels of row y, 0 where nothing happened; whether anything
/// did.
bool disturbedRow(const Job& job, const TileRect& tile, int y, uint8_t* flags) noexcept;

}  // namespace still::taa
