// The gather of output pixels, one after the other: the truth that upscale-inl.h is tested against.

#include <algorithm>
#include <cstdlib>

#include "postfx/internal/layer.h"
#include "postfx/internal/owner.h"
#include "postfx/internal/upscale_gather.h"
#include "postfx/internal/upscale_rules.h"

namespace still::upscale {
namespace {

using taa::Layer;
using taa::Owner;
using taa::plusOffset;

/// Where a layer was in each frame, in 1/256 of that frame's pixels, and how it came there from the
/// frame after.
struct Way {
    struct Stop {
        int x_fx8 = 0, y_fx8 = 0;
        Motion motion;
    };
    Stop stop[kMaxRing];
    int frames = 0;
};

/// What the 3×3 window of a frame's pixel shows: see postfx/internal/gather_pixel.h.
struct Window {
    Layer owner, far;
    Way own_way, far_way;
    int normal = 0;
    bool moved = false;
    bool layered = false;
    bool apart = false;
    int frames = kMaxRing;
    int slide = 0;
};

bool inside(const Slot& slot, int x, int y) {
    return x >= 0 && x < slot.x.frame && y >= 0 && y < slot.y.frame;
}

/// Where the samples of the tile lie that holds the place.
taa::TileJitter jitterAt(const Slot& slot, int column, int row) {
    if (slot.in.tile_jitter == nullptr) {
        return {int16_t(slot.in.jitter_x_fx8), int16_t(slot.in.jitter_y_fx8)};
    }
    const int x = std::clamp(column, 0, slot.x.frame - 1) / kTileSize;
    const int y = std::clamp(row, 0, slot.y.frame - 1) / kTileSize;
    return slot.in.tile_jitter[y * ((slot.x.frame + kTileSize - 1) / kTileSize) + x];
}

/// The pixel's owner as it was recorded.
Owner ownerOf(const taa::Job& job, int x, int y) {
    const ptrdiff_t at = y * job.stride + x;
    const taa::SlotIn& now = job.slot[0];
    Owner owner;
    owner.surface = now.owner[at] & int(kSurfaceMask);
    owner.inferred = (now.owner[at] & taa::kInferredBit) != 0;
    owner.moved = (job.hint[at] & 1) != 0;
    const int surface = now.id[at] & int(kSurfaceMask);
    owner.depth = plusOffset(now.owner_depth[at]);
    owner.expected = owner.depth + (job.hint[at] >> 1);
    owner.motion = {now.motion[0][at], now.motion[1][at]};
    owner.normal = uint16_t(now.normal[at]);
    owner.slope = surface == owner.surface && !owner.inferred
                      ? std::min(owner.depth - plusOffset(now.depth[at]), taa::kMaxSlope)
                      : 0;
    return owner;
}

int framesOf(const taa::Job& job, int x, int y, const Owner& seen, bool layered) {
    int frames = kMaxRing;
    if (!layered && !seen.inferred) {
        frames = taa::lowContrast(job, x, y, taa::kFlatShift)   ? kFlatFrames
                 : taa::lowContrast(job, x, y, taa::kCalmShift) ? kCalmFrames
                                                                : kMaxRing;
    }
    if (std::max(std::abs(seen.motion.x_fx8), std::abs(seen.motion.y_fx8)) > taa::kFast) {
        frames = std::min(frames, taa::kFastFrames);
    }
    const bool may_turn = seen.moved || seen.inferred;
    if (may_turn && job.turning != nullptr && job.turning[seen.surface] != 0) {
        frames = std::min(frames, taa::kTurningFrames);
    }
    if (job.light_age != nullptr) {
        frames = std::min(frames, job.light_age[y * job.stride + x] + 1);
    }
    return frames;
}

/// Follows the layer from the pixel's centre. The motion from one frame to the next is what the
/// nearest sample's owner recorded, as long as that is the same surface at the expected depth.
Way wayOf(const Job& job, int x, int y, const Layer& layer, int frames) {
    Way way;
    Motion motion = layer.motion;
    int px = x * 256, py = y * 256;
    for (int k = 0; k < frames; ++k) {
        const Slot& slot = job.slot[k];
        if (k > 0) {
            if (motion.x_fx8 == kNoHistory) {
                return way;
            }
            px = slot.x.fromSize(px + motion.x_fx8, job.slot[k - 1].x);
            py = slot.y.fromSize(py + motion.y_fx8, job.slot[k - 1].y);
        }
        way.stop[way.frames++] = {px, py, motion};
        const taa::TileJitter jitter = jitterAt(slot, px >> 8, py >> 8);
        const int nx = (px - jitter.x_fx8 + 128) >> 8, ny = (py - jitter.y_fx8 + 128) >> 8;
        if (!inside(slot, nx, ny)) {
            return way;
        }
        const ptrdiff_t at = ny * slot.stride + nx;
        const int difference = plusOffset(slot.in.owner_depth[at]) - layer.depthAt(k);
        if (k > 0 && (slot.in.owner[at] & int(kSurfaceMask)) == layer.surface &&
            std::abs(difference) <= 2 * layer.toleranceAt(k)) {
            motion = {slot.in.motion[0][at], slot.in.motion[1][at]};
        }
    }
    return way;
}

Window lookAround(const Job& job, int x, int y) {
    const taa::Job& frame = job.frame;
    const Owner seen = ownerOf(frame, x, y);
    Window window;
    window.owner = taa::layerOf(seen.surface, seen.depth, seen.expected, seen.motion, seen.slope);
    window.normal = int(seen.normal);
    window.moved = seen.moved;
    const ptrdiff_t at = taa::farthestInWindow(frame, x, y);
    window.far = taa::layerOf(frame.now.id[at] & kSurfaceMask, logDepth16(frame.now.depth[at]),
                              frame.now.depth_before[at], frame.now.motion[at], 0);
    window.layered = window.owner.depth - window.far.depth >
                     taa::kDepthTolerance + 2 * taa::kSlopeFactor * seen.slope;
    window.frames = std::min(framesOf(frame, x, y, seen, window.layered), job.frames);
    window.slide = taa::slideOf(seen.motion, window.far.motion);
    window.apart = window.layered && seen.motion.x_fx8 != kNoHistory &&
                   window.far.motion.x_fx8 != kNoHistory && window.slide > taa::kApart;
    window.own_way = wayOf(job, x, y, window.owner, window.frames);
    if (window.apart) {
        window.far_way = wayOf(job, x, y, window.far, std::min(kFarFrames, window.frames));
    }
    return window;
}

bool litAsNow(const Job& job, const Window& window, int k, TapLayer place, const SlotIn& slot,
              ptrdiff_t at) {
    const int surface = slot.id[at] & int(kSurfaceMask);
    if (job.frame.change_age != nullptr && uint32_t(k) > job.frame.change_age[surface]) {
        return false;
    }
    if (!window.moved || place != TapLayer::same || window.normal == 0) {
        return true;
    }
    const taa::SmallNormal then = taa::decodeNormal(uint16_t(slot.normal[at]));
    const taa::SmallNormal now = taa::decodeNormal(uint32_t(window.normal));
    return taa::similarlyLit(taa::dotOf(then, now), taa::dotOf(then, then), taa::dotOf(now, now));
}

/// Whether an old sample on the owner's way counts: the rules of the gather.
bool counts(const Job& job, const Window& window, int k, TapLayer place, const SlotIn& slot,
            ptrdiff_t at, Motion motion) {
    const int surface = slot.id[at] & int(kSurfaceMask);
    const bool moved = (slot.id[at] & int(kMovedBit)) != 0;
    if (place == TapLayer::farther && !window.moved && moved &&
        !(window.layered && surface == window.far.surface)) {
        return false;  // it only went by
    }
    const bool plain = place == TapLayer::same || (place == TapLayer::farther && window.layered);
    if (!plain || (window.moved && moved)) {
        const Motion other{slot.motion[0][at], slot.motion[1][at]};
        const uint32_t* started = job.frame.start_age;
        if ((started != nullptr && uint32_t(k) > started[surface]) || other.x_fx8 == kNoHistory ||
            taa::slideOf(other, motion) * k > taa::kMaxSlide) {
            return false;
        }
    }
    return litAsNow(job, window, k, place, slot, at);
}

struct Tap {
    int weight;
    int ex, ey;  ///< its place, 1/64 output pixel
    bool behind;
    int rgb[3];
};
struct Taps {
    Tap tap[kMaxRing + 3];
    int count = 0;
    taa::Moments moments;

    void add(const SlotIn& slot, ptrdiff_t at, int weight, int ex, int ey, bool behind) {
        tap[count++] = {weight,
                        ex,
                        ey,
                        behind,
                        {plusOffset(slot.colour[0][at]), plusOffset(slot.colour[1][at]),
                         plusOffset(slot.colour[2][at])}};
        moments.add(weight, ex, ey);
    }
};

/// An output pixel: where its centre lies from that of the frame's pixel that holds it, in 1/256 of
/// the image's pixels.
struct Offset {
    int x_fx8 = 0, y_fx8 = 0;
};

/// Calls visit(k, slot, at, weight, ex, ey) for the samples along a way: of this frame the four
/// around, of older ones the nearest.
template <class Visit>
void visitSamples(const Job& job, const Way& way, Offset offset, Visit&& visit) {
    for (int k = 0; k < way.frames; ++k) {
        const Slot& slot = job.slot[k];
        const Way::Stop& stop = way.stop[k];
        const int px = stop.x_fx8 + slot.x.toFrame(offset.x_fx8);
        const int py = stop.y_fx8 + slot.y.toFrame(offset.y_fx8);
        const taa::TileJitter jitter = jitterAt(slot, stop.x_fx8 >> 8, stop.y_fx8 >> 8);
        const int sx = px - jitter.x_fx8, sy = py - jitter.y_fx8;
        const int middle = k == 0 ? 0 : 128;
        const int x0 = (sx + middle) >> 8, y0 = (sy + middle) >> 8;
        for (int t = 0; t < (k == 0 ? 4 : 1); ++t) {
            const int ix = x0 + (t & 1), iy = y0 + (t >> 1);
            const int dx = ix * 256 - sx, dy = iy * 256 - sy;
            const int ex = slot.x.toImage(dx), ey = slot.y.toImage(dy);
            const int weight = narrowWeight(ex, ey) + (k == 0 ? tentWeight(dx, dy) : kFarWeight);
            if (weight > 0 && inside(slot, ix, iy) && jitter.sameAs(jitterAt(slot, ix, iy))) {
                visit(k, slot.in, iy * slot.stride + ix, stop.motion, weight, upscale::placeOf(ex),
                      upscale::placeOf(ey));
            }
        }
    }
}

/// taa::fit(), places may lie farther away.
bool fit(const Taps& taps, const int* behind, int rgb[3]) {
    if (taps.moments.w < 2) {
        return false;
    }
    const taa::Tilt tilt = taa::tiltOf(taps.moments);
    int total = 0;
    uint32_t sum[3] = {};
    for (int i = 0; i < taps.count; ++i) {
        const Tap& tap = taps.tap[i];
        const int weight = std::max(taa::tiltedWeight(tap.weight, tilt, tap.ex, tap.ey), 0);
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
        rgb[c] = taa::weightedMean(sum[c], total);
    }
    return true;
}

/// The farther layer's colour here and now.
bool farColour(const Job& job, const Window& window, Offset offset, int rgb[3]) {
    Taps taps;
    visitSamples(job, window.far_way, offset,
                 [&](int k, const SlotIn& slot, ptrdiff_t at, Motion, int weight, int ex, int ey) {
                     const int surface = slot.id[at] & int(kSurfaceMask);
                     const int depth = plusOffset(slot.depth[at]);
                     if (taa::placeOf(window.owner, k, surface, depth) == TapLayer::farther &&
                         taa::placeOf(window.far, k, surface, depth) != TapLayer::nearer &&
                         litAsNow(job, window, k, TapLayer::farther, slot, at)) {
                         taps.add(slot, at, weight, ex, ey, true);
                     }
                 });
    return fit(taps, nullptr, rgb);
}

void gatherPixel(const Job& job, const Window& window, int x, int y, Offset offset) {
    int behind[3], rgb[3];
    const bool separate = window.apart && farColour(job, window, offset, behind);
    Taps taps;
    visitSamples(
        job, window.own_way, offset,
        [&](int k, const SlotIn& slot, ptrdiff_t at, Motion motion, int weight, int ex, int ey) {
            const int surface = slot.id[at] & int(kSurfaceMask);
            const int depth = plusOffset(slot.depth[at]);
            const TapLayer place = taa::placeOf(window.owner, k, surface, depth);
            if (k > 0 && !counts(job, window, k, place, slot, at, motion)) {
                return;
            }
            const int above = depth - window.far.depthAt(k);
            const bool left = window.slide * k > taa::kMaxLag &&
                              above * 4 < window.owner.depthAt(k) - window.far.depthAt(k);
            taps.add(slot, at, weight, ex, ey, place == TapLayer::farther && left);
        });
    const ptrdiff_t at = y * job.stride + x;
    if (!fit(taps, separate ? behind : nullptr, rgb)) {
        const ptrdiff_t from = nearestInFrame(job, x, y);
        for (int c = 0; c < 3; ++c) {
            rgb[c] = job.frame.now.colour[c][from];
        }
    }
    for (int c = 0; c < 3; ++c) {
        job.shown[c][at] = uint16_t(rgb[c]);
    }
    job.shown_count[at] = uint8_t(std::clamp(roundShift(taps.moments.w, 7), 1, 255));
}

}  // namespace

void gatherTileReference(const Job& job, const TileRect& tile, bool sums_valid) noexcept {
    const auto wanted = [&](int x, int y) {
        return !sums_valid || job.sums.count[y * job.stride + x] < job.settled;
    };
    for (int row = tile.y0; row < tile.y1; ++row) {
        for (int column = tile.x0; column < tile.x1; ++column) {
            const TileRect out = outputRect(job, {column, row, column + 1, row + 1});
            Window window;
            bool known = false;
            for (int y = out.y0; y < out.y1; ++y) {
                for (int x = out.x0; x < out.x1; ++x) {
                    if (!wanted(x, y)) {
                        continue;
                    }
                    if (!known) {
                        window = lookAround(job, column, row);
                        known = true;
                    }
                    gatherPixel(job, window, x, y,
                                {job.x.offsetOf(x, column), job.y.offsetOf(y, row)});
                }
            }
        }
    }
}

}  // namespace still::upscale
