#pragma once
// Whether the peer draws what Stillframe draws: speed of another picture would prove nothing.

#include "tests/bench/peer/measure.h"

namespace still::peer {

struct PictureCheck {
    Driver driver = Driver::llvmpipe;
    /// PSNR of a frame with one sample in the pixels' centres, the peer's against Stillframe's.
    double raw_db = 0;
    double motion = 0;      ///< share of pixels whose motion is the same within 1/16 pixel
    double aliased_db = 0;  ///< Stillframe's frame against the supersampled reference
    double taa_db = 0;      ///< the peer's resolved frame against the reference
    bool still = false;     ///< nothing moves

    /// Colours and motion are the same but for rounding and edges. Where nothing moves, the resolve
    /// comes nearer to the reference than a frame that was not resolved.
    bool passes() const;
};

/// Draws the frames up to `frame` by the peer, and that one by Stillframe. `scene` is that of
/// `peer`, with everything in it. The peer's resolved frame is left to be read.
Result<PictureCheck> checkPictures(PeerFrames& peer, const Scene& scene, int frame, int threads);

}  // namespace still::peer
