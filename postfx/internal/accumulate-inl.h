// Sums of still pixels in lanes; accumulate_reference.cpp is the truth. Included once per target by
// taa_simd.cpp.

HWY_BEFORE_NAMESPACE();
namespace still::taa {
namespace HWY_NAMESPACE {

/// Adds the group's samples where `grows`; shows the sums where `shows`.
HWY_INLINE void growSums(const Job& job, ptrdiff_t at, V32 count, Mask32 grows, Mask32 shows) {
    const D32 d;
    const Mask32 first = hn::Eq(count, hn::Zero(d));
    const Growth growth = growthOf(hn::Max(count, hn::Set(d, 1)));
    for (int c = 0; c < 3; ++c) {
        const V32 sample = load16(job.now.colour[c] + at);
        const V32 old_mean = load16(job.sums.mean[c] + at);
        const VI32 old_rest = loadI8(job.sums.rest[c] + at);
        V32 mean = old_mean;
        VI32 rest = old_rest;
        addSamples(growth, sample, mean, rest);
        mean = choose(first, sample, mean);
        rest = choose(first, hn::Zero(DI32()), rest);
        mean = choose(grows, mean, old_mean);
        store16(mean, job.sums.mean[c] + at);
        storeI8(choose(grows, rest, old_rest), job.sums.rest[c] + at);
        if (!hn::AllFalse(d, shows)) {
            store16(choose(shows, mean, load16(job.shown[c] + at)), job.shown[c] + at);
        }
    }
}

HWY_ATTR SumsResult accumulateTile(const Job& job, const TileRect& tile, Stillness stillness,
                                   bool restart) noexcept {
    const D32 d;
    const DI32 di;
    const int lanes = int(hn::Lanes(d));
    SumsResult result;
    uint8_t disturbed[kTileSize + kMaxLanes] = {};
    for (int y = tile.y0; y < tile.y1; ++y) {
        if (stillness == Stillness::tested) {
            disturbedRow(job, tile, y, disturbed);
        }
        for (int x = tile.x0; x < tile.x1; x += lanes) {
            const ptrdiff_t at = y * job.stride + x;
            const Mask32 pixels = lanesBefore(tile.x1 - x);
            const V32 disturbance = hn::IfThenElseZero(pixels, load8(disturbed + (x - tile.x0)));
            const Mask32 anew = hn::Ne(disturbance, hn::Zero(d));
            const Mask32 moved = hn::Eq(disturbance, hn::Set(d, kMoved));
            V32 count = restart ? hn::Zero(d) : load8(job.sums.count + at);
            result.changed |= !hn::AllFalse(d, hn::And(anew, hn::Ne(count, hn::Zero(d))));
            count = hn::IfThenZeroElse(anew, count);
            const Mask32 below = maskOf(hn::Lt(asSigned(count), hn::Set(di, job.sample_cap)));
            const Mask32 grows = hn::And(hn::AndNot(moved, pixels), below);
            const V32 grown = hn::Add(count, hn::IfThenElseZero(grows, hn::Set(d, 1)));
            const Mask32 settled = maskOf(atLeast(asSigned(grown), hn::Set(di, job.settled)));
            if (!hn::AllFalse(d, grows)) {
                const Mask32 shows = hn::And(grows, settled);
                growSums(job, at, count, grows, shows);
                const V32 shown = load8(job.shown_count + at);
                store8(choose(shows, grown, shown), job.shown_count + at);
                result.changed = true;
            }
            store8(choose(pixels, grown, load8(job.sums.count + at)), job.sums.count + at);
            result.settled &= hn::AllFalse(d, hn::AndNot(settled, pixels));
            const Mask32 done = maskOf(atLeast(asSigned(grown), hn::Set(di, job.sample_cap)));
            result.finished &= hn::AllFalse(d, hn::AndNot(done, pixels));
        }
    }
    return result;
}

}  // namespace HWY_NAMESPACE
}  // namespace still::taa
HWY_AFTER_NAMESPACE();
