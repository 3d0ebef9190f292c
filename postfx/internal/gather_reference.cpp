// The gather, one pixel after the other: the truth that gather-inl.h is tested against.

#include "postfx/internal/gather.h"

#include <algorithm>
#include <cstdlib>

#include "postfx/internal/owner.h"
#include "postfx/internal/rules.h"
#include "postfx/spatial.h"

namespace still::taa {
namespace {

/// A surface on its way back through the frames.
struct Layer {
    int surface = 0, depth = 0;
    int step = 0;  ///< change of depth per frame into the past
    int tolerance = 0;
    Motion motion;

    int depthAt(int k) const { return std::clamp(depth + step * k, 0, 65535); }
    int toleranceAt(int k) const {
        return tolerance + (std::min(std::abs(step) * k, 32767) >> kStepShift);
    }
};

Layer layerOf(int surface, int depth, int expected, Motion motion, int slope) {
    return {surface, depth, heldStep(expected - depth), kDepthTolerance + kSlopeFactor * slope,
            motion};
}

enum class Place : uint8_t { nearer, same, farther };

Place placeOf(const Layer& layer, int k, int surface, int depth) {
    const int difference = depth - layer.depthAt(k);
    const int tolerance = layer.toleranceAt(k);
    if (surface == layer.surface && std::abs(difference) <= tolerance) {
        return Place::same;
    }
    return difference > tolerance ? Place::nearer : Place::farther;
}

/// What the window shows: its owner, and the farthest sample when that lies behind the owner.
struct Window {
    Layer owner, far;
    uint32_t normal = 0;
    bool moved = false;
    bool layered = false;   ///< two surfaces, one behind the other
    bool apart = false;     ///< … that move differently …
    bool flat = false;      ///< one surface with next to no contrast
    int frames = kMaxRing;  ///< to follow: fewer where there is one surface with little contrast
    int slide = 0;          ///< … by this much per frame (1/256 pixel, larger axis)
};

/// One sample near the pixel's centre.
struct Tap {
    int weight = 0;
    int ex = 0, ey = 0;   ///< its place, 1/64 pixel
    bool behind = false;  ///< shows what is behind the owner
    int rgb[3] = {};
};

struct Taps {
    Tap tap[4 * kMaxRing];
    int count = 0;
    int old_weight = 0;  ///< of the frames before this one
    Moments moments;
};

bool inside(const Job& job, int x, int y) {
    return x >= 0 && x < job.width && y >= 0 && y < job.height;
}

ptrdiff_t farthestInWindow(const Job& job, int x, int y) {
    // Columns first; ties: middle before top before bottom, middle before left before right.
    const auto better = [&](ptrdiff_t a, ptrdiff_t b) {
        return logDepth16(job.now.depth[b]) < logDepth16(job.now.depth[a]) ? b : a;
    };
    const auto column = [&](int cx) {
        const ptrdiff_t centre = y * job.stride + cx;
        ptrdiff_t best = centre;
        best = y > 0 ? better(best, centre - job.stride) : best;
        return y + 1 < job.height ? better(best, centre + job.stride) : best;
    };
    ptrdiff_t best = column(x);
    best = x > 0 ? better(best, column(x - 1)) : best;
    return x + 1 < job.width ? better(best, column(x + 1)) : best;
}

int slideOf(Motion a, Motion b) {
    return std::max(std::abs(a.x_fx8 - b.x_fx8), std::abs(a.y_fx8 - b.y_fx8));
}

/// Every channel of the window spans at most contrastBound().
bool lowContrast(const Job& job, int x, int y, int shift) {
    bool low_contrast = true;
    for (const uint16_t* plane : job.now.colour) {
        int low = 65535, high = 0;
        for (int j = std::max(y - 1, 0); j <= std::min(y + 1, job.height - 1); ++j) {
            for (int i = std::max(x - 1, 0); i <= std::min(x + 1, job.width - 1); ++i) {
                low = std::min<int>(low, plane[j * job.stride + i]);
                high = std::max<int>(high, plane[j * job.stride + i]);
            }
        }
        low_contrast &= high - low <= contrastBound(high, shift);
    }
    return low_contrast;
}

Window lookAround(const Job& job, int x, int y) {
    const Owner seen = inferOwner(job, x, y, seenOwner(job, x, y));
    Window window;
    window.owner = layerOf(seen.surface, seen.depth, seen.expected, seen.motion, seen.slope);
    window.normal = seen.normal;
    window.moved = seen.moved;
    const ptrdiff_t far = farthestInWindow(job, x, y);
    window.far = layerOf(job.now.id[far] & kSurfaceMask, logDepth16(job.now.depth[far]),
                         job.now.depth_before[far], job.now.motion[far], 0);
    window.layered =
        window.owner.depth - window.far.depth > kDepthTolerance + 2 * kSlopeFactor * seen.slope;
    if (!window.layered && !seen.inferred) {
        window.frames = lowContrast(job, x, y, kFlatShift)   ? kFlatFrames
                        : lowContrast(job, x, y, kCalmShift) ? kCalmFrames
                                                             : kMaxRing;
    }
    window.flat = window.frames == kFlatFrames;
    if (std::max(std::abs(seen.motion.x_fx8), std::abs(seen.motion.y_fx8)) > kFast) {
        window.frames = std::min(window.frames, kFastFrames);
    }
    const bool may_turn = seen.moved || seen.inferred;
    if (may_turn && job.turning != nullptr && job.turning[seen.surface] != 0) {
        window.frames = std::min(window.frames, kTurningFrames);
    }
    window.slide = slideOf(seen.motion, window.far.motion);
    window.apart = window.layered && seen.motion.x_fx8 != kNoHistory &&
                   window.far.motion.x_fx8 != kNoHistory && window.slide > kApart;
    return window;
}

int surfaceAt(const SlotIn& slot, ptrdiff_t at) {
    return slot.id[at] & int(kSurfaceMask);
}

int depthAt(const SlotIn& slot, ptrdiff_t at) {
    return plusOffset(slot.depth[at]);
}

bool movedAt(const SlotIn& slot, ptrdiff_t at) {
    return (slot.id[at] & int(kMovedBit)) != 0;
}

Motion motionAt(const SlotIn& slot, ptrdiff_t at) {
    return {slot.motion[0][at], slot.motion[1][at]};
}

bool staleShading(const Job& job, const Window& window, int k, Place place, const SlotIn& slot,
                  ptrdiff_t at) {
    const int surface = surfaceAt(slot, at);
    if (job.change_age != nullptr && uint32_t(k) > job.change_age[surface]) {
        return true;
    }
    if (!window.moved || place != Place::same || window.normal == 0) {
        return false;
    }
    const SmallNormal then = decodeNormal(uint16_t(slot.normal[at]));
    const SmallNormal now = decodeNormal(window.normal);
    return !similarlyLit(dotOf(then, now), dotOf(then, then), dotOf(now, now));
}

/// Follows `layer` back and calls visit(k, slot, at, weight, ex, ey, motion) for every sample with
/// a weight, where motion is the layer's way from the frame after to frame k.
template <class Visit>
void follow(const Job& job, int x, int y, const Layer& layer, int frames, Visit&& visit) {
    Motion motion = layer.motion;
    int px = x * 256, py = y * 256;
    for (int k = 0; k < frames; ++k) {
        const SlotIn& slot = job.slot[k];
        if (k > 0) {
            if (motion.x_fx8 == kNoHistory) {
                return;
            }
            px += motion.x_fx8;
            py += motion.y_fx8;
        }
        const bool apart = slot.tile_jitter != nullptr;
        const TileJitter jitter =
            apart ? jitterOf(job, slot, px >> 8, py >> 8)
                  : TileJitter{int16_t(slot.jitter_x_fx8), int16_t(slot.jitter_y_fx8)};
        const int sx = px - jitter.x_fx8, sy = py - jitter.y_fx8;
        const int ix = sx >> 8, iy = sy >> 8, fx = sx & 255, fy = sy & 255;
        const int wx = axisWeight(fx), wy = axisWeight(fy);
        for (int tap = 0; tap < 4; ++tap) {
            const int i = tap & 1, j = tap >> 1;
            const int weight = (i != 0 ? wx : kAxisWeight - wx) * (j != 0 ? wy : kAxisWeight - wy);
            const bool seen = inside(job, ix + i, iy + j) &&
                              (!apart || jitter.sameAs(jitterOf(job, slot, ix + i, iy + j)));
            if (weight != 0 && seen) {
                visit(k, slot, (iy + j) * job.stride + ix + i, weight,
                      still::taa::placeOf(i * 256 - fx), still::taa::placeOf(j * 256 - fy), motion);
            }
        }
        const int nx = (sx + 128) >> 8, ny = (sy + 128) >> 8;
        if (!inside(job, nx, ny)) {
            return;
        }
        const ptrdiff_t nearest = ny * job.stride + nx;
        const int difference = plusOffset(slot.owner_depth[nearest]) - layer.depthAt(k);
        if (k > 0 && (slot.owner[nearest] & int(kSurfaceMask)) == layer.surface &&
            std::abs(difference) <= 2 * layer.toleranceAt(k)) {
            motion = motionAt(slot, nearest);
        }
    }
}

void addTap(Taps& taps, const SlotIn& slot, ptrdiff_t at, int k, int weight, int ex, int ey,
            bool behind) {
    Tap& tap = taps.tap[taps.count++];
    tap = {weight,
           ex,
           ey,
           behind,
           {plusOffset(slot.colour[0][at]), plusOffset(slot.colour[1][at]),
            plusOffset(slot.colour[2][at])}};
    taps.moments.add(weight, ex, ey);
    taps.old_weight += k > 0 ? weight : 0;
}

/// The farther layer's samples, where the owner did not hide it.
void collectFar(const Job& job, int x, int y, const Window& window, Taps& taps) {
    follow(job, x, y, window.far, std::min(kFarFrames, job.frames),
           [&](int k, const SlotIn& slot, ptrdiff_t at, int weight, int ex, int ey, Motion) {
               const int surface = surfaceAt(slot, at);
               const int depth = depthAt(slot, at);
               const bool behind = placeOf(window.owner, k, surface, depth) == Place::farther;
               const bool there = placeOf(window.far, k, surface, depth) != Place::nearer;
               if (behind && there && !staleShading(job, window, k, Place::farther, slot, at)) {
                   addTap(taps, slot, at, k, weight, ex, ey, true);
               }
           });
}

/// A sample behind the owner's way that shows the farther layer where it was, not where it is.
bool leftBehind(const Window& window, int k, int depth) {
    const int above = depth - window.far.depthAt(k);
    return window.slide * k > kMaxLag &&
           above * 4 < window.owner.depthAt(k) - window.far.depthAt(k);
}

/// Behind an owner at rest something went by that is not behind it any more.
bool passedBehind(const Window& window, const SlotIn& slot, ptrdiff_t at, Place place) {
    return place == Place::farther && !window.moved && movedAt(slot, at) &&
           surfaceAt(slot, at) != window.far.surface;
}

/// Samples along the owner's way: its own, and what was seen beside it.
void collectOwn(const Job& job, int x, int y, const Window& window, Taps& taps) {
    follow(
        job, x, y, window.owner, std::min(window.frames, job.frames),
        [&](int k, const SlotIn& slot, ptrdiff_t at, int weight, int ex, int ey, Motion motion) {
            const int surface = surfaceAt(slot, at);
            const int depth = depthAt(slot, at);
            const Place place = placeOf(window.owner, k, surface, depth);
            if (k > 0 && passedBehind(window, slot, at, place)) {
                return;
            }
            const bool plain = place == Place::same || (place == Place::farther && window.layered);
            if (!plain || (window.moved && movedAt(slot, at))) {
                const Motion other = motionAt(slot, at);
                const bool left = job.start_age != nullptr && uint32_t(k) > job.start_age[surface];
                if (k > 0 &&
                    (left || other.x_fx8 == kNoHistory || slideOf(other, motion) * k > kMaxSlide)) {
                    return;
                }
            }
            if (k > 0 && staleShading(job, window, k, place, slot, at)) {
                return;
            }
            addTap(taps, slot, at, k, weight, ex, ey,
                   place == Place::farther && leftBehind(window, k, depth));
        });
}

/// The samples' plane at the pixel's centre. `behind` replaces the colours of taps behind.
bool fit(const Taps& taps, const int* behind, int rgb[3]) {
    if (taps.moments.w < 2) {
        return false;
    }
    const Tilt tilt = tiltOf(taps.moments);
    int total = 0;
    uint32_t sum[3] = {};
    for (int i = 0; i < taps.count; ++i) {
        const Tap& tap = taps.tap[i];
        const int weight = tiltedWeight(tap.weight, tilt, tap.ex, tap.ey);
        const int* colour = tap.behind && behind != nullptr ? behind : tap.rgb;
        total += weight;
        for (int c = 0; c < 3; ++c) {
            sum[c] += uint32_t(weight) * uint32_t(colour[c]);
        }
    }
    if (total < 2) {
        return false;
    }
    for (int c = 0; c < 3; ++c) {
        rgb[c] = weightedMean(sum[c], total);
    }
    return true;
}

SpatialInput spatialInputOf(const Job& job) {
    const auto view = [&](auto* data) {
        return ImageView<std::remove_pointer_t<decltype(data)>>{data, job.width, job.height,
                                                                job.stride};
    };
    return {
        .colour = {view(job.now.colour[0]), view(job.now.colour[1]), view(job.now.colour[2])},
        .id = view(job.now.id),
        .normal = job.now.normal != nullptr ? view(job.now.normal) : ImageView<const uint32_t>{},
        .jitter_x_fx8 = job.slot[0].jitter_x_fx8,
        .jitter_y_fx8 = job.slot[0].jitter_y_fx8};
}

}  // namespace

void mixSpatial(const Job& job, int x, int y, int old_weight, int rgb[3]) noexcept {
    int spatial[3];
    spatialPixel(spatialInputOf(job), x, y, spatial);
    for (int c = 0; c < 3; ++c) {
        rgb[c] = roundShift(rgb[c] * old_weight + spatial[c] * (kFrameWeight - old_weight), 8);
    }
}

void gatherPixel(const Job& job, int x, int y) noexcept {
    const Window window = lookAround(job, x, y);
    int behind[3];
    bool separate = false;
    if (window.apart) {
        Taps taps;
        collectFar(job, x, y, window, taps);
        separate = fit(taps, nullptr, behind);
    }
    Taps taps;
    collectOwn(job, x, y, window, taps);
    const ptrdiff_t at = y * job.stride + x;
    int rgb[3];
    if (!fit(taps, separate ? behind : nullptr, rgb)) {
        for (int c = 0; c < 3; ++c) {
            rgb[c] = job.now.colour[c][at];
        }
    }
    if (taps.old_weight < kFrameWeight && !window.flat) {
        mixSpatial(job, x, y, taps.old_weight, rgb);
    }
    for (int c = 0; c < 3; ++c) {
        job.shown[c][at] = uint16_t(rgb[c]);
    }
    job.shown_count[at] = uint8_t(roundShift(taps.moments.w, 8));
}

void gatherTileReference(const Job& job, const TileRect& tile, bool sums_valid) noexcept {
    for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
            if (!sums_valid || job.sums.count[y * job.stride + x] < job.settled) {
                gatherPixel(job, x, y);
            }
        }
    }
}

}  // namespace still::taa
