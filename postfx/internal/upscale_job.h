#pragma once
// What the upscaler's kernels see of a frame. The frame's tiles (kTileSize of its pixels) are the
// unit of work; an output pixel belongs to the tile that holds its centre, so each has one writer.

#include <cstdint>
#include <vector>

#include "postfx/internal/accumulate.h"
#include "postfx/internal/ring.h"
#include "postfx/internal/upscale_sums_row.h"
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
    int ratio_fx8 = 256;       ///< image / frame, rounded half up
    int inverse_fx16 = 65536;  ///< frame / image, rounded half up

    Axis() = default;
    Axis(int frame_length, int image_length)
        : frame(frame_length),
          image(image_length),
          ratio_fx8((image * 256 + frame / 2) / frame),
          inverse_fx16(int((int64_t(frame) * 65536 + image / 2) / image)) {}

    /// The first output pixel whose centre is not before the left edge of the frame's pixel.
    int firstOf(int pixel) const {
        return int(floorDiv<int64_t>(2 * int64_t(pixel) * image + frame - 1, 2 * int64_t(frame)));
    }
    /// The output pixel that a frame's sample falls into.
    int outputOf(int pixel, int jitter_fx8) const {
        const int64_t place_fx8 = 256 * int64_t(pixel) + 128 + jitter_fx8;
        return int(place_fx8 * image / (256 * int64_t(frame)));
    }
    /// The frame's pixel that holds an output pixel's centre.
    int pixelOf(int output) const {
        return int((2 * int64_t(output) + 1) * frame / (2 * int64_t(image)));
    }
    /// Where an output pixel's centre lies from that of the frame's pixel, 1/256 output pixel,
    /// rounded half up.
    int offsetOf(int output, int pixel) const {
        const int64_t twice = (2 * int64_t(output) + 1) * frame - (2 * int64_t(pixel) + 1) * image;
        return int(floorDiv<int64_t>(twice * 256 + frame, 2 * int64_t(frame)));
    }
    /// Distances in 1/256 pixel of the image to 1/256 pixel of the frame, rounded half up …
    int toFrame(int distance_fx8) const { return roundShift(distance_fx8 * inverse_fx16, 16); }
    /// … and back, rounded down.
    int toImage(int distance_fx8) const { return (distance_fx8 * ratio_fx8) >> 8; }
    /// A place in a frame of another size, 1/256 pixel with 0 at the centre of pixel 0.
    int fromSize(int place_fx8, const Axis& other) const {
        if (other.frame == frame) {
            return place_fx8;
        }
        const int64_t twice = 2 * (int64_t(place_fx8) + 128) * frame + other.frame;
        return int(floorDiv<int64_t>(twice, 2 * int64_t(other.frame))) - 128;
    }
};

/// A kept frame; it may have had another size than the present one.
struct Slot {
    SlotIn in;
    Axis x, y;
    ptrdiff_t stride = 0;
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
    int frames = 1;        ///< valid slots, this frame's included
    Slot slot[kMaxRing];   ///< slot[k] is k frames old
    ptrdiff_t stride = 0;  ///< of the image's planes, in elements
    Sums sums;
    SumKernels sum_kernels;          ///< null: one pixel after the other
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

/// Index of the frame's sample in whose pixel an output pixel's centre lies.
inline ptrdiff_t nearestInFrame(const Job& job, int x, int y) {
    return job.y.pixelOf(y) * job.frame.stride + job.x.pixelOf(x);
}

}  // namespace still::upscale
