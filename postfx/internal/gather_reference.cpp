// The gather, one pixel after the other: the truth that gather-inl.h is tested against.

#include "postfx/internal/gather.h"

#include "postfx/internal/gather_pixel.h"
#include "postfx/spatial.h"

namespace still::taa {
namespace {

bool inside(const Job& job, int x, int y) {
    return x >= 0 && x < job.width && y >= 0 && y < job.height;
}

Window lookAround(const Job& job, int x, int y, const Owner& seen) {
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
    if (job.light_age != nullptr) {
        window.lit_frames = job.light_age[y * job.stride + x] + 1;
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

Verdict judgeShading(const Job& job, const Window& window, int k, TapLayer place,
                     const SlotIn& slot, ptrdiff_t at) {
    const int surface = surfaceAt(slot, at);
    if (job.change_age != nullptr && uint32_t(k) > job.change_age[surface]) {
        return Verdict::epoch;
    }
    if (!window.moved || place != TapLayer::same || window.normal == 0) {
        return Verdict::taken;
    }
    const SmallNormal then = decodeNormal(uint16_t(slot.normal[at]));
    const SmallNormal now = decodeNormal(window.normal);
    const bool alike = similarlyLit(dotOf(then, now), dotOf(then, then), dotOf(now, now));
    return alike ? Verdict::taken : Verdict::normal;
}

void note(Sightings* sightings, const Sighting& sighting) {
    if (sightings != nullptr) {
        sightings->at[sightings->count++] = sighting;
    }
}

void noteEnd(Sightings* sightings, int age, Verdict reason) {
    if (sightings != nullptr) {
        sightings->end_age = age;
        sightings->end = reason;
    }
}

/// Follows `layer` back and calls visit(sighting, slot, at, motion) for every sample with a weight
/// that can be seen, where motion is the layer's way from the frame after to the sample's. It
/// judges the sighting.
template <class Visit>
void follow(const Job& job, int x, int y, const Layer& layer, int frames, int lit_frames,
            Sightings* sightings, Visit&& visit) {
    Motion motion = layer.motion;
    int px = x * 256, py = y * 256;
    if (sightings != nullptr) {
        sightings->frames = sightings->end_age = frames;
    }
    for (int k = 0; k < frames; ++k) {
        const SlotIn& slot = job.slot[k];
        if (k >= lit_frames) {
            noteEnd(sightings, k, Verdict::epoch);
            return;
        }
        if (k > 0) {
            if (motion.x_fx8 == kNoHistory) {
                noteEnd(sightings, k, Verdict::no_history);
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
            if (weight == 0) {
                continue;
            }
            Sighting sighting{.age = k,
                              .x = ix + i,
                              .y = iy + j,
                              .weight = weight,
                              .ex = still::taa::placeOf(i * 256 - fx),
                              .ey = still::taa::placeOf(j * 256 - fy)};
            if (!inside(job, sighting.x, sighting.y)) {
                sighting.verdict = Verdict::off_screen;
            } else if (apart && !jitter.sameAs(jitterOf(job, slot, sighting.x, sighting.y))) {
                sighting.verdict = Verdict::seam;
            } else {
                visit(sighting, slot, sighting.y * job.stride + sighting.x, motion);
            }
            note(sightings, sighting);
        }
        const int nx = (sx + 128) >> 8, ny = (sy + 128) >> 8;
        if (!inside(job, nx, ny)) {
            noteEnd(sightings, k + 1, Verdict::off_screen);
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

void addTap(Taps& taps, const SlotIn& slot, ptrdiff_t at, const Sighting& s, bool behind) {
    Tap& tap = taps.tap[taps.count++];
    tap = {s.weight,
           s.ex,
           s.ey,
           behind,
           {plusOffset(slot.colour[0][at]), plusOffset(slot.colour[1][at]),
            plusOffset(slot.colour[2][at])}};
    taps.moments.add(s.weight, s.ex, s.ey);
    taps.fresh += s.age == 0 ? 1 : 0;
    taps.old_weight += s.age > 0 ? s.weight : 0;
}

/// The farther layer's samples, where the owner did not hide it.
void collectFar(const Job& job, int x, int y, const Window& window, Taps& taps,
                Sightings* sightings) {
    follow(job, x, y, window.far, std::min(kFarFrames, job.frames), window.lit_frames, sightings,
           [&](Sighting& s, const SlotIn& slot, ptrdiff_t at, Motion) {
               const int surface = surfaceAt(slot, at);
               const int depth = depthAt(slot, at);
               const bool behind =
                   placeOf(window.owner, s.age, surface, depth) == TapLayer::farther;
               s.layer = placeOf(window.far, s.age, surface, depth);
               s.verdict = behind && s.layer != TapLayer::nearer
                               ? judgeShading(job, window, s.age, TapLayer::farther, slot, at)
                               : Verdict::depth;
               if (s.verdict == Verdict::taken) {
                   addTap(taps, slot, at, s, true);
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
bool passedBehind(const Window& window, const SlotIn& slot, ptrdiff_t at, TapLayer place) {
    return place == TapLayer::farther && !window.moved && movedAt(slot, at) &&
           surfaceAt(slot, at) != window.far.surface;
}

/// Of the past, a sample at `place` seen from the owner; `motion` is the owner's into its frame.
Verdict judgeOwn(const Job& job, const Window& window, int k, TapLayer place, const SlotIn& slot,
                 ptrdiff_t at, Motion motion) {
    if (passedBehind(window, slot, at, place)) {
        return Verdict::id;
    }
    const bool plain = place == TapLayer::same || (place == TapLayer::farther && window.layered);
    if (!plain || (window.moved && movedAt(slot, at))) {
        const int surface = surfaceAt(slot, at);
        const Motion other = motionAt(slot, at);
        const bool left = job.start_age != nullptr && uint32_t(k) > job.start_age[surface];
        if (left || other.x_fx8 == kNoHistory) {
            return Verdict::velocity;
        }
        if (slideOf(other, motion) * k > kMaxSlide) {
            const int off = std::abs(depthAt(slot, at) - window.owner.depthAt(k));
            return plain                                ? Verdict::velocity
                   : off <= window.owner.toleranceAt(k) ? Verdict::id
                                                        : Verdict::depth;
        }
    }
    return judgeShading(job, window, k, place, slot, at);
}

/// Samples along the owner's way: its own, and what was seen beside it.
void collectOwn(const Job& job, int x, int y, const Window& window, Taps& taps,
                Sightings* sightings) {
    follow(job, x, y, window.owner, std::min(window.frames, job.frames), window.lit_frames,
           sightings, [&](Sighting& s, const SlotIn& slot, ptrdiff_t at, Motion motion) {
               const int depth = depthAt(slot, at);
               s.layer = placeOf(window.owner, s.age, surfaceAt(slot, at), depth);
               if (s.age > 0) {
                   s.verdict = judgeOwn(job, window, s.age, s.layer, slot, at, motion);
               }
               if (s.verdict == Verdict::taken) {
                   addTap(taps, slot, at, s,
                          s.layer == TapLayer::farther && leftBehind(window, s.age, depth));
               }
           });
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

bool fit(const Taps& taps, const int* behind, int rgb[3]) noexcept {
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

void mixSpatial(const Job& job, int x, int y, int old_weight, int rgb[3]) noexcept {
    int spatial[3];
    spatialPixel(spatialInputOf(job), x, y, spatial);
    for (int c = 0; c < 3; ++c) {
        rgb[c] = roundShift(rgb[c] * old_weight + spatial[c] * (kFrameWeight - old_weight), 8);
    }
}

void gatherTaps(const Job& job, int x, int y, GatherSteps& s, PixelSightings* sightings) noexcept {
    s.seen = inferOwner(job, x, y, seenOwner(job, x, y));
    s.window = lookAround(job, x, y, s.seen);
    if (s.window.apart) {
        collectFar(job, x, y, s.window, s.far, sightings != nullptr ? &sightings->far : nullptr);
    }
    collectOwn(job, x, y, s.window, s.own, sightings != nullptr ? &sightings->own : nullptr);
}

void gatherColour(const Job& job, int x, int y, GatherSteps& s) noexcept {
    s.separate = s.window.apart && fit(s.far, nullptr, s.behind);
    if (!fit(s.own, s.separate ? s.behind : nullptr, s.rgb)) {
        for (int c = 0; c < 3; ++c) {
            s.rgb[c] = job.now.colour[c][y * job.stride + x];
        }
    }
    if (s.own.old_weight < kFrameWeight && !s.window.flat) {
        s.spatial_q8 = kFrameWeight - s.own.old_weight;
        mixSpatial(job, x, y, s.own.old_weight, s.rgb);
    }
}

void gatherPixel(const Job& job, int x, int y) noexcept {
    GatherSteps steps;
    gatherTaps(job, x, y, steps);
    gatherColour(job, x, y, steps);
    const ptrdiff_t at = y * job.stride + x;
    for (int c = 0; c < 3; ++c) {
        job.shown[c][at] = uint16_t(steps.rgb[c]);
    }
    job.shown_count[at] = uint8_t(roundShift(steps.own.moments.w, 8));
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
