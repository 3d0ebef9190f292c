// Colours of a group of lanes: loading, adding samples, storing, and asking for the next rows in
// time. Included once per target by resolve_simd.cpp.

HWY_BEFORE_NAMESPACE();
namespace still::taa {
namespace HWY_NAMESPACE {

/// A group's colours while it is worked on.
struct Sums {
    V32 mean[3];
    VI32 rest[3];
    V32 count;
};

HWY_INLINE Sums loadSums(const HistoryIn& in, ptrdiff_t at) {
    Sums s;
    for (int c = 0; c < 3; ++c) {
        s.mean[c] = load16(in.mean[c] + at);
        s.rest[c] = loadI8(in.rest[c] + at);
    }
    s.count = load8(in.count + at);
    return s;
}

HWY_INLINE void storeSums(const HistoryOut& out, ptrdiff_t at, const Sums& s) {
    for (int c = 0; c < 3; ++c) {
        store16(s.mean[c], out.mean[c] + at);
        storeI8(s.rest[c], out.rest[c] + at);
    }
    store8(s.count, out.count + at);
}

HWY_INLINE Sums choose(Mask32 mask, const Sums& yes, const Sums& no) {
    const auto signed_mask = hn::RebindMask(DI32(), mask);
    Sums s;
    for (int c = 0; c < 3; ++c) {
        s.mean[c] = hn::IfThenElse(mask, yes.mean[c], no.mean[c]);
        s.rest[c] = hn::IfThenElse(signed_mask, yes.rest[c], no.rest[c]);
    }
    s.count = hn::IfThenElse(mask, yes.count, no.count);
    return s;
}

/// Adds this frame's samples to sums that stand for `count` ≥ 1 samples.
HWY_INLINE Sums grow(const ResolveJob& job, ptrdiff_t at, const Sums& past, V32 count) {
    const Growth growth = growthOf(count);
    Sums s = past;
    for (int c = 0; c < 3; ++c) {
        addSamples(growth, load16(job.now.colour[c] + at), s.mean[c], s.rest[c]);
    }
    s.count = asUnsigned(growth.grown);
    return s;
}

/// Lanes of the group that are pixels of the tile.
HWY_INLINE Mask32 lanesBefore(int end) {
    const DI32 di;
    return hn::RebindMask(D32(), hn::Lt(hn::Iota(di, 0), hn::Set(di, end)));
}

HWY_INLINE Mask32 notYet(V32 count, int cap) {
    return hn::RebindMask(D32(), hn::Lt(asSigned(count), hn::Set(DI32(), cap)));
}

/// A tile's row is only one or two cache lines of each plane, too short for the hardware to see a
/// pattern: without this a row waits for memory more than twice as long as it computes.
HWY_INLINE void prefetchPixels(const ResolveJob& job, ptrdiff_t at, ptrdiff_t from) {
    for (int c = 0; c < 3; ++c) {
        for (int half = 0; half < kTileSize; half += 32) {
            hwy::Prefetch(job.now.colour[c] + at + half);
            hwy::Prefetch(job.before.mean[c] + from + half);
            hwy::Prefetch(job.next.mean[c] + at + half);
        }
        hwy::Prefetch(job.before.rest[c] + from);
        hwy::Prefetch(job.next.rest[c] + at);
    }
    hwy::Prefetch(job.before.count + from);
    hwy::Prefetch(job.next.count + at);
}
HWY_INLINE void prefetchOwners(const ResolveJob& job, ptrdiff_t at, ptrdiff_t from) {
    const HistoryIn& before = job.before;
    const HistoryOut& next = job.next;
    for (int half = 0; half < kTileSize; half += 32) {
        for (const uint16_t* p : {before.surface, before.depth, before.normal}) {
            hwy::Prefetch(p + from + half);
        }
        for (const uint16_t* p : {next.surface, next.depth, next.normal}) {
            hwy::Prefetch(p + at + half);
        }
    }
}
constexpr int kRowsAhead = 2;

/// Folds a group's outcome into the tile's.
HWY_INLINE void report(TileResult& result, const ResolveJob& job, Mask32 pixels, V32 count,
                       Mask32 kept) {
    const D32 d;
    result.finished &= hn::AllFalse(d, hn::And(pixels, notYet(count, job.sample_cap)));
    result.changed |= !hn::AllFalse(d, hn::AndNot(kept, pixels));
}

}  // namespace HWY_NAMESPACE
}  // namespace still::taa
HWY_AFTER_NAMESPACE();
