// Layers in lanes: what a window shows, where its layers were in each frame, and which samples
// count for a pixel. gather_reference.cpp is the truth. Included once per target by taa_simd.cpp.

HWY_BEFORE_NAMESPACE();
namespace still::taa {
namespace HWY_NAMESPACE {

HWY_INLINE VS surfaces(VS ids) {
    return hn::And(ids, set(kSurfaceMask));
}

/// heldStep() of what is within ±kMaxStep already.
HWY_INLINE VS heldSteps(VS step) {
    const MS large = hn::Eq(hn::Abs(step), set(kMaxStep));
    return hn::Add(step, hn::IfThenElseZero(large, step));
}

/// A surface on its way back through the frames.
struct LayerLanes {
    VS surface, depth, step, tolerance;
    VS motion[2];
};

/// Where a layer is expected, one frame after the other.
struct Outlook {
    VS depth, drift;

    HWY_INLINE void start(const LayerLanes& layer) {
        depth = layer.depth;
        drift = zero();
    }
    HWY_INLINE void next(const LayerLanes& layer) {
        depth = hn::SaturatedAdd(depth, layer.step);
        drift = hn::SaturatedAdd(drift, hn::Abs(layer.step));
    }
    HWY_INLINE VS tolerance(const LayerLanes& layer) const {
        return hn::Add(layer.tolerance, hn::ShiftRight<kStepShift>(drift));
    }
};

struct WindowLanes {
    LayerLanes owner, far;  ///< far: only where layered
    VS normal, slide;
    VS frames;      ///< to follow
    VS lit_frames;  ///< in which the pixel was lit as it is now, this one included
    MS moved, layered, apart, flat;
    bool any_moved, any_layered, any_apart;
};

/// max(|a.x − b.x|, |a.y − b.y|)
HWY_INLINE VS slideOf(const VS a[2], const VS b[2]) {
    return hn::Max(distance(a[0], b[0]), distance(a[1], b[1]));
}

/// Where a sample lies in depth relative to a layer.
struct Depths {
    VS low, high;  ///< of the same layer

    HWY_INLINE Depths(const LayerLanes& layer, const Outlook& outlook) {
        const VS tolerance = outlook.tolerance(layer);
        low = hn::SaturatedSub(outlook.depth, tolerance);
        high = hn::SaturatedAdd(outlook.depth, tolerance);
    }
    HWY_INLINE MS within(VS depth) const {
        return hn::Not(hn::Or(hn::Gt(depth, high), hn::Gt(low, depth)));
    }
};

/// Where a layer was in a frame.
struct WayStop {
    PlaceLanes place;
    VS motion[2];  ///< from the frame after to this one
    MS alive;      ///< lanes that are followed so far
};
template <int kStops>
struct WayOf {
    WayStop stop[kStops];
    int frames = 0;
};
using Way = WayOf<kMaxRing>;

/// The end of a way while it is being found.
struct Walker {
    PlaceLanes place;
    VS motion[2];
    MS alive;
    Outlook outlook;

    HWY_INLINE void start(int x, int y, const LayerLanes& layer, MS pixels) {
        place = {hn::Iota(DS(), int16_t(x)), set(y), zero(), zero()};
        motion[0] = layer.motion[0];
        motion[1] = layer.motion[1];
        alive = pixels;
        outlook.start(layer);
    }
};

/// follow(), the way alone, one frame on; nothing when no lane is alive.
template <int kStops>
HWY_NOINLINE void stepWay(const Job& job, int k, bool last, const LayerLanes& layer, VS limit,
                          Walker& walker, WayOf<kStops>& way) {
    const DS d;
    const SlotIn& slot = job.slot[k];
    if ((job.light_age != nullptr && k > 0) || k == kFlatFrames || k == kTurningFrames ||
        k == kCalmFrames) {
        walker.alive = hn::And(walker.alive, hn::Gt(limit, set(k)));
    }
    if (k > 0) {
        walker.alive = hn::AndNot(hn::Eq(walker.motion[0], set(kNoHistory)), walker.alive);
    }
    if (!any(walker.alive)) {
        return;
    }
    if (k > 0) {
        moveAxis(walker.place.column, walker.place.x_fx8, walker.motion[0]);
        moveAxis(walker.place.row, walker.place.y_fx8, walker.motion[1]);
        walker.outlook.next(layer);
    }
    way.stop[way.frames++] = {walker.place, {walker.motion[0], walker.motion[1]}, walker.alive};
    if (last) {
        return;
    }
    const auto nearest = [](VS whole, VS part, VS jitter) {
        return hn::Add(whole, hn::ShiftRight<8>(hn::Add(part, hn::Sub(set(128), jitter))));
    };
    const PlaceLanes& place = walker.place;
    const JitterLanes jitter = jitterAt(job, slot, place.column, place.row, walker.alive);
    const VS column = nearest(place.column, place.x_fx8, jitter.x_fx8);
    const VS row = nearest(place.row, place.y_fx8, jitter.y_fx8);
    const VS out = hn::Or(beyond(column, job.width - 1), beyond(row, job.height - 1));
    walker.alive = hn::And(walker.alive, hn::Eq(out, zero()));
    if (k == 0 || !any(walker.alive)) {
        return;
    }
    VS owner = zero(), depth = zero(), motion[2] = {walker.motion[0], walker.motion[1]};
    forClusters(hn::Sub(column, hn::Iota(d, 0)), row, walker.alive, [&](int x, int y, MS lanes) {
        const ptrdiff_t at = y * job.stride + x;
        owner = hn::IfThenElse(lanes, load(slot.owner + at), owner);
        depth = hn::IfThenElse(lanes, load(slot.owner_depth + at), depth);
        motion[0] = hn::IfThenElse(lanes, load(slot.motion[0] + at), motion[0]);
        motion[1] = hn::IfThenElse(lanes, load(slot.motion[1] + at), motion[1]);
    });
    const VS tolerance = walker.outlook.tolerance(layer);
    const VS wide = hn::Add(tolerance, tolerance);
    const MS off = hn::Or(hn::Gt(depth, hn::SaturatedAdd(walker.outlook.depth, wide)),
                          hn::Gt(hn::SaturatedSub(walker.outlook.depth, wide), depth));
    const MS follows = hn::AndNot(off, hn::Eq(surfaces(owner), layer.surface));
    walker.motion[0] = hn::IfThenElse(follows, motion[0], walker.motion[0]);
    walker.motion[1] = hn::IfThenElse(follows, motion[1], walker.motion[1]);
}

/// Lanes whose surfaces have ages under k.
HWY_INLINE MS olderThan(const uint32_t* ages, int k, VS surface) {
    return hn::Lt(lookUp(ages, surface), set(k));
}

/// Compact normals as vectors: decodeNormal(). The squares' sum is at most 128².
struct Normals {
    VS x, y, z, square;

    explicit HWY_INLINE Normals(VS packed) {
        x = hn::ShiftRight<8>(hn::ShiftLeft<8>(packed));
        y = hn::ShiftRight<8>(packed);
        z = hn::Sub(hn::Sub(set(127), hn::Abs(x)), hn::Abs(y));
        const VS fold = hn::Max(hn::Neg(z), zero());
        x = hn::Add(x, hn::IfThenElse(hn::Lt(x, zero()), fold, hn::Neg(fold)));
        y = hn::Add(y, hn::IfThenElse(hn::Lt(y, zero()), fold, hn::Neg(fold)));
        square = dot(*this);
    }
    HWY_INLINE VS dot(const Normals& n) const {
        return hn::Add(hn::Add(hn::Mul(x, n.x), hn::Mul(y, n.y)), hn::Mul(z, n.z));
    }
};
/// similarlyLit()
HWY_INLINE MS litAlike(const Normals& then, const Normals& now) {
    const VS dot = then.dot(now);
    const VS eighth = hn::ShiftRight<3>(dot);
    const VS a = hn::MulHigh(then.square, set(31 << 8)), b = hn::ShiftRight<3>(now.square);
    Wide excess;
    excess.clear();
    excess.add(eighth, a, eighth, hn::Neg(b));
    const MS close = hn::Not(hn::Lt(narrow(excess.lower, excess.upper), zero()));
    return hn::And(close, hn::Gt(dot, zero()));
}

/// The windows' samples, by row and column; rows outside the picture repeat the middle one.
struct Windows {
    const Job& job;
    int x;
    ptrdiff_t at[3];

    HWY_INLINE Windows(const Job& j, int column, int row) : job(j), x(column) {
        at[1] = row * job.stride + column;
        at[0] = row > 0 ? at[1] - job.stride : at[1];
        at[2] = row + 1 < job.height ? at[1] + job.stride : at[1];
    }
    /// Depths in row j and column i around the pixels; outside the picture nothing is nearer.
    HWY_INLINE VS depth(int j, int i) const {
        const VS depth = load(job.slot[0].depth + at[j] + i);
        if ((i < 0 && x == 0) || (i > 0 && x + kHalves >= job.width)) {
            const VS column = hn::Iota(DS(), int16_t(x + i));
            return hn::IfThenElse(hn::Eq(beyond(column, job.width - 1), zero()), depth, set(32767));
        }
        return depth;
    }
};

HWY_INLINE VS farthestDepth(const Windows& windows) {
    VS least = windows.depth(1, 0);
    for (int j = 0; j < 3; ++j) {
        for (int i = -1; i <= 1; ++i) {
            least = hn::Min(least, windows.depth(j, i));
        }
    }
    return least;
}

/// farthestInWindow(): which is row · 3 + column.
struct Farthest {
    VS depth, id, which;
};
HWY_NOINLINE Farthest farthestOf(const Windows& windows) {
    const auto sample = [&](int j, int i) {
        return Farthest{windows.depth(j, i), load(windows.job.slot[0].id + windows.at[j] + i),
                        set(j * 3 + i + 1)};
    };
    const auto take = [](Farthest& best, const Farthest& other) {
        const MS farther = hn::Lt(other.depth, best.depth);
        best.depth = hn::Min(other.depth, best.depth);
        best.id = hn::IfThenElse(farther, other.id, best.id);
        best.which = hn::IfThenElse(farther, other.which, best.which);
    };
    return bestOfWindow(sample, take);
}

/// What a frame shows around a layer's places.
struct View {
    int k;
    const SlotIn& slot;
    const Site& site;
    const Clusters& clusters;
    const WayStop& stop;
    const Outlook& outlook;  ///< of the layer
};

/// Samples along the owner's way: collectOwn().
struct OwnRule {
    const Job& job;
    const WindowLanes& window;
    int x, y;
    Outlook far;
    VS farthest;  ///< surfaces of the windows' farthest samples, once they are asked for
    bool farthest_known = false;

    HWY_INLINE OwnRule(const Job& j, const WindowLanes& w, int column, int row)
        : job(j), window(w), x(column), y(row) {
        far.start(w.far);
    }
    HWY_INLINE void next() { far.next(window.far); }

    /// leftBehind(): depths under this, where it lags. Their quarter: the mean of far and the mean
    /// of both, rounded up, is far + ceil((own − far) / 4).
    HWY_INLINE VS lowerQuarter(const Outlook& own) const {
        const VU low = unsign(flipTop(far.depth)), high = unsign(flipTop(own.depth));
        return flipTop(sign(hn::AverageRound(low, hn::AverageRound(low, high))));
    }

    /// Weights of samples that do not count become 0. False when there are none of them.
    HWY_INLINE bool operator()(const View& view, VS weight[4], VS behind[4]) {
        for (int t = 0; window.any_apart && t < 4; ++t) {
            behind[t] = zero();
        }
        if (view.k == 0) {
            return false;
        }
        const Four id = fetchFour(view.slot.id, view.clusters);
        const Four depth = fetchFour(view.slot.depth, view.clusters);
        const Depths near(window.owner, view.outlook);
        MS same[4];
        for (int t = 0; t < 4; ++t) {
            same[t] =
                hn::And(hn::Eq(surfaces(id.of[t]), window.owner.surface), near.within(depth.of[t]));
        }
        const MS all = hn::And(hn::And(same[0], same[1]), hn::And(same[2], same[3]));
        if (!window.any_moved && !any(hn::AndNot(all, view.site.lanes))) {
            return false;
        }
        return sift(view, id, depth, near, same, weight, behind);
    }

  private:
    /// The same where not all samples are the owner's.
    HWY_NOINLINE bool sift(const View& view, const Four& id, const Four& depth, const Depths& near,
                           const MS same[4], VS weight[4], VS behind[4]) {
        const int k = view.k;
        MS hard[4], any_hard = never(), any_gone = never(), gone[4];
        for (int t = 0; t < 4; ++t) {
            const MS weighs = hn::Gt(weight[t], zero());
            const MS farther = hn::AndNot(hn::Or(same[t], hn::Gt(depth.of[t], near.high)), weighs);
            const MS moved = hn::Lt(id.of[t], zero());
            const MS easy = hn::Or(same[t], hn::And(farther, window.layered));
            gone[t] = hn::AndNot(window.moved, hn::And(farther, moved));
            any_gone = hn::Or(any_gone, gone[t]);
            hard[t] = hn::And(weighs, hn::Or(hn::Not(easy), hn::And(window.moved, moved)));
            any_hard = hn::Or(any_hard, hard[t]);
            if (window.any_apart) {
                const MS low = hn::Lt(depth.of[t], lowerQuarter(view.outlook));
                const MS lags = hn::Gt(window.slide, set(kMaxLag / k));
                behind[t] = hn::VecFromMask(DS(), hn::And(hn::And(farther, low), lags));
            }
        }
        MS dropped = never();
        const auto drop = [&](int t, MS lanes) {
            weight[t] = hn::IfThenZeroElse(lanes, weight[t]);
            dropped = hn::Or(dropped, lanes);
        };
        if (any(any_gone)) {
            if (!farthest_known) {
                farthest = surfaces(farthestOf(Windows(job, x, y)).id);
                farthest_known = true;
            }
            for (int t = 0; t < 4; ++t) {
                drop(t, hn::AndNot(hn::Eq(surfaces(id.of[t]), farthest), gone[t]));
            }
        }
        if (any(any_hard)) {
            const Four motion[2] = {fetchFour(view.slot.motion[0], view.clusters),
                                    fetchFour(view.slot.motion[1], view.clusters)};
            for (int t = 0; t < 4; ++t) {
                const VS other[2] = {motion[0].of[t], motion[1].of[t]};
                MS off = hn::Or(hn::Eq(other[0], set(kNoHistory)),
                                hn::Gt(slideOf(other, view.stop.motion), set(kMaxSlide / k)));
                if (job.start_age != nullptr) {
                    off = hn::Or(off, olderThan(job.start_age, k, surfaces(id.of[t])));
                }
                drop(t, hn::And(hard[t], off));
            }
        }
        if (window.any_moved) {
            const Four then = fetchFour(view.slot.normal, view.clusters);
            const Normals now(window.normal);
            const MS lit = hn::AndNot(hn::Eq(window.normal, zero()), window.moved);
            for (int t = 0; t < 4; ++t) {
                const MS tested = hn::And(hn::And(same[t], lit), hn::Gt(weight[t], zero()));
                drop(t, hn::AndNot(litAlike(Normals(then.of[t]), now), tested));
            }
        }
        return any(dropped);
    }
};

/// Samples of the farther layer: collectFar().
struct FarRule {
    const WindowLanes& window;
    Outlook own;

    explicit HWY_INLINE FarRule(const WindowLanes& w) : window(w) { own.start(w.owner); }
    HWY_INLINE void next() { own.next(window.owner); }

    HWY_INLINE bool operator()(const View& view, VS weight[4], VS /*behind*/[4]) {
        const Four id = fetchFour(view.slot.id, view.clusters);
        const Four depth = fetchFour(view.slot.depth, view.clusters);
        const Depths near(window.owner, own), far(window.far, view.outlook);
        for (int t = 0; t < 4; ++t) {
            const MS same =
                hn::And(hn::Eq(surfaces(id.of[t]), window.owner.surface), near.within(depth.of[t]));
            const MS nearer = hn::Or(hn::Gt(depth.of[t], near.high), hn::Gt(depth.of[t], far.high));
            weight[t] = hn::IfThenZeroElse(hn::Or(same, nearer), weight[t]);
        }
        return true;
    }
};

}  // namespace HWY_NAMESPACE
}  // namespace still::taa
HWY_AFTER_NAMESPACE();
