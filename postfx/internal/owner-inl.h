// Owners of a row of pixels in lanes; findOwner() in reproject.cpp is the truth. First the nearest
// sample of each column of three, kept in a strip with everything that belongs to it; then the
// nearest of three neighbouring columns.

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

HWY_INLINE V32 loadMotion(const Motion* p) {
    static_assert(sizeof(Motion) == sizeof(uint32_t));
    const hn::Repartition<uint8_t, D32> bytes;
    return hn::BitCast(D32(), hn::LoadU(bytes, reinterpret_cast<const uint8_t*>(p)));
}

HWY_INLINE Owners ownersAt(const Current& now, ptrdiff_t at) {
    const D32 d;
    return {hn::LoadU(d, now.depth + at), load16(now.id + at), loadMotion(now.motion + at),
            load16(now.depth_before + at),
            now.normal != nullptr ? compacted(hn::LoadU(d, now.normal + at)) : hn::Zero(d)};
}

/// Depths are below 2^31, so they compare as signed lanes.
HWY_INLINE void takeNearer(Owners& best, const Owners& other) {
    const auto nearer = hn::RebindMask(D32(), hn::Gt(asSigned(other.depth), asSigned(best.depth)));
    best.depth = hn::IfThenElse(nearer, other.depth, best.depth);
    best.id = hn::IfThenElse(nearer, other.id, best.id);
    best.motion = hn::IfThenElse(nearer, other.motion, best.motion);
    best.expected = hn::IfThenElse(nearer, other.expected, best.expected);
    best.normal = hn::IfThenElse(nearer, other.normal, best.normal);
}

HWY_INLINE void storeStrip(const Owners& owners, OwnerStrip& strip, int i) {
    const D32 d;
    hn::StoreU(owners.depth, d, strip.depth + i);
    hn::StoreU(owners.id, d, strip.id + i);
    hn::StoreU(owners.motion, d, strip.motion + i);
    hn::StoreU(owners.expected, d, strip.expected + i);
    hn::StoreU(owners.normal, d, strip.normal + i);
}

HWY_INLINE Owners loadStrip(const OwnerStrip& strip, int i) {
    const D32 d;
    return {hn::LoadU(d, strip.depth + i), hn::LoadU(d, strip.id + i),
            hn::LoadU(d, strip.motion + i), hn::LoadU(d, strip.expected + i),
            hn::LoadU(d, strip.normal + i)};
}

/// Fills the strip for row y of the tile. Columns outside the picture get depth 0, which never
/// wins.
HWY_ATTR void fillStrip(const ResolveJob& job, const TileRect& tile, int y, OwnerStrip& strip) {
    const int lanes = int(hn::Lanes(D32()));
    for (int i = kMaxLanes - lanes; i < kMaxLanes + (tile.x1 - tile.x0) + 1; i += lanes) {
        const ptrdiff_t at = y * job.stride + tile.x0 - kMaxLanes + i;
        Owners best = ownersAt(job.now, at);
        if (y > 0) {
            takeNearer(best, ownersAt(job.now, at - job.stride));
        }
        if (y + 1 < job.height) {
            takeNearer(best, ownersAt(job.now, at + job.stride));
        }
        storeStrip(best, strip, i);
    }
    if (tile.x0 == 0) {
        strip.depth[kMaxLanes - 1] = 0;
    }
    if (tile.x1 == job.width) {
        strip.depth[kMaxLanes + tile.x1 - tile.x0] = 0;
    }
}

/// Owners of the pixels x … x + lanes − 1 of the strip's row.
HWY_INLINE Owners ownersOf(const OwnerStrip& strip, int x_in_tile) {
    const int i = kMaxLanes + x_in_tile;
    Owners best = loadStrip(strip, i);
    takeNearer(best, loadStrip(strip, i - 1));
    takeNearer(best, loadStrip(strip, i + 1));
    return best;
}

}  // namespace HWY_NAMESPACE
}  // namespace still::taa
HWY_AFTER_NAMESPACE();
