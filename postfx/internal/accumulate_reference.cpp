// Sums of still pixels, one pixel after the other: the truth that accumulate-inl.h is tested
// against.

#include "postfx/internal/accumulate.h"

#include <algorithm>
#include <cstring>

#include "postfx/internal/rules.h"

namespace still::taa {
namespace {

uint8_t disturbance(const Job& job, uint16_t id) {
    if ((id & kMovedBit) != 0) {
        return kMoved;
    }
    const bool changed = job.change_age != nullptr && job.change_age[id & kSurfaceMask] == 0;
    return changed ? kChanged : 0;
}

/// Adds this frame's sample to a pixel that has `count`.
void grow(const Job& job, ptrdiff_t at, int count) {
    for (int c = 0; c < 3; ++c) {
        const uint16_t* from = count < job.settled ? job.sums.mean[c] : job.shown[c];
        uint16_t* to = count + 1 < job.settled ? job.sums.mean[c] : job.shown[c];
        const Sum past = count == 0 ? Sum{} : Sum{from[at], job.sums.rest[c][at]};
        const Sum sum = addSample(past, count, job.now.colour[c][at]);
        to[at] = uint16_t(sum.mean);
        job.sums.rest[c][at] = int8_t(sum.rest);
    }
    if (count + 1 >= job.settled) {
        job.shown_count[at] = uint8_t(count + 1);
    }
}

}  // namespace

bool disturbedRow(const Job& job, const TileRect& tile, int y, uint8_t* flags) noexcept {
    const int width = tile.x1 - tile.x0;
    bool any = false;
    std::memset(flags, 0, size_t(width));
    for (int j = std::max(y - 1, 0); j <= std::min(y + 1, job.height - 1); ++j) {
        const uint16_t* row = job.now.id + j * job.stride;
        for (int x = std::max(tile.x0 - 1, 0); x < std::min(tile.x1 + 1, job.width); ++x) {
            const uint8_t flag = disturbance(job, row[x]);
            if (flag == 0) {
                continue;
            }
            const int first = std::max(x - 1 - tile.x0, 0);
            const int last = std::min(x + 1 - tile.x0, width - 1);
            for (int i = first; i <= last; ++i) {
                flags[i] = std::max(flags[i], flag);
            }
            any = true;
        }
    }
    return any;
}

SumsResult accumulateTileReference(const Job& job, const TileRect& tile, Stillness stillness,
                                   bool restart) noexcept {
    SumsResult result;
    uint8_t disturbed[kTileSize] = {};
    for (int y = tile.y0; y < tile.y1; ++y) {
        if (stillness == Stillness::tested) {
            disturbedRow(job, tile, y, disturbed);
        }
        for (int x = tile.x0; x < tile.x1; ++x) {
            const ptrdiff_t at = y * job.stride + x;
            uint8_t disturbance = disturbed[x - tile.x0];
            int count = restart ? 0 : job.sums.count[at];
            if (job.light_age != nullptr && count > job.light_age[at]) {
                disturbance = std::max(disturbance, kChanged);
            }
            result.changed |= disturbance != 0 && count != 0;
            count = disturbance != 0 ? 0 : count;
            if (disturbance != kMoved && count < job.sample_cap) {
                grow(job, at, count);
                ++count;
                result.changed = true;
            }
            job.sums.count[at] = uint8_t(count);
            result.settled &= count >= job.settled;
            result.finished &= count >= job.sample_cap;
        }
    }
    return result;
}

}  // namespace still::taa
