#pragma once
// Output pixels that stand still: exact sums of the samples that fall into them.

#include "postfx/internal/upscale_job.h"

namespace still::upscale {

/// Adds this frame's samples to the output pixels of `tile` (a tile of the frame), and shows the
/// means of those with job.settled samples or more. A frame's sample falls into one output pixel;
/// a pixel takes job.sample_cap frames, whether they have a sample for it or not. `restart`: there
/// are no sums yet. Stillness::tested: a pixel is disturbed when the 3×3 window of this frame's
/// samples around the frame's pixel that holds its centre shows something that moved (then it loses
/// its sum) or changed (then it starts anew), see taa::disturbedRow().
/// `finished`: every pixel has had job.sample_cap frames; `settled`: every pixel is shown.
SumsResult accumulateTileReference(const Job& job, const TileRect& tile, Stillness stillness,
                                   bool restart) noexcept;

}  // namespace still::upscale
