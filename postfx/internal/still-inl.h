// Tiles that need no search for history, in lanes: nothing moved, or there is none. Included once
// per target by resolve_simd.cpp.

HWY_BEFORE_NAMESPACE();
namespace still::taa {
namespace HWY_NAMESPACE {

HWY_INLINE void copyOwners(const ResolveJob& job, ptrdiff_t at, int count) {
    const size_t bytes = size_t(count) * sizeof(uint16_t);
    std::memcpy(job.next.surface + at, job.before.surface + at, bytes);
    std::memcpy(job.next.depth + at, job.before.depth + at, bytes);
    std::memcpy(job.next.normal + at, job.before.normal + at, bytes);
}

HWY_ATTR TileResult resolveStill(const ResolveJob& job, const TileRect& tile) {
    const int lanes = int(hn::Lanes(D32()));
    TileResult result{true, false};
    for (int y = tile.y0; y < tile.y1; ++y) {
        const ptrdiff_t ahead = std::min(y + kRowsAhead, job.height - 1) * job.stride + tile.x0;
        prefetchPixels(job, ahead, ahead);
        prefetchOwners(job, ahead, ahead);
        copyOwners(job, y * job.stride + tile.x0, tile.x1 - tile.x0);
        for (int x = tile.x0; x < tile.x1; x += lanes) {
            const ptrdiff_t at = y * job.stride + x;
            const Mask32 pixels = lanesBefore(tile.x1 - x);
            const Sums past = loadSums(job.before, at);
            const Mask32 grows = hn::And(pixels, notYet(past.count, job.sample_cap));
            Sums sums = past;
            if (!hn::AllFalse(D32(), grows)) {
                const V32 count = hn::IfThenElse(grows, past.count, hn::Set(D32(), 1));
                sums = choose(grows, grow(job, at, past, count), past);
            }
            storeSums(job.next, at, sums);
            report(result, job, pixels, sums.count, hn::Not(grows));
        }
    }
    return result;
}

HWY_INLINE void storeOwners(const ResolveJob& job, ptrdiff_t at, const Owners& owners, V32 depth) {
    store16(hn::And(owners.id, hn::Set(D32(), kSurfaceMask)), job.next.surface + at);
    store16(depth, job.next.depth + at);
    store16(owners.normal, job.next.normal + at);
}

HWY_ATTR TileResult resolveFresh(const ResolveJob& job, const TileRect& tile) {
    const D32 d;
    const int lanes = int(hn::Lanes(d));
    OwnerStrip strip;
    for (int y = tile.y0; y < tile.y1; ++y) {
        fillStrip(job, tile, y, strip);
        for (int x = tile.x0; x < tile.x1; x += lanes) {
            const ptrdiff_t at = y * job.stride + x;
            const Owners owners = ownersOf(strip, x - tile.x0);
            storeOwners(job, at, owners, clampedLogDepth(owners.depth));
            Sums sums;
            for (int c = 0; c < 3; ++c) {
                sums.mean[c] = load16(job.now.colour[c] + at);
                sums.rest[c] = hn::Zero(DI32());
            }
            sums.count = hn::Set(d, 1);
            storeSums(job.next, at, sums);
        }
    }
    return {job.sample_cap <= 1, true};
}

}  // namespace HWY_NAMESPACE
}  // namespace still::taa
HWY_AFTER_NAMESPACE();
