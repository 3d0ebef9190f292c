// Samples and owners of a frame into the ring, in lanes; record_reference.cpp is the truth. First
// the nearest sample of each column of three, kept in a strip with what belongs to it; then the
// nearest of three neighbouring columns. Included once per target by taa_simd.cpp.

HWY_BEFORE_NAMESPACE();
namespace still::taa {
namespace HWY_NAMESPACE {

/// The columns x0 − kMaxLanes … x0 + kTileSize + kMaxLanes − 1.
struct OwnerStrip {
    static constexpr int kWidth = kTileSize + 2 * kMaxLanes;
    alignas(64) uint32_t depth[kWidth];
    alignas(64) uint32_t id[kWidth];
    alignas(64) uint32_t motion[kWidth];
    alignas(64) uint32_t expected[kWidth];
    alignas(64) uint32_t normal[kWidth];
};

struct Owners {
    V32 depth, id, motion, expected, normal;
};

/// Which of the planes a strip is asked for; the others are zero.
enum Planes : int { kIdDepth = 0, kWithMotion = 1, kWithNormal = 2 };

template <int kPlanes>
HWY_INLINE Owners samplesAt(const Current& now, ptrdiff_t at) {
    const D32 d;
    Owners o{hn::LoadU(d, now.depth + at), load16(now.id + at), hn::Zero(d),
             load16(now.depth_before + at), hn::Zero(d)};
    if ((kPlanes & kWithMotion) != 0) {
        o.motion = loadMotion(now.motion + at);
    }
    if ((kPlanes & kWithNormal) != 0 && now.normal != nullptr) {
        o.normal = compacted(hn::LoadU(d, now.normal + at));
    }
    return o;
}

HWY_INLINE void takeWhere(Mask32 better, Owners& best, const Owners& other) {
    best.depth = hn::IfThenElse(better, other.depth, best.depth);
    best.id = hn::IfThenElse(better, other.id, best.id);
    best.motion = hn::IfThenElse(better, other.motion, best.motion);
    best.expected = hn::IfThenElse(better, other.expected, best.expected);
    best.normal = hn::IfThenElse(better, other.normal, best.normal);
}

/// Depths are below 2^31, so they compare as signed lanes.
struct Nearest {
    static constexpr uint32_t kNever = 0;  ///< depth outside the picture
    static HWY_INLINE void take(Owners& best, const Owners& other) {
        takeWhere(maskOf(hn::Gt(asSigned(other.depth), asSigned(best.depth))), best, other);
    }
};
struct Farthest {
    static constexpr uint32_t kNever = 0x7FFFFFFF;
    static HWY_INLINE void take(Owners& best, const Owners& other) {
        takeWhere(maskOf(hn::Lt(asSigned(other.depth), asSigned(best.depth))), best, other);
    }
};

template <int kPlanes>
HWY_INLINE void storeStrip(const Owners& owners, OwnerStrip& strip, int i) {
    const D32 d;
    hn::StoreU(owners.depth, d, strip.depth + i);
    hn::StoreU(owners.id, d, strip.id + i);
    hn::StoreU(owners.expected, d, strip.expected + i);
    if ((kPlanes & kWithMotion) != 0) {
        hn::StoreU(owners.motion, d, strip.motion + i);
    }
    if ((kPlanes & kWithNormal) != 0) {
        hn::StoreU(owners.normal, d, strip.normal + i);
    }
}

template <int kPlanes>
HWY_INLINE Owners loadStrip(const OwnerStrip& strip, int i) {
    const D32 d;
    const V32 zero = hn::Zero(d);
    return {hn::LoadU(d, strip.depth + i), hn::LoadU(d, strip.id + i),
            (kPlanes & kWithMotion) != 0 ? hn::LoadU(d, strip.motion + i) : zero,
            hn::LoadU(d, strip.expected + i),
            (kPlanes & kWithNormal) != 0 ? hn::LoadU(d, strip.normal + i) : zero};
}

/// Fills the strip for row y of the tile.
template <class Which, int kPlanes>
HWY_INLINE void fillStrip(const Job& job, const TileRect& tile, int y, OwnerStrip& strip) {
    const int lanes = int(hn::Lanes(D32()));
    for (int i = kMaxLanes - lanes; i < kMaxLanes + (tile.x1 - tile.x0) + 1; i += lanes) {
        const ptrdiff_t at = y * job.stride + tile.x0 - kMaxLanes + i;
        Owners best = samplesAt<kPlanes>(job.now, at);
        if (y > 0) {
            Which::take(best, samplesAt<kPlanes>(job.now, at - job.stride));
        }
        if (y + 1 < job.height) {
            Which::take(best, samplesAt<kPlanes>(job.now, at + job.stride));
        }
        storeStrip<kPlanes>(best, strip, i);
    }
    if (tile.x0 == 0) {
        strip.depth[kMaxLanes - 1] = Which::kNever;
    }
    if (tile.x1 == job.width) {
        strip.depth[kMaxLanes + tile.x1 - tile.x0] = Which::kNever;
    }
}

/// Of the pixels x … x + lanes − 1 of the strip's row.
template <class Which, int kPlanes>
HWY_INLINE Owners ownersOf(const OwnerStrip& strip, int x_in_tile) {
    const int i = kMaxLanes + x_in_tile;
    Owners best = loadStrip<kPlanes>(strip, i);
    Which::take(best, loadStrip<kPlanes>(strip, i - 1));
    Which::take(best, loadStrip<kPlanes>(strip, i + 1));
    return best;
}

/// What the centre itself shows of the owner is nearer to the pixel's own motion: seenOwner().
template <int kPlanes>
HWY_INLINE void preferCentre(const Job& job, ptrdiff_t at, Owners& best) {
    const V32 mask = hn::Set(D32(), kSurfaceMask);
    const Owners centre = samplesAt<kPlanes>(job.now, at);
    const VI32 step = asSigned(hn::Sub(clampedLogDepth(best.depth), clampedLogDepth(centre.depth)));
    const Mask32 close = maskOf(atMost(step, hn::Set(DI32(), kDepthTolerance)));
    const Mask32 same = hn::Eq(hn::And(centre.id, mask), hn::And(best.id, mask));
    takeWhere(hn::And(same, close), best, centre);
}

/// seenOwner().slope of the pixels at `at`.
HWY_INLINE VI32 slopesOf(const Job& job, ptrdiff_t at, V32 surface, V32 depth) {
    const V32 mask = hn::Set(D32(), kSurfaceMask);
    const V32 id = hn::And(load16(job.now.id + at), mask);
    const V32 here = clampedLogDepth(hn::LoadU(D32(), job.now.depth + at));
    return hn::IfThenElseZero(signedMask(hn::Eq(id, surface)), asSigned(hn::Sub(depth, here)));
}

/// Pixels a motion away, rounded: their index, or the pixel's own where that is not in the picture.
HWY_INLINE Mask32 indexAfter(const Job& job, int x, int y, V32 motion, VI32& index) {
    const DI32 di;
    const VI32 half = hn::Set(di, 128);
    const VI32 column = hn::Iota(di, x);
    const VI32 px = hn::Add(column, hn::ShiftRight<8>(hn::Add(lowSigned(motion), half)));
    const VI32 py = hn::Add(hn::Set(di, y), hn::ShiftRight<8>(hn::Add(highSigned(motion), half)));
    const Mask32 inside = hn::And(within(px, job.width), within(py, job.height));
    const VI32 stride = hn::Set(di, int32_t(job.stride));
    const VI32 own = hn::Add(hn::Set(di, int32_t(y * job.stride)), column);
    index = choose(inside, hn::Add(hn::Mul(py, stride), px), own);
    return inside;
}

/// Words at `index`, which are often neighbours.
HWY_INLINE V32 fetch(const uint32_t* plane, VI32 index) {
    const DI32 di;
    const int32_t first = hn::GetLane(index);
    if (hn::AllTrue(di, hn::Eq(index, hn::Iota(di, first)))) {
        return hn::LoadU(D32(), plane + first);
    }
    return hn::GatherIndex(D32(), plane, index);
}

/// What is recorded of an owner.
struct Recorded {
    V32 owner, depth, motion;
};

/// inferOwner()
HWY_INLINE void inferOwners(const Job& job, int x, int y, Mask32 pixels, const Owners& seen,
                            VI32 slope, Recorded& out) {
    const D32 d;
    const DI32 di;
    const SlotIn& before = job.slot[1];
    const VI32 none = hn::Set(di, kNoHistory);
    VI32 there;
    Mask32 found = hn::And(pixels, hn::Not(maskOf(hn::Eq(lowSigned(seen.motion), none))));
    found = hn::And(found, indexAfter(job, x, y, seen.motion, there));
    const V32 depth = high(fetch(before.depths, there));
    const VI32 bound =
        hn::Add(asSigned(seen.expected),
                hn::Add(hn::Set(di, kDepthTolerance), hn::Mul(slope, hn::Set(di, kSlopeFactor))));
    found = hn::And(found, maskOf(hn::Gt(asSigned(depth), bound)));
    if (hn::AllFalse(d, found)) {
        return;
    }
    const V32 surface_mask = hn::Set(d, kSurfaceMask);
    const V32 owner = fetch(before.owner, there);
    const V32 motion = fetch(before.motion, there);
    const V32 low_owner = low(owner);
    const V32 seen_surface = hn::And(seen.id, surface_mask);
    found = hn::And(found, hn::Eq(hn::And(low_owner, hn::Set(d, kInferredBit)), hn::Zero(d)));
    found = hn::AndNot(hn::Eq(low_owner, seen_surface), found);
    if (job.start_age != nullptr) {
        const VI32 surface = asSigned(hn::And(low_owner, surface_mask));
        const V32 age = hn::GatherIndex(d, job.start_age, surface);
        found = hn::AndNot(hn::Eq(age, hn::Zero(d)), found);
    }
    found = hn::AndNot(maskOf(hn::Eq(lowSigned(motion), none)), found);
    VI32 from;
    found = hn::And(found, indexAfter(job, x, y, motion, from));
    const V32 from_owner = fetch(before.owner, from);
    const V32 from_depth = high(fetch(before.depths, from));
    const VI32 change = hn::Abs(hn::Sub(asSigned(from_depth), asSigned(depth)));
    found = hn::And(found, hn::Eq(low(from_owner), low_owner));
    found = hn::And(found, maskOf(atMost(change, hn::Set(di, kDepthTolerance))));
    if (hn::AllFalse(d, found)) {
        return;
    }
    out.owner = choose(found, hn::Or(from_owner, hn::Set(d, kInferredBit)), out.owner);
    out.depth = choose(found, from_depth, out.depth);
    out.motion = choose(found, fetch(before.motion, from), out.motion);
}

HWY_ATTR void recordTile(const Job& job, const TileRect& tile) noexcept {
    const D32 d;
    const int lanes = int(hn::Lanes(d));
    OwnerStrip strip;
    for (int y = tile.y0; y < tile.y1; ++y) {
        fillStrip<Nearest, kWithMotion | kWithNormal>(job, tile, y, strip);
        for (int x = tile.x0; x < tile.x1; x += lanes) {
            const ptrdiff_t at = y * job.stride + x;
            Owners seen = ownersOf<Nearest, kWithMotion | kWithNormal>(strip, x - tile.x0);
            preferCentre<kWithMotion | kWithNormal>(job, at, seen);
            const V32 surface = hn::And(seen.id, hn::Set(d, kSurfaceMask));
            const V32 depth = clampedLogDepth(seen.depth);
            Recorded owner{pack(surface, seen.normal), depth, seen.motion};
            if (job.frames > 1) {
                inferOwners(job, x, y, lanesBefore(tile.x1 - x), seen,
                            slopesOf(job, at, surface, depth), owner);
            }
            const SlotOut& out = job.record;
            const V32 id = load16(job.now.id + at);
            const V32 own_depth = clampedLogDepth(hn::LoadU(d, job.now.depth + at));
            hn::StoreU(pack(load16(job.now.colour[0] + at), load16(job.now.colour[1] + at)), d,
                       out.red_green + at);
            hn::StoreU(pack(load16(job.now.colour[2] + at), id), d, out.blue_id + at);
            hn::StoreU(pack(own_depth, owner.depth), d, out.depths + at);
            hn::StoreU(owner.motion, d, out.motion + at);
            hn::StoreU(owner.owner, d, out.owner + at);
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace still::taa
HWY_AFTER_NAMESPACE();
