// The gather in lanes, one pixel each; gather_reference.cpp is the truth and names the steps. Two
// passes: the first follows the surfaces back, decides which samples count, and keeps them with
// their weights; the second weighs their colours, once the moments of their places are known.
// Included once per target by taa_simd.cpp.

HWY_BEFORE_NAMESPACE();
namespace still::taa {
namespace HWY_NAMESPACE {

/// Words of the four samples around the pixels' places: left and right of the upper row, then of
/// the lower one.
struct Four {
    V32 of[4];
};

/// Where the four samples are. Lanes whose samples lie next to each other as the pixels do form a
/// cluster, which is loaded at once.
struct Site {
    VI32 ix, iy;    ///< of the upper left sample
    V32 fx, fy;     ///< 0 … 255
    V32 weight[4];  ///< 0 outside the picture
    V32 wanted;     ///< sum of the weights
    VI32 ex, ey;    ///< place of the upper left sample, 1/64 pixel
};

/// More clusters than this are gathered.
constexpr int kMaxClusters = 5;

/// Calls load(offset, lanes) for clusters of lanes: sample `index` of lane i is at offset + i. What
/// is left goes to gather(lanes).
template <class Load, class Gather>
HWY_INLINE void forClusters(VI32 index, Mask32 lanes, Load&& load, Gather&& gather) {
    const D32 d;
    const DI32 di;
    const VI32 offset = hn::Sub(index, hn::Iota(di, 0));
    const int32_t first = hn::GetLane(offset);
    if (hn::AllTrue(di, hn::Eq(offset, hn::Set(di, first)))) {
        load(first, lanes);
        return;
    }
    alignas(64) int32_t offsets[kMaxLanes];
    hn::StoreU(offset, di, offsets);
    Mask32 left = lanes;
    for (int cluster = 0; cluster < kMaxClusters; ++cluster) {
        const intptr_t lane = hn::FindFirstTrue(d, left);
        if (lane < 0) {
            return;
        }
        const Mask32 same = hn::And(left, maskOf(hn::Eq(offset, hn::Set(di, offsets[lane]))));
        load(offsets[lane], same);
        left = hn::AndNot(same, left);
    }
    if (!hn::AllFalse(d, left)) {
        gather(left);
    }
}

/// Rows above and below the picture are not memory, so the samples of a site are addressed by rows
/// inside; those outside weigh nothing.
struct Address {
    VI32 upper, lower;  ///< index of the left sample
    Mask32 lanes;       ///< lanes with any weight
};

HWY_INLINE Address addressOf(const Job& job, const Site& site) {
    const DI32 di;
    const VI32 zero = hn::Zero(di);
    const VI32 last = hn::Set(di, job.height - 1);
    const VI32 stride = hn::Set(di, int32_t(job.stride));
    const VI32 y0 = hn::Min(hn::Max(site.iy, zero), last);
    const VI32 y1 = hn::Min(hn::Max(hn::Add(site.iy, hn::Set(di, 1)), zero), last);
    const Mask32 lanes = hn::Ne(site.wanted, hn::Zero(D32()));
    // Lanes without weight follow the first one of the row, whatever they would have read.
    const VI32 x = hn::Min(hn::Max(site.ix, hn::Set(di, -1)), hn::Set(di, job.width - 1));
    return {hn::Add(hn::Mul(y0, stride), x), hn::Add(hn::Mul(y1, stride), x), lanes};
}

HWY_INLINE void fetchRow(const uint32_t* plane, VI32 index, Mask32 lanes, V32& left, V32& right) {
    const D32 d;
    forClusters(
        index, lanes,
        [&](int32_t offset, Mask32 same) {
            left = hn::IfThenElse(same, hn::LoadU(d, plane + offset), left);
            right = hn::IfThenElse(same, hn::LoadU(d, plane + offset + 1), right);
        },
        [&](Mask32 rest) {
            left = hn::IfThenElse(rest, hn::GatherIndex(d, plane, index), left);
            right = hn::IfThenElse(rest, hn::GatherIndex(d, plane + 1, index), right);
        });
}

/// Three planes at once: the clusters are the same.
struct Samples {
    Four red_green, blue_id, depths;
};

HWY_INLINE Four loadFour(const uint32_t* plane, ptrdiff_t upper, ptrdiff_t lower) {
    const D32 d;
    return {{hn::LoadU(d, plane + upper), hn::LoadU(d, plane + upper + 1),
             hn::LoadU(d, plane + lower), hn::LoadU(d, plane + lower + 1)}};
}

HWY_INLINE void takeFour(Mask32 lanes, const uint32_t* plane, ptrdiff_t upper, ptrdiff_t lower,
                         Four& four) {
    const D32 d;
    four.of[0] = choose(lanes, hn::LoadU(d, plane + upper), four.of[0]);
    four.of[1] = choose(lanes, hn::LoadU(d, plane + upper + 1), four.of[1]);
    four.of[2] = choose(lanes, hn::LoadU(d, plane + lower), four.of[2]);
    four.of[3] = choose(lanes, hn::LoadU(d, plane + lower + 1), four.of[3]);
}

HWY_INLINE Samples fetchSamples(const SlotIn& slot, const Address& address) {
    const D32 d;
    const DI32 di;
    const VI32 lane = hn::Iota(di, 0);
    const VI32 upper = hn::Sub(address.upper, lane), lower = hn::Sub(address.lower, lane);
    const ptrdiff_t upper0 = hn::GetLane(upper), lower0 = hn::GetLane(lower);
    Samples s{loadFour(slot.red_green, upper0, lower0), loadFour(slot.blue_id, upper0, lower0),
              loadFour(slot.depths, upper0, lower0)};
    const auto differ = [&](ptrdiff_t u, ptrdiff_t l) {
        const VI32 other = hn::Or(hn::Xor(upper, hn::Set(di, int32_t(u))),
                                  hn::Xor(lower, hn::Set(di, int32_t(l))));
        return hn::Not(maskOf(hn::Eq(other, hn::Zero(di))));
    };
    Mask32 left = hn::And(address.lanes, differ(upper0, lower0));
    if (hn::AllFalse(d, left)) {
        return s;
    }
    alignas(64) int32_t uppers[kMaxLanes], lowers[kMaxLanes];
    hn::Store(upper, di, uppers);
    hn::Store(lower, di, lowers);
    while (!hn::AllFalse(d, left)) {
        const intptr_t first = hn::FindFirstTrue(d, left);
        const ptrdiff_t u = uppers[first], l = lowers[first];
        const Mask32 others = hn::And(left, differ(u, l));
        const Mask32 same = hn::AndNot(others, left);
        takeFour(same, slot.red_green, u, l, s.red_green);
        takeFour(same, slot.blue_id, u, l, s.blue_id);
        takeFour(same, slot.depths, u, l, s.depths);
        left = others;
    }
    return s;
}

HWY_INLINE Four fetchFour(const uint32_t* plane, const Address& address) {
    const V32 zero = hn::Zero(D32());
    Four four{{zero, zero, zero, zero}};
    fetchRow(plane, address.upper, address.lanes, four.of[0], four.of[1]);
    fetchRow(plane, address.lower, address.lanes, four.of[2], four.of[3]);
    return four;
}

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

/// tiltOf()
HWY_INLINE void tiltLanes(const Kept& m, VI32& tilt_x, VI32& tilt_y) {
    const DI32 di;
    const VI32 ridge =
        hn::Add(hn::ShiftRight<8>(hn::Mul(m.w, hn::Set(di, kRidge))), hn::Set(di, 16));
    const VI32 a = hn::Add(hn::ShiftRight<8>(m.xx), ridge);
    const VI32 b = hn::ShiftRight<8>(m.xy);
    const VI32 c = hn::Add(hn::ShiftRight<8>(m.yy), ridge);
    const VI32 x = hn::ShiftRight<4>(m.x), y = hn::ShiftRight<4>(m.y);
    VI32 det = hn::Sub(hn::Mul(a, c), hn::Mul(b, b));
    VI32 nx = hn::Sub(hn::Mul(c, x), hn::Mul(b, y));
    VI32 ny = hn::Sub(hn::Mul(a, y), hn::Mul(b, x));
    const auto normalise = [&](auto shift_tag) {
        constexpr int kShift = decltype(shift_tag)::value;
        const auto large = atLeast(det, hn::Set(di, 256 << kShift));
        det = hn::IfThenElse(large, hn::ShiftRight<kShift>(det), det);
        nx = hn::IfThenElse(large, hn::ShiftRight<kShift>(nx), nx);
        ny = hn::IfThenElse(large, hn::ShiftRight<kShift>(ny), ny);
    };
    normalise(std::integral_constant<int, 16>());
    normalise(std::integral_constant<int, 8>());
    normalise(std::integral_constant<int, 4>());
    normalise(std::integral_constant<int, 2>());
    normalise(std::integral_constant<int, 1>());
    const VI32 reciprocal =
        hn::GatherIndex(di, kSmallReciprocals.data(), hn::Sub(det, hn::Set(di, 256)));
    const auto quotient = [&](VI32 n) {
        const VI32 small = hn::Min(hn::Max(n, hn::Set(di, -16384)), hn::Set(di, 16383));
        return hn::ShiftRight<6>(hn::Mul(small, reciprocal));
    };
    tilt_x = quotient(nx);
    tilt_y = quotient(ny);
    for (int i = 0; i < 6; ++i) {
        const auto steep = hn::Gt(hn::Add(hn::Abs(tilt_x), hn::Abs(tilt_y)), hn::Set(di, kMaxTilt));
        if (hn::AllFalse(di, steep)) {
            return;
        }
        tilt_x = hn::IfThenElse(steep, hn::ShiftRight<1>(tilt_x), tilt_x);
        tilt_y = hn::IfThenElse(steep, hn::ShiftRight<1>(tilt_y), tilt_y);
    }
}

struct Colour {
    V32 of[3];
};

/// fit(): where it returns false, `colour` stays. `behind` replaces what shows the layer behind.
HWY_INLINE Mask32 fitLanes(const Kept& kept, const Colour* behind, Mask32 separate,
                           Colour& colour) {
    const D32 d;
    const DI32 di;
    VI32 tilt_x, tilt_y;
    tiltLanes(kept, tilt_x, tilt_y);
    V32 total = hn::Zero(d), sum[3] = {total, total, total};
    const VI32 x_step = hn::ShiftLeft<6>(tilt_x), y_step = hn::ShiftLeft<6>(tilt_y);
    const VI32 one = hn::Set(di, 1 << kTiltBits);
    for (int f = 0; f < kept.frames; ++f) {
        const Kept::Frame& frame = kept.frame[f];
        const VI32 corner =
            hn::Sub(one, hn::Add(hn::Mul(tilt_x, frame.ex), hn::Mul(tilt_y, frame.ey)));
        for (int t = 0; t < 4; ++t) {
            VI32 factor = (t & 1) != 0 ? hn::Sub(corner, x_step) : corner;
            factor = (t & 2) != 0 ? hn::Sub(factor, y_step) : factor;
            const V32 weight =
                asUnsigned(roundedShift<kTiltBits>(hn::Mul(asSigned(frame.weight[t]), factor)));
            V32 rgb[3] = {low(frame.red_green[t]), high(frame.red_green[t]), low(frame.blue[t])};
            if (behind != nullptr) {
                const Mask32 back = hn::And(separate, hn::Ne(high(frame.blue[t]), hn::Zero(d)));
                for (int c = 0; c < 3; ++c) {
                    rgb[c] = choose(back, behind->of[c], rgb[c]);
                }
            }
            total = hn::Add(total, weight);
            for (int c = 0; c < 3; ++c) {
                sum[c] = hn::Add(sum[c], hn::Mul(weight, rgb[c]));
            }
        }
    }
    const Mask32 fits = hn::And(maskOf(hn::Gt(kept.w, hn::Set(di, 1))),
                                maskOf(hn::Gt(asSigned(total), hn::Set(di, 1))));
    const V32 reciprocal = hn::GatherIndex(d, kReciprocals.data(), asSigned(total));
    const V32 half = hn::ShiftRight<1>(total);
    for (int c = 0; c < 3; ++c) {
        colour.of[c] = choose(fits, highProduct(hn::Add(sum[c], half), reciprocal), colour.of[c]);
    }
    return fits;
}

/// lookAround() for the pixels at `at`, whose owners stand in this frame's record.
HWY_INLINE WindowLanes windowOf(const Job& job, ptrdiff_t at, const Owners& seen, const Owners& far,
                                VI32 calm_frames, Mask32 pixels) {
    const D32 d;
    const DI32 di;
    const V32 surface_mask = hn::Set(d, kSurfaceMask);
    const SlotIn& now = job.slot[0];
    const V32 owner = hn::LoadU(d, now.owner + at);
    const Mask32 inferred = hn::Ne(hn::And(owner, hn::Set(d, kInferredBit)), hn::Zero(d));
    WindowLanes w;
    w.owner.surface = hn::And(owner, surface_mask);
    w.owner.depth = asSigned(high(hn::LoadU(d, now.depths + at)));
    w.owner.motion = hn::LoadU(d, now.motion + at);
    w.normal = high(owner);
    const VI32 slope = hn::IfThenZeroElse(
        signedMask(inferred), slopesOf(job, at, w.owner.surface, asUnsigned(w.owner.depth)));
    const VI32 step = hn::Sub(asSigned(seen.expected), w.owner.depth);
    w.owner.step = hn::IfThenZeroElse(signedMask(inferred), step);
    const VI32 tolerance = hn::Set(di, kDepthTolerance);
    const VI32 sloped = hn::Mul(slope, hn::Set(di, kSlopeFactor));
    w.owner.tolerance = hn::Add(tolerance, sloped);
    const Mask32 moved = hn::Ne(hn::And(seen.id, hn::Set(d, kMovedBit)), hn::Zero(d));
    w.moved = hn::And(hn::AndNot(inferred, moved), pixels);
    w.far.surface = hn::And(far.id, surface_mask);
    w.far.depth = asSigned(clampedLogDepth(far.depth));
    w.far.step = hn::Sub(asSigned(far.expected), w.far.depth);
    w.far.tolerance = tolerance;
    w.far.motion = far.motion;
    const VI32 height = hn::Sub(w.owner.depth, w.far.depth);
    w.layered = maskOf(hn::Gt(height, hn::Add(tolerance, hn::Add(sloped, sloped))));
    w.frames = choose(hn::Or(w.layered, inferred), hn::Set(di, kMaxRing), calm_frames);
    w.flat = maskOf(hn::Eq(w.frames, hn::Set(di, kFlatFrames)));
    const VI32 speed =
        hn::Max(hn::Abs(lowSigned(w.owner.motion)), hn::Abs(highSigned(w.owner.motion)));
    w.frames = choose(maskOf(hn::Gt(speed, hn::Set(di, kFast))),
                      hn::Min(w.frames, hn::Set(di, kFastFrames)), w.frames);
    if (job.turning != nullptr) {
        const V32 turning = hn::GatherIndex(d, job.turning, asSigned(w.owner.surface));
        const VI32 fewer = hn::Min(w.frames, hn::Set(di, kTurningFrames));
        w.frames = choose(hn::Ne(turning, hn::Zero(d)), fewer, w.frames);
    }
    w.slide = slideOf(w.owner.motion, w.far.motion);
    const VI32 none = hn::Set(di, kNoHistory);
    const Mask32 known = hn::Not(maskOf(
        hn::Or(hn::Eq(lowSigned(w.owner.motion), none), hn::Eq(lowSigned(w.far.motion), none))));
    w.apart = hn::And(hn::And(hn::And(w.layered, known), pixels),
                      maskOf(hn::Gt(w.slide, hn::Set(di, kApart))));
    return w;
}

/// mixSpatial() for the few lanes that need it.
HWY_INLINE void mixSpatialLanes(const Job& job, int x, int y, VI32 old_weight, Mask32 lanes,
                                Colour& colour) {
    const D32 d;
    const DI32 di;
    alignas(64) uint32_t rgb[3][kMaxLanes], wanted[kMaxLanes];
    alignas(64) int32_t weight[kMaxLanes];
    for (int c = 0; c < 3; ++c) {
        hn::StoreU(colour.of[c], d, rgb[c]);
    }
    hn::StoreU(old_weight, di, weight);
    hn::StoreU(hn::IfThenElseZero(lanes, hn::Set(d, 1)), d, wanted);
    for (int i = 0; i < int(hn::Lanes(d)); ++i) {
        if (wanted[i] != 0) {
            int pixel[3] = {int(rgb[0][i]), int(rgb[1][i]), int(rgb[2][i])};
            mixSpatial(job, x + i, y, weight[i], pixel);
            for (int c = 0; c < 3; ++c) {
                rgb[c][i] = uint32_t(pixel[c]);
            }
        }
    }
    for (int c = 0; c < 3; ++c) {
        colour.of[c] = hn::LoadU(d, rgb[c]);
    }
}

/// A group of pixels of a row.
struct Group {
    WindowLanes window;
    Walker walker;
    Way way;     ///< of the window's owner
    V32 pixels;  ///< all ones in the lanes that are asked for
    bool wanted;
};

HWY_INLINE void gatherGroup(const Job& job, int x, int y, const Group& group) {
    const D32 d;
    const DI32 di;
    const ptrdiff_t at = y * job.stride + x;
    const WindowLanes& window = group.window;
    const Mask32 pixels = hn::MaskFromVec(group.pixels);
    Colour colour;
    for (int c = 0; c < 3; ++c) {
        colour.of[c] = load16(job.now.colour[c] + at);
    }
    Kept kept;
    Colour behind = colour;
    Mask32 separate = hn::MaskFromVec(hn::Zero(d));
    const bool any_apart = !hn::AllFalse(d, window.apart);
    if (any_apart) {
        Walker walker = startWay(x, y, window.far, window.apart);
        const int frames = std::min(kFarFrames, job.frames);
        Way way;
        for (int k = 0; k < frames; ++k) {
            stepWay(job, k, k + 1 == frames, window.far, hn::Set(di, kMaxRing), walker, way);
        }
        collect(job, x, way, FarRule{job, window}, kept);
        separate = hn::And(fitLanes(kept, nullptr, separate, behind), window.apart);
    }
    const bool any_moved = !hn::AllFalse(d, window.moved);
    const auto collectOwn = [&](auto behind_tag) {
        const OwnRule<decltype(behind_tag)::value> rule{job, window, decodeNormals(window.normal),
                                                        any_moved};
        collect(job, x, group.way, rule, kept);
    };
    if (any_apart) {
        collectOwn(std::true_type());
    } else {
        collectOwn(std::false_type());
    }
    fitLanes(kept, any_apart ? &behind : nullptr, separate, colour);
    const Mask32 lone = hn::And(hn::AndNot(window.flat, pixels),
                                maskOf(hn::Lt(kept.old_weight, hn::Set(di, kFrameWeight))));
    if (!hn::AllFalse(d, lone)) {
        mixSpatialLanes(job, x, y, kept.old_weight, lone, colour);
    }
    for (int c = 0; c < 3; ++c) {
        const V32 shown = load16(job.shown[c] + at);
        store16(choose(pixels, colour.of[c], shown), job.shown[c] + at);
    }
    const V32 count = asUnsigned(roundedShift<8>(kept.w));
    store8(choose(pixels, count, load8(job.shown_count + at)), job.shown_count + at);
}

/// Smallest and largest of each column of three, by channel; columns as in OwnerStrip.
struct ContrastStrip {
    alignas(64) uint16_t low[3][OwnerStrip::kWidth], high[3][OwnerStrip::kWidth];
};

HWY_INLINE void fillContrast(const Job& job, const TileRect& tile, int y, ContrastStrip& strip) {
    const hn::ScalableTag<uint16_t> d;
    const int lanes = int(hn::Lanes(d));
    const ptrdiff_t up = y > 0 ? -job.stride : 0;
    const ptrdiff_t down = y + 1 < job.height ? job.stride : 0;
    for (int c = 0; c < 3; ++c) {
        for (int i = 0; i < OwnerStrip::kWidth; i += lanes) {
            const uint16_t* at = job.now.colour[c] + y * job.stride + tile.x0 - kMaxLanes + i;
            const auto a = hn::LoadU(d, at + up), b = hn::LoadU(d, at), e = hn::LoadU(d, at + down);
            hn::StoreU(hn::Min(hn::Min(a, b), e), d, strip.low[c] + i);
            hn::StoreU(hn::Max(hn::Max(a, b), e), d, strip.high[c] + i);
        }
        if (tile.x0 == 0) {
            strip.low[c][kMaxLanes - 1] = strip.low[c][kMaxLanes];
            strip.high[c][kMaxLanes - 1] = strip.high[c][kMaxLanes];
        }
        if (tile.x1 == job.width) {
            const int last = kMaxLanes + tile.x1 - tile.x0 - 1;
            strip.low[c][last + 1] = strip.low[c][last];
            strip.high[c][last + 1] = strip.high[c][last];
        }
    }
}

/// Frames to follow by the window's contrast alone: see lookAround().
HWY_INLINE VI32 calmFrames(const ContrastStrip& strip, int x_in_tile) {
    const DI32 di;
    const int i = kMaxLanes + x_in_tile;
    Mask32 flat = hn::Not(hn::MaskFromVec(hn::Zero(D32())));
    Mask32 calm = flat;
    for (int c = 0; c < 3; ++c) {
        const uint16_t* l = strip.low[c] + i;
        const uint16_t* h = strip.high[c] + i;
        const V32 low = hn::Min(hn::Min(load16(l - 1), load16(l)), load16(l + 1));
        const VI32 high = asSigned(hn::Max(hn::Max(load16(h - 1), load16(h)), load16(h + 1)));
        const VI32 span = hn::Sub(hn::Sub(high, asSigned(low)), hn::Set(di, 4));
        flat = hn::And(flat, maskOf(atMost(span, hn::ShiftRight<kFlatShift>(high))));
        calm = hn::And(calm, maskOf(atMost(span, hn::ShiftRight<kCalmShift>(high))));
    }
    return choose(flat, hn::Set(di, kFlatFrames),
                  choose(calm, hn::Set(di, kCalmFrames), hn::Set(di, kMaxRing)));
}

HWY_ATTR void gatherTile(const Job& job, const TileRect& tile, bool sums_valid) noexcept {
    const D32 d;
    const DI32 di;
    constexpr int kLanes = int(hn::MaxLanes(d));
    OwnerStrip near_strip, far_strip;
    ContrastStrip contrast;
    Group groups[kTileSize / kLanes];
    const int count = (tile.x1 - tile.x0 + kLanes - 1) / kLanes;
    for (int y = tile.y0; y < tile.y1; ++y) {
        fillStrip<Nearest, kIdDepth>(job, tile, y, near_strip);
        fillStrip<Farthest, kWithMotion>(job, tile, y, far_strip);
        fillContrast(job, tile, y, contrast);
        for (int i = 0; i < count; ++i) {
            const int x = tile.x0 + i * kLanes;
            const ptrdiff_t at = y * job.stride + x;
            Group& group = groups[i];
            Mask32 pixels = lanesBefore(tile.x1 - x);
            if (sums_valid) {
                const VI32 samples = asSigned(load8(job.sums.count + at));
                pixels = hn::And(pixels, maskOf(hn::Lt(samples, hn::Set(di, job.settled))));
            }
            group.wanted = !hn::AllFalse(d, pixels);
            group.pixels = hn::VecFromMask(d, pixels);
            Owners seen = ownersOf<Nearest, kIdDepth>(near_strip, i * kLanes);
            preferCentre<kIdDepth>(job, at, seen);
            group.window =
                windowOf(job, at, seen, ownersOf<Farthest, kWithMotion>(far_strip, i * kLanes),
                         calmFrames(contrast, i * kLanes), pixels);
            group.walker = startWay(x, y, group.window.owner, pixels);
            group.way.frames = 0;
        }
        // Each step of a way waits for the one before: all groups of the row wait at once.
        for (int k = 0; k < job.frames; ++k) {
            for (int i = 0; i < count; ++i) {
                Group& group = groups[i];
                stepWay(job, k, k + 1 == job.frames, group.window.owner, group.window.frames,
                        group.walker, group.way);
            }
        }
        for (int i = 0; i < count; ++i) {
            if (groups[i].wanted) {
                gatherGroup(job, tile.x0 + i * kLanes, y, groups[i]);
            }
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace still::taa
HWY_AFTER_NAMESPACE();
