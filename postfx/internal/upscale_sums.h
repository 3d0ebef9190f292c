#pragma once
// Output pixels that stand still: exact sums of the samples that fall into them.

#include "postfx/internal/upscale_job.h"

namespace still::upscale {

/// Adds this frame's samples to the output pixels of `tile` (a tile of the frame), and shows the
/// means of those with job.settled samples or more. A frame's sample falls into one output pixel;
/// a pixel takes job.sample_cap frames, whether they have a sample for it or not. `restart`: there
/// are no sums yet. Stillness::tested: a pixel is disturbed when the 3×3 window of this frame's
/// samples around the frame's pixel that holds its centre shows something that moved (then it loses
/// its sum) or changed (then it starts anew, as it does when its light changed since its first
/// sample), see taa::disturbedRow().
/// Samples up to one pixel beside the tile are read: they must be this frame's too.
/// `finished`: every pixel has had job.sample_cap frames; `settled`: every pixel is shown.
SumsResult accumulateTile(const Job& job, const TileRect& tile, Stillness stillness,
                          bool restart) noexcept;
SumsResult accumulateTileReference(const Job& job, const TileRect& tile, Stillness stillness,
                                   bool restart) noexcept;

/// The frame's pixel that holds an output pixel's centre.
inline int pixelUnder(const Axis& axis, int output) {
    return int((2 * int64_t(output) + 1) * axis.frame / (2 * int64_t(axis.image)));
}

/// Light changed since the first of the `frames` frames that were looked at (light_age 255: long
/// enough).
inline bool litSince(const Job& job, int pixel_x, int pixel_y, int frames) {
    constexpr int kLongEnough = 255;
    if (job.frame.light_age == nullptr) {
        return false;
    }
    const int age = job.frame.light_age[pixel_y * job.frame.stride + pixel_x];
    return age < kLongEnough && frames > age;
}

}  // namespace still::upscale
