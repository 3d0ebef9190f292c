// The truth that SIMD kernels are tested against: one pixel after the other, no tricks.

#include <algorithm>

#include "postfx/internal/neighbourhood.h"
#include "postfx/internal/reproject.h"
#include "postfx/internal/resolve.h"
#include "postfx/internal/rules.h"

namespace still::taa {
namespace {

void storeOwner(const ResolveJob& job, ptrdiff_t at, const Owner& owner) {
    job.next.surface[at] = owner.id & kSurfaceMask;
    job.next.depth[at] = owner.depth;
    job.next.normal[at] = owner.normal;
}

void storeFirst(const ResolveJob& job, ptrdiff_t at) {
    for (int c = 0; c < 3; ++c) {
        job.next.mean[c][at] = job.now.colour[c][at];
        job.next.rest[c][at] = 0;
    }
    job.next.count[at] = 1;
}

/// Adds this frame's sample to history that shall stand for `count` samples, 1 … past.count. A rest
/// that belongs to more than twice as many samples could drive the mean out of its range.
void storeSum(const ResolveJob& job, ptrdiff_t at, const Past& past, int count) {
    const bool keep_rest = 2 * count >= past.count;
    for (int c = 0; c < 3; ++c) {
        const Sum sum =
            addSample({past.mean[c], keep_rest ? past.rest[c] : 0}, count, job.now.colour[c][at]);
        job.next.mean[c][at] = uint16_t(sum.mean);
        job.next.rest[c][at] = int8_t(sum.rest);
    }
    job.next.count[at] = uint8_t(count + 1);
}

void keepPixel(const ResolveJob& job, ptrdiff_t at) {
    for (int c = 0; c < 3; ++c) {
        job.next.mean[c][at] = job.before.mean[c][at];
        job.next.rest[c][at] = job.before.rest[c][at];
    }
    job.next.count[at] = job.before.count[at];
}

/// Returns whether the pixel was finished already.
bool stillPixel(const ResolveJob& job, int x, int y) {
    const ptrdiff_t at = y * job.stride + x;
    job.next.surface[at] = job.before.surface[at];
    job.next.depth[at] = job.before.depth[at];
    job.next.normal[at] = job.before.normal[at];
    const int count = job.before.count[at];
    if (count >= job.sample_cap) {
        keepPixel(job, at);
        return true;
    }
    Past past;
    for (int c = 0; c < 3; ++c) {
        past.mean[c] = job.before.mean[c][at];
        past.rest[c] = job.before.rest[c][at];
    }
    past.count = count;
    storeSum(job, at, past, count);
    return false;
}

void holdAgainstWindow(const ResolveJob& job, int x, int y, Past& past) {
    if (clipToWindow(job, x, y, past.mean)) {
        past.rest[0] = past.rest[1] = past.rest[2] = 0;
    }
}

}  // namespace

bool resolvePixel(const ResolveJob& job, int x, int y) noexcept {
    const ptrdiff_t at = y * job.stride + x;
    const Owner owner = findOwner(job, x, y);
    storeOwner(job, at, owner);
    Past past = findPast(job, x, y, owner);
    if (past.count == 0) {
        storeFirst(job, at);
        return false;
    }
    if (past.proven && past.count >= job.sample_cap) {
        keepPixel(job, at);
        return true;
    }
    int count = std::min(past.count, job.sample_cap - 1);
    if (past.suspect) {
        holdAgainstWindow(job, x, y, past);
        count = std::min(count, kSuspectCount);
    }
    if (count == 0) {
        storeFirst(job, at);
    } else {
        storeSum(job, at, past, count);
    }
    return false;
}

TileResult resolveTileReference(const ResolveJob& job, const TileRect& tile,
                                TileWork work) noexcept {
    TileResult result{true, false};
    for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
            const ptrdiff_t at = y * job.stride + x;
            bool kept = false;
            if (work == TileWork::still) {
                kept = stillPixel(job, x, y);
            } else if (work == TileWork::general) {
                kept = resolvePixel(job, x, y);
            } else {
                storeOwner(job, at, findOwner(job, x, y));
                storeFirst(job, at);
            }
            result.changed |= !kept;
            result.finished &= int(job.next.count[at]) >= job.sample_cap;
        }
    }
    return result;
}

}  // namespace still::taa
