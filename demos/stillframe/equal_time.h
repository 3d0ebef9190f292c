#pragma once
// What the time of a frame buys when it is spent on nothing but samples.

#include <vector>

#include "demos/stillframe/cell.h"

namespace still::command {

/// Plain accumulation in the time that a mode takes, over the compared frames of a segment; of a
/// scene that stands still, in the first of them, with the time of all frames up to there.
struct EqualTime {
    int samples = 0;  ///< of a picture, ssaa:N
    int frames = 0;   ///< that were compared, from the segment's first on
    double rms = 0;   ///< over the frames, of the 8-bit channels
    double ssim = 0;  ///< mean over the frames
};

/// `share`: the mode's time in units of a frame of one sample.
EqualTime measureEqualTime(const PreparedCase& prepared, size_t segment, double share);

}  // namespace still::command
