// Layers in lanes: which samples count for a pixel, and where its layers were in each frame.
// gather_reference.cpp is the truth. Included once per target by taa_simd.cpp.

HWY_BEFORE_NAMESPACE();
namespace still::taa {
namespace HWY_NAMESPACE {

HWY_INLINE V32 surfaceOf(V32 blue_id) {
    return hn::And(high(blue_id), hn::Set(D32(), kSurfaceMask));
}

/// A surface on its way back through the frames.
struct LayerLanes {
    V32 surface, motion;
    VI32 depth, step, tolerance;
};
struct Expected {
    VI32 depth, tolerance;
};
HWY_INLINE Expected expectedAt(const LayerLanes& layer, int k) {
    const DI32 di;
    const VI32 frames = hn::Set(di, k);
    const VI32 drift = hn::Mul(hn::Abs(layer.step), frames);
    return {hn::Add(layer.depth, hn::Mul(layer.step, frames)),
            hn::Add(layer.tolerance, hn::ShiftRight<kStepShift>(drift))};
}

struct WindowLanes {
    LayerLanes owner, far;
    V32 normal;
    VI32 slide;
    VI32 frames;  ///< to follow
    Mask32 moved, layered, apart, flat;
};

/// The accepted samples of the group's pixels.
struct Kept {
    struct Frame {
        V32 weight[4], red_green[4], blue[4];  ///< high half of blue: shows what is behind
        VI32 ex, ey;
    };
    Frame frame[kMaxRing];
    int frames = 0;
    VI32 w, x, y, xx, xy, yy;
    VI32 old_weight;

    HWY_INLINE void clear() {
        frames = 0;
        w = x = y = xx = xy = yy = old_weight = hn::Zero(DI32());
    }
};

HWY_INLINE Site siteOf(const Job& job, VI32 px, VI32 py, const SlotIn& slot, Mask32 alive) {
    const DI32 di;
    const D32 d;
    const VI32 sx = hn::Sub(px, hn::Set(di, slot.jitter_x_fx8));
    const VI32 sy = hn::Sub(py, hn::Set(di, slot.jitter_y_fx8));
    Site site;
    site.ix = hn::ShiftRight<8>(sx);
    site.iy = hn::ShiftRight<8>(sy);
    site.fx = hn::And(asUnsigned(sx), hn::Set(d, 255));
    site.fy = hn::And(asUnsigned(sy), hn::Set(d, 255));
    const auto axis = [&](V32 f) {
        const VI32 scaled = hn::Add(hn::Mul(hn::Sub(asSigned(f), hn::Set(di, 51)), hn::Set(di, 53)),
                                    hn::Set(di, 271));
        return asUnsigned(
            hn::Min(hn::Max(hn::ShiftRight<9>(scaled), hn::Zero(di)), hn::Set(di, kAxisWeight)));
    };
    const V32 full = hn::Set(d, kAxisWeight);
    const VI32 one = hn::Set(di, 1);
    const auto inside = [&](VI32 v, int size, V32 w) {
        return hn::IfThenElseZero(hn::And(within(v, size), alive), w);
    };
    const V32 right = axis(site.fx), lower = axis(site.fy);
    const V32 wx[2] = {inside(site.ix, job.width, hn::Sub(full, right)),
                       inside(hn::Add(site.ix, one), job.width, right)};
    const V32 wy[2] = {inside(site.iy, job.height, hn::Sub(full, lower)),
                       inside(hn::Add(site.iy, one), job.height, lower)};
    site.wanted = hn::Zero(d);
    for (int tap = 0; tap < 4; ++tap) {
        site.weight[tap] = hn::Mul(wx[tap & 1], wy[tap >> 1]);
        site.wanted = hn::Add(site.wanted, site.weight[tap]);
    }
    site.ex = hn::ShiftRight<2>(hn::Neg(asSigned(site.fx)));
    site.ey = hn::ShiftRight<2>(hn::Neg(asSigned(site.fy)));
    return site;
}

HWY_INLINE VI32 slideOf(V32 a, V32 b) {
    return hn::Max(hn::Abs(hn::Sub(lowSigned(a), lowSigned(b))),
                   hn::Abs(hn::Sub(highSigned(a), highSigned(b))));
}

/// Lanes whose surfaces have ages under k.
HWY_INLINE Mask32 olderThan(const uint32_t* ages, int k, V32 surface) {
    const D32 d;
    const DI32 di;
    const V32 age = hn::GatherIndex(d, ages, asSigned(surface));
    return maskOf(hn::Lt(asSigned(age), hn::Set(di, k)));
}

/// Where a sample lies in depth relative to a layer: placeOf().
struct PlaceLanes {
    Mask32 same, farther;
    VI32 difference;
};
HWY_INLINE PlaceLanes placeOf(const LayerLanes& layer, const Expected& expected, V32 surface,
                              V32 depth) {
    const VI32 difference = hn::Sub(asSigned(depth), expected.depth);
    const Mask32 close = maskOf(atMost(hn::Abs(difference), expected.tolerance));
    const Mask32 same = hn::And(close, hn::Eq(surface, layer.surface));
    const Mask32 not_nearer = maskOf(atMost(difference, expected.tolerance));
    return {same, hn::AndNot(same, not_nearer), difference};
}

/// Samples along the owner's way: collectOwn(). kBehind: some lanes have a layer behind that moves
/// differently.
template <bool kBehind>
struct OwnRule {
    const Job& job;
    const WindowLanes& window;
    Normals normal;
    bool any_moved;

    /// leftBehind(): 0x10000 where true.
    HWY_INLINE V32 leftBehind(int k, const Expected& own, const PlaceLanes& place,
                              V32 depth) const {
        const DI32 di;
        const Expected far = expectedAt(window.far, k);
        const VI32 lag = hn::Mul(window.slide, hn::Set(di, k));
        const Mask32 lags = maskOf(hn::Gt(lag, hn::Set(di, kMaxLag)));
        const VI32 above = hn::ShiftLeft<2>(hn::Sub(asSigned(depth), far.depth));
        const Mask32 low = maskOf(hn::Lt(above, hn::Sub(own.depth, far.depth)));
        return hn::IfThenElseZero(hn::And(hn::And(place.farther, lags), low),
                                  hn::Set(D32(), 0x10000));
    }

    HWY_INLINE void operator()(int k, const SlotIn& slot, const Address& address, V32 way,
                               const Samples& samples, V32 weight[4], V32 behind[4]) const {
        const D32 d;
        const DI32 di;
        const Expected own = expectedAt(window.owner, k);
        Mask32 hard[4], same[4];
        Mask32 any_hard = hn::MaskFromVec(hn::Zero(d));
        for (int t = 0; t < 4; ++t) {
            const V32 surface = surfaceOf(samples.blue_id.of[t]);
            const V32 depth = low(samples.depths.of[t]);
            const PlaceLanes place = placeOf(window.owner, own, surface, depth);
            const Mask32 easy = hn::Or(place.same, hn::And(place.farther, window.layered));
            same[t] = place.same;
            const Mask32 moved =
                hn::Ne(hn::And(samples.blue_id.of[t], hn::Set(d, kMovedBit << 16)), hn::Zero(d));
            if (k > 0) {
                const Mask32 passed =
                    hn::AndNot(hn::Or(window.moved, hn::Eq(surface, window.far.surface)),
                               hn::And(place.farther, moved));
                weight[t] = hn::IfThenZeroElse(passed, weight[t]);
            }
            const Mask32 plain = hn::AndNot(hn::And(window.moved, moved), easy);
            hard[t] = hn::AndNot(plain, maskOf(hn::Gt(asSigned(weight[t]), hn::Zero(di))));
            any_hard = hn::Or(any_hard, hard[t]);
            behind[t] = kBehind ? leftBehind(k, own, place, depth) : hn::Zero(d);
        }
        if (k == 0) {
            return;
        }
        if (!hn::AllFalse(d, any_hard)) {
            const Four motion = fetchFour(slot.motion, address);
            for (int t = 0; t < 4; ++t) {
                const VI32 slid = hn::Mul(slideOf(motion.of[t], way), hn::Set(di, k));
                const Mask32 none =
                    maskOf(hn::Eq(lowSigned(motion.of[t]), hn::Set(di, kNoHistory)));
                Mask32 far_off = hn::Or(none, maskOf(hn::Gt(slid, hn::Set(di, kMaxSlide))));
                if (job.start_age != nullptr) {
                    const V32 surface = surfaceOf(samples.blue_id.of[t]);
                    far_off = hn::Or(far_off, olderThan(job.start_age, k, surface));
                }
                weight[t] = hn::IfThenZeroElse(hn::And(hard[t], far_off), weight[t]);
            }
        }
        if (any_moved) {
            const Four owner = fetchFour(slot.owner, address);
            for (int t = 0; t < 4; ++t) {
                const Mask32 unlike = hn::Not(litAlike(decodeNormals(high(owner.of[t])), normal));
                const Mask32 tested =
                    hn::And(hn::And(same[t], window.moved), hn::Ne(window.normal, hn::Zero(d)));
                weight[t] = hn::IfThenZeroElse(hn::And(tested, unlike), weight[t]);
            }
        }
    }
};

/// Samples of the farther layer: collectFar().
struct FarRule {
    const Job& job;
    const WindowLanes& window;

    HWY_INLINE void operator()(int k, const SlotIn&, const Address&, V32, const Samples& samples,
                               V32 weight[4], V32 behind[4]) const {
        const Expected own = expectedAt(window.owner, k);
        const Expected far = expectedAt(window.far, k);
        for (int t = 0; t < 4; ++t) {
            const V32 surface = surfaceOf(samples.blue_id.of[t]);
            const V32 depth = low(samples.depths.of[t]);
            const PlaceLanes place = placeOf(window.owner, own, surface, depth);
            const VI32 over_far = hn::Sub(asSigned(depth), far.depth);
            const Mask32 there = maskOf(atMost(over_far, far.tolerance));
            weight[t] = hn::IfThenElseZero(hn::And(place.farther, there), weight[t]);
            behind[t] = hn::Zero(D32());
        }
    }
};

/// Keeps a frame's samples and adds the moments of their places.
HWY_INLINE void keep(const Site& site, const Samples& samples, const V32 weight[4],
                     const V32 behind[4], bool old, Kept& kept) {
    const DI32 di;
    Kept::Frame& frame = kept.frame[kept.frames++];
    VI32 w[4];
    for (int t = 0; t < 4; ++t) {
        w[t] = asSigned(weight[t]);
        frame.weight[t] = weight[t];
        frame.red_green[t] = samples.red_green.of[t];
        frame.blue[t] = hn::Or(low(samples.blue_id.of[t]), behind[t]);
    }
    frame.ex = site.ex;
    frame.ey = site.ey;
    const VI32 step = hn::Set(di, 64);
    const VI32 x0 = site.ex, x1 = hn::Add(x0, step), y0 = site.ey, y1 = hn::Add(y0, step);
    const VI32 left = hn::Add(w[0], w[2]), right = hn::Add(w[1], w[3]);
    const VI32 upper = hn::Add(w[0], w[1]), lower = hn::Add(w[2], w[3]);
    const VI32 all = hn::Add(left, right);
    const VI32 lx = hn::Mul(left, x0), rx = hn::Mul(right, x1);
    const VI32 uy = hn::Mul(upper, y0), by = hn::Mul(lower, y1);
    kept.w = hn::Add(kept.w, all);
    kept.old_weight = old ? hn::Add(kept.old_weight, all) : kept.old_weight;
    kept.x = hn::Add(kept.x, hn::Add(lx, rx));
    kept.y = hn::Add(kept.y, hn::Add(uy, by));
    kept.xx = hn::Add(kept.xx, hn::Add(hn::Mul(lx, x0), hn::Mul(rx, x1)));
    kept.yy = hn::Add(kept.yy, hn::Add(hn::Mul(uy, y0), hn::Mul(by, y1)));
    const VI32 ly = hn::Add(hn::Mul(w[0], y0), hn::Mul(w[2], y1));
    const VI32 ry = hn::Add(hn::Mul(w[1], y0), hn::Mul(w[3], y1));
    kept.xy = hn::Add(kept.xy, hn::Add(hn::Mul(ly, x0), hn::Mul(ry, x1)));
}

/// A tile's row is only one or two cache lines of each of many planes, too short for the hardware
/// to see a pattern: the same place a few rows on is asked for in time.
constexpr int kRowsAhead = 2;
HWY_INLINE void prefetchAhead(const SlotIn& slot, ptrdiff_t at) {
    for (const uint32_t* plane :
         {slot.red_green, slot.blue_id, slot.depths, slot.owner, slot.motion}) {
        hwy::Prefetch(plane + at);
    }
}

/// Where a layer was in each frame: places of the pixels' centres, 1/256 pixel.
struct Way {
    struct Place {
        VI32 px, py;
        V32 motion;  ///< from the frame after to this one
        V32 alive;   ///< all ones in lanes that are followed so far
    };
    Place place[kMaxRing];
    int frames = 0;
};

/// The end of a way while it is being found.
struct Walker {
    V32 motion, alive;
    VI32 px, py;
};

HWY_INLINE Walker startWay(int x, int y, const LayerLanes& layer, Mask32 active) {
    return {layer.motion, hn::VecFromMask(D32(), active), hn::ShiftLeft<8>(hn::Iota(DI32(), x)),
            hn::Set(DI32(), y * 256)};
}

/// follow(), the way alone, one frame on; nothing when no lane is alive.
HWY_INLINE void stepWay(const Job& job, int k, bool last, const LayerLanes& layer, VI32 limit,
                        Walker& walker, Way& way) {
    const D32 d;
    const DI32 di;
    const SlotIn& slot = job.slot[k];
    Mask32 alive = hn::MaskFromVec(walker.alive);
    if (k == kFlatFrames || k == kTurningFrames || k == kCalmFrames) {
        alive = hn::And(alive, maskOf(hn::Gt(limit, hn::Set(di, k))));
    }
    if (k > 0) {
        const Mask32 ends = maskOf(hn::Eq(lowSigned(walker.motion), hn::Set(di, kNoHistory)));
        alive = hn::AndNot(ends, alive);
        walker.px = hn::Add(walker.px, lowSigned(walker.motion));
        walker.py = hn::Add(walker.py, highSigned(walker.motion));
    }
    walker.alive = hn::VecFromMask(d, alive);
    if (hn::AllFalse(d, alive)) {
        return;
    }
    way.place[way.frames++] = {walker.px, walker.py, walker.motion, walker.alive};
    if (last) {
        return;
    }
    const VI32 nx = hn::ShiftRight<8>(hn::Add(walker.px, hn::Set(di, 128 - slot.jitter_x_fx8)));
    const VI32 ny = hn::ShiftRight<8>(hn::Add(walker.py, hn::Set(di, 128 - slot.jitter_y_fx8)));
    alive = hn::And(alive, hn::And(within(nx, job.width), within(ny, job.height)));
    walker.alive = hn::VecFromMask(d, alive);
    if (k == 0) {
        return;
    }
    const VI32 row = hn::Mul(ny, hn::Set(di, int32_t(job.stride)));
    const VI32 nearest = choose(alive, hn::Add(row, nx), hn::Zero(di));
    V32 motion = walker.motion, owner = hn::Zero(d), depths = owner;
    forClusters(
        nearest, alive,
        [&](int32_t offset, Mask32 same) {
            owner = choose(same, hn::LoadU(d, slot.owner + offset), owner);
            motion = choose(same, hn::LoadU(d, slot.motion + offset), motion);
            depths = choose(same, hn::LoadU(d, slot.depths + offset), depths);
        },
        [&](Mask32 rest) {
            owner = choose(rest, hn::GatherIndex(d, slot.owner, nearest), owner);
            motion = choose(rest, hn::GatherIndex(d, slot.motion, nearest), motion);
            depths = choose(rest, hn::GatherIndex(d, slot.depths, nearest), depths);
        });
    const Expected expected = expectedAt(layer, k);
    const VI32 difference = hn::Abs(hn::Sub(asSigned(high(depths)), expected.depth));
    const Mask32 follows =
        hn::And(hn::Eq(hn::And(owner, hn::Set(d, kSurfaceMask)), layer.surface),
                maskOf(atMost(difference, hn::Add(expected.tolerance, expected.tolerance))));
    walker.motion = choose(follows, motion, walker.motion);
}

/// follow(): the samples along a way.
template <class Rule>
HWY_INLINE void collect(const Job& job, int x, const Way& way, const Rule& rule, Kept& kept) {
    kept.clear();
    for (int k = 0; k < way.frames; ++k) {
        const SlotIn& slot = job.slot[k];
        const Way::Place& place = way.place[k];
        const Site site = siteOf(job, place.px, place.py, slot, hn::MaskFromVec(place.alive));
        const Address address = addressOf(job, site);
        if ((x & 15) == 0) {
            prefetchAhead(slot, hn::GetLane(address.lower) + kRowsAhead * job.stride);
        }
        const Samples samples = fetchSamples(slot, address);
        V32 weight[4] = {site.weight[0], site.weight[1], site.weight[2], site.weight[3]};
        V32 behind[4];
        rule(k, slot, address, place.motion, samples, weight, behind);
        if (k > 0 && job.change_age != nullptr) {
            for (int t = 0; t < 4; ++t) {
                weight[t] = hn::IfThenZeroElse(
                    olderThan(job.change_age, k, surfaceOf(samples.blue_id.of[t])), weight[t]);
            }
        }
        keep(site, samples, weight, behind, k > 0, kept);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace still::taa
HWY_AFTER_NAMESPACE();
