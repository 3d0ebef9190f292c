// Sums of still output pixels, one pixel after the other: the truth that upscale_sums.cpp is tested
// against.

#include <algorithm>

#include "postfx/internal/upscale_sums.h"

namespace still::upscale {
namespace {

/// The frame's pixel whose sample falls into an output pixel, or −1. An output pixel is not larger
/// than one of the frame's, so there is one at most, and it is one of three.
int sampleIn(const Axis& axis, int output, int jitter_fx8) {
    const int middle = pixelUnder(axis, output);
    for (int pixel = std::max(middle - 1, 0); pixel <= std::min(middle + 1, axis.frame - 1);
         ++pixel) {
        if (axis.outputOf(pixel, jitter_fx8) == output) {
            return pixel;
        }
    }
    return -1;
}

void show(const Job& job, ptrdiff_t at) {
    const uint32_t count = job.sums.count[at];
    for (int c = 0; c < 3; ++c) {
        job.shown[c][at] = uint16_t((job.sums.colour[c][at] + count / 2) / count);
    }
    job.shown_count[at] = uint8_t(std::min<uint32_t>(count, 255));
}

void addSample(const Job& job, ptrdiff_t at, ptrdiff_t from, bool first) {
    const int count = (first ? 0 : job.sums.count[at]) + 1;
    job.sums.count[at] = uint16_t(count);
    for (int c = 0; c < 3; ++c) {
        const uint32_t past = first ? 0 : job.sums.colour[c][at];
        job.sums.colour[c][at] = past + job.frame.now.colour[c][from];
    }
    if (count >= job.settled) {
        show(job, at);
    }
}

}  // namespace

SumsResult accumulateTileReference(const Job& job, const TileRect& tile, Stillness stillness,
                                   bool restart) noexcept {
    SumsResult result;
    const TileRect out = outputRect(job, tile);
    uint8_t disturbed[kTileSize] = {};
    for (int y = out.y0; y < out.y1; ++y) {
        if (stillness == Stillness::tested) {
            taa::disturbedRow(job.frame, tile, pixelUnder(job.y, y), disturbed);
        }
        const int row = sampleIn(job.y, y, job.frame.record.jitter_y_fx8);
        for (int x = out.x0; x < out.x1; ++x) {
            const ptrdiff_t at = y * job.stride + x;
            const int under = pixelUnder(job.x, x);
            uint8_t disturbance = disturbed[under - tile.x0];
            int frames = restart ? 0 : job.sums.frames[at];
            if (litSince(job, under, pixelUnder(job.y, y), frames)) {
                disturbance = std::max(disturbance, taa::kChanged);
            }
            result.changed |= disturbance != 0 && frames != 0;
            frames = disturbance != 0 ? 0 : frames;
            if (frames == 0) {
                job.sums.count[at] = 0;
            }
            if (disturbance != taa::kMoved && frames < job.sample_cap) {
                const int column = sampleIn(job.x, x, job.frame.record.jitter_x_fx8);
                if (row >= 0 && column >= 0) {
                    addSample(job, at, row * job.frame.stride + column, job.sums.count[at] == 0);
                    result.changed = true;
                }
                ++frames;
            }
            job.sums.frames[at] = uint16_t(frames);
            result.settled &= job.sums.count[at] >= job.settled;
            result.finished &= frames >= job.sample_cap;
        }
    }
    return result;
}

}  // namespace still::upscale
