// Writes a frame's samples into the ring: the truth that record-inl.h is tested against.

#include <cstdlib>

#include "postfx/internal/owner.h"
#include "postfx/internal/rules.h"

namespace still::taa {
namespace {

bool inside(const Job& job, int x, int y) {
    return x >= 0 && x < job.width && y >= 0 && y < job.height;
}

int surfaceOf(uint16_t id) {
    return id & kSurfaceMask;
}

}  // namespace

Owner seenOwner(const Job& job, int x, int y) noexcept {
    // Columns first, then the best of the three columns, as the SIMD kernel does it.
    const auto better = [&](ptrdiff_t a, ptrdiff_t b) {
        return job.now.depth[b] > job.now.depth[a] ? b : a;
    };
    const auto column = [&](int cx) {
        const ptrdiff_t centre = y * job.stride + cx;
        ptrdiff_t best = centre;
        best = y > 0 ? better(best, centre - job.stride) : best;
        return y + 1 < job.height ? better(best, centre + job.stride) : best;
    };
    ptrdiff_t best = column(x);
    best = x > 0 ? better(best, column(x - 1)) : best;
    best = x + 1 < job.width ? better(best, column(x + 1)) : best;

    const ptrdiff_t centre = y * job.stride + x;
    // What the centre itself shows of the owner is nearer to the pixel's own motion.
    if (surfaceOf(job.now.id[centre]) == surfaceOf(job.now.id[best]) &&
        logDepth16(job.now.depth[best]) - logDepth16(job.now.depth[centre]) <= kDepthTolerance) {
        best = centre;
    }
    Owner owner;
    owner.surface = surfaceOf(job.now.id[best]);
    owner.depth = logDepth16(job.now.depth[best]);
    owner.expected = job.now.depth_before[best];
    owner.motion = job.now.motion[best];
    owner.normal = job.now.normal != nullptr ? compactNormal(job.now.normal[best]) : 0;
    owner.slope = surfaceOf(job.now.id[centre]) == owner.surface
                      ? owner.depth - logDepth16(job.now.depth[centre])
                      : 0;
    owner.moved = (job.now.id[best] & kMovedBit) != 0;
    return owner;
}

Owner inferOwner(const Job& job, int x, int y, const Owner& seen) noexcept {
    if (job.frames < 2 || seen.motion.x_fx8 == kNoHistory) {
        return seen;
    }
    const SlotIn& before = job.slot[1];
    const auto at = [&](Motion m, ptrdiff_t& index) {
        const int px = x + ((m.x_fx8 + 128) >> 8), py = y + ((m.y_fx8 + 128) >> 8);
        index = py * job.stride + px;
        return inside(job, px, py);
    };
    ptrdiff_t there = 0;
    if (!at(seen.motion, there)) {
        return seen;
    }
    const uint32_t owner = before.owner[there];
    const int depth = highHalf(before.depths[there]);
    const Motion motion = unpackMotion(before.motion[there]);
    const int surface = int(owner & kSurfaceMask);
    if ((owner & kInferredBit) != 0 || surface == seen.surface || motion.x_fx8 == kNoHistory ||
        depth <= seen.expected + kDepthTolerance + kSlopeFactor * seen.slope) {
        return seen;
    }
    if (job.start_age != nullptr && job.start_age[surface] == 0) {
        return seen;
    }
    ptrdiff_t from = 0;
    if (!at(motion, from)) {
        return seen;
    }
    const int from_depth = highHalf(before.depths[from]);
    if ((before.owner[from] & 0xFFFF) != (owner & 0xFFFF) ||
        std::abs(from_depth - depth) > kDepthTolerance) {
        return seen;
    }
    Owner inferred;
    inferred.surface = surface;
    inferred.depth = inferred.expected = from_depth;
    inferred.motion = unpackMotion(before.motion[from]);
    inferred.normal = before.owner[from] >> 16;
    inferred.inferred = true;
    return inferred;
}

void recordTileReference(const Job& job, const TileRect& tile) noexcept {
    for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
            const ptrdiff_t at = y * job.stride + x;
            const Owner owner = inferOwner(job, x, y, seenOwner(job, x, y));
            const SlotOut& out = job.record;
            out.red_green[at] = packHalves(job.now.colour[0][at], job.now.colour[1][at]);
            out.blue_id[at] = packHalves(job.now.colour[2][at], job.now.id[at]);
            out.depths[at] = packHalves(logDepth16(job.now.depth[at]), uint32_t(owner.depth));
            out.motion[at] = packMotion(owner.motion);
            out.owner[at] = packHalves(
                uint32_t(owner.surface) | (owner.inferred ? kInferredBit : 0), owner.normal);
        }
    }
}

}  // namespace still::taa
