#pragma once
// What the upscaler's kernels see of a frame. The frame's tiles (kTileSize of its pixels) are the
// unit of work; an output pixel belongs to the tile that holds its centre, so each has one writer.

#include <cstdint>
#include <vector>

#include "postfx/internal/accumulate.h"
#include "postfx/internal/ring.h"
#include "postfx/upscale.h"
#include "rasterizer/fixed.h"

namespace still::upscale {

using taa::SlotIn;
using taa::Stillness;
using taa::SumsResult;
using taa::TileRect;

/// One axis of the image against that of a frame.
struct Axis {
    int frame = 0, image = 0;  ///< lengths in pixels

    /// Where an output pixel's centre lies among the frame's, whose pixel 0 has its centre at 0:
    /// 1/256 of its pixels, rounded half up.
    int placeOf_fx8(int output) const {
        const int64_t twice = (2 * int64_t(output) + 1) * frame * 256;
        return int(floorDiv<int64_t>(twice + image, 2 * int64_t(image))) - 128;
    }
    /// The first output pixel whose centre is not before the left edge of the frame's pixel.
    int firstOf(int pixel) const {
        return int(floorDiv<int64_t>(2 * int64_t(pixel) * image + frame - 1, 2 * int64_t(frame)));
    }
    /// The output pixel that a frame's sample falls into.
    int outputOf(int pixel, int jitter_fx8) const {
        const int64_t place_fx8 = 256 * int64_t(pixel) + 128 + jitter_fx8;
        return int(place_fx8 * image / (256 * int64_t(frame)));
    }
};

/// Sums of the samples that fell into still output pixels, row by row as the image is.
struct Sums {
    uint32_t* colour[3] = {};    ///< up to 4096 samples
    uint16_t* count = nullptr;   ///< samples
    uint16_t* frames = nullptr;  ///< looked at so far, Job::sample_cap: all
};

struct Job {
    /// The frame's: planes, this frame's record, what changed. Its slots are the last two frames'
    /// at most, its sums and its image are null.
    taa::Job frame;
    Axis x, y;
    int frames = 1;                                         ///< valid slots, this frame's included
    SlotIn slot[kMaxUpscaleRing];                           ///< slot[k] is k frames old …
    Axis slot_x[kMaxUpscaleRing], slot_y[kMaxUpscaleRing];  ///< … and may be of another size
    ptrdiff_t slot_stride[kMaxUpscaleRing] = {};
    ptrdiff_t stride = 0;  ///< of the image's planes, in elements
    Sums sums;
    uint16_t* shown[3] = {};         ///< the image
    uint8_t* shown_count = nullptr;  ///< samples in it, up to 255
    int sample_cap = 256;            ///< frames after which a still pixel is finished
    int settled = 16;                ///< a still pixel shows the mean of so many samples, or more
};

/// The output pixels of a frame's tile.
inline TileRect outputRect(const Job& job, const TileRect& tile) {
    return {job.x.firstOf(tile.x0), job.y.firstOf(tile.y0), job.x.firstOf(tile.x1),
            job.y.firstOf(tile.y1)};
}

}  // namespace still::upscale
