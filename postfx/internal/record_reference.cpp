// Writes a frame's samples into the ring: the truth that record-inl.h is tested against.

#include <algorithm>
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
    const auto depthAt = [&](ptrdiff_t at) { return int(logDepth16(job.now.depth[at])); };
    const auto better = [&](ptrdiff_t a, ptrdiff_t b) { return depthAt(b) > depthAt(a) ? b : a; };
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
        depthAt(best) - depthAt(centre) <= job.centre_tolerance) {
        best = centre;
    }
    Owner owner;
    owner.surface = surfaceOf(job.now.id[best]);
    owner.depth = depthAt(best);
    owner.expected = job.now.depth_before[best];
    owner.motion = job.now.motion[best];
    owner.normal = job.now.normal != nullptr ? compactNormal(job.now.normal[best]) : 0;
    owner.slope = surfaceOf(job.now.id[centre]) == owner.surface
                      ? std::min(owner.depth - depthAt(centre), kMaxSlope)
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
    const int owner = uint16_t(before.owner[there]);
    const int depth = plusOffset(before.owner_depth[there]);
    const Motion motion{before.motion[0][there], before.motion[1][there]};
    const int surface = owner & int(kSurfaceMask);
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
    const int from_depth = plusOffset(before.owner_depth[from]);
    if (uint16_t(before.owner[from]) != owner || std::abs(from_depth - depth) > kDepthTolerance) {
        return seen;
    }
    Owner inferred;
    inferred.surface = surface;
    inferred.depth = inferred.expected = from_depth;
    inferred.motion = {before.motion[0][from], before.motion[1][from]};
    inferred.normal = uint16_t(before.normal[from]);
    inferred.inferred = true;
    return inferred;
}

int16_t ownerHint(const Owner& owner) noexcept {
    const int step = std::clamp(owner.expected - owner.depth, -kMaxStep, kMaxStep);
    return int16_t(2 * step + (owner.moved ? 1 : 0));
}

void recordTileReference(const Job& job, const TileRect& tile) noexcept {
    for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
            const ptrdiff_t at = y * job.stride + x;
            const Owner owner = inferOwner(job, x, y, seenOwner(job, x, y));
            const SlotOut& out = job.record;
            for (int c = 0; c < 3; ++c) {
                out.colour[c][at] = lessOffset(job.now.colour[c][at]);
            }
            out.id[at] = int16_t(job.now.id[at]);
            out.depth[at] = lessOffset(logDepth16(job.now.depth[at]));
            out.owner_depth[at] = lessOffset(owner.depth);
            out.owner[at] = int16_t(owner.surface | (owner.inferred ? kInferredBit : 0));
            out.motion[0][at] = owner.motion.x_fx8;
            out.motion[1][at] = owner.motion.y_fx8;
            out.normal[at] = int16_t(owner.normal);
            job.hint[at] = ownerHint(owner);
        }
    }
}

}  // namespace still::taa
