// Sums of still pixels in lanes of 16 bits; accumulate_reference.cpp is the truth. Whole vectors
// reach into the rows' padding, whose pixels grow along: none has fewer samples than all of its
// row. Included once per target by taa_simd.cpp.

HWY_BEFORE_NAMESPACE();
namespace still::taa {
namespace HWY_NAMESPACE {
namespace sums {

constexpr int kMostLanes = 32;
using D = hn::CappedTag<uint16_t, kMostLanes>;
using DI = hn::RebindToSigned<D>;
using DBytes = hn::Rebind<uint8_t, D>;
using DSignedBytes = hn::Rebind<int8_t, D>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

HWY_INLINE V set(int v) {
    return hn::Set(D(), uint16_t(v));
}
HWY_INLINE V loadBytes(const uint8_t* p) {
    return hn::PromoteTo(D(), hn::LoadU(DBytes(), p));
}
HWY_INLINE void storeBytes(V v, uint8_t* p) {
    hn::StoreU(hn::DemoteTo(DBytes(), hn::BitCast(DI(), v)), DBytes(), p);
}
HWY_INLINE V loadSigned(const int8_t* p) {
    return hn::BitCast(D(), hn::PromoteTo(DI(), hn::LoadU(DSignedBytes(), p)));
}
HWY_INLINE void storeSigned(V v, int8_t* p) {
    hn::StoreU(hn::DemoteTo(DSignedBytes(), hn::BitCast(DI(), v)), DSignedBytes(), p);
}
/// a ≥ b, of numbers below 2^15.
HWY_INLINE M reaches(V a, V b) {
    const DI di;
    return hn::Not(hn::RebindMask(D(), hn::Lt(hn::BitCast(di, a), hn::BitCast(di, b))));
}
HWY_INLINE bool all(M m) {
    return hn::AllTrue(D(), m);
}
HWY_INLINE bool any(M m) {
    return !hn::AllFalse(D(), m);
}

/// What addSample() needs of the count.
struct Growth {
    V grown;       ///< count + 1
    V reciprocal;  ///< floor(2^16 / grown), at most 2^16 − 1
};

HWY_INLINE Growth growthOf(int grown) {
    return {set(grown), set(kShortReciprocals[size_t(grown)])};
}

HWY_INLINE Growth growthOf(V count) {
    const D d;
    const V grown = hn::Add(count, set(1));
    alignas(64) uint16_t lanes[kMostLanes];
    hn::Store(grown, d, lanes);
    for (size_t i = 0; i < hn::Lanes(d); ++i) {
        lanes[i] = kShortReciprocals[lanes[i]];
    }
    return {grown, hn::Load(d, lanes)};
}

/// addSample(), for all samples; of count 0, mean is the sample and rest is 0.
HWY_INLINE void addSamples(const Growth& growth, V sample, V& mean, V& rest) {
    const V one = set(1);
    const V up = hn::SaturatedSub(sample, mean), down = hn::SaturatedSub(mean, sample);
    const V size = hn::Or(up, down);
    const V falls = hn::VecFromMask(D(), hn::Ne(down, hn::Zero(D())));  // all ones: −1
    // The quotient by the reciprocal is right or 1 too small.
    V quotient = hn::MulHigh(size, growth.reciprocal);
    V left = hn::Sub(size, hn::Mul(quotient, growth.grown));
    quotient = hn::Add(quotient, hn::IfThenElseZero(reaches(left, growth.grown), one));
    left = hn::Min(left, hn::Sub(left, growth.grown));
    // −(q · n + left) = −(q + 1) · n + (n − left), and −(q + 1) = ~q.
    quotient = hn::Xor(quotient, falls);
    left = hn::Add(hn::Xor(left, falls), hn::And(hn::Add(growth.grown, one), falls));
    const V half = hn::ShiftRight<1>(growth.grown);
    left = hn::Add(left, hn::Add(rest, half));  // 0 … 2 · grown − 1
    mean = hn::Add(hn::Add(mean, quotient), hn::IfThenElseZero(reaches(left, growth.grown), one));
    rest = hn::Sub(hn::Min(left, hn::Sub(left, growth.grown)), half);
}

/// All lanes have `count` samples and take one more.
HWY_INLINE void growAlike(const Job& job, ptrdiff_t at, int count) {
    const D d;
    const Growth growth = growthOf(count + 1);
    for (int c = 0; c < 3; ++c) {
        const uint16_t* from = (count < job.settled ? job.sums.mean[c] : job.shown[c]) + at;
        uint16_t* to = (count + 1 < job.settled ? job.sums.mean[c] : job.shown[c]) + at;
        const V sample = hn::LoadU(d, job.now.colour[c] + at);
        V mean = sample, rest = hn::Zero(d);
        if (count > 0) {
            mean = hn::LoadU(d, from);
            rest = loadSigned(job.sums.rest[c] + at);
            addSamples(growth, sample, mean, rest);
        }
        hn::StoreU(mean, d, to);
        storeSigned(rest, job.sums.rest[c] + at);
    }
    if (count + 1 >= job.settled) {
        storeBytes(growth.grown, job.shown_count + at);
    }
}

/// Lanes that grow take one more sample, whatever they have.
HWY_INLINE void growApart(const Job& job, ptrdiff_t at, V count, M grows) {
    const D d;
    const Growth growth = growthOf(count);
    const M first = hn::Eq(count, hn::Zero(d));
    const M was_shown = reaches(count, set(job.settled));
    const M is_shown = reaches(growth.grown, set(job.settled));
    const M show = hn::And(grows, is_shown), keep = hn::AndNot(is_shown, grows);
    for (int c = 0; c < 3; ++c) {
        const V sample = hn::LoadU(d, job.now.colour[c] + at);
        const V shown = hn::LoadU(d, job.shown[c] + at);
        const V young = hn::LoadU(d, job.sums.mean[c] + at);
        const V old_rest = loadSigned(job.sums.rest[c] + at);
        V mean = hn::IfThenElse(first, sample, hn::IfThenElse(was_shown, shown, young));
        V rest = hn::IfThenZeroElse(first, old_rest);
        addSamples(growth, sample, mean, rest);
        hn::StoreU(hn::IfThenElse(show, mean, shown), d, job.shown[c] + at);
        hn::StoreU(hn::IfThenElse(keep, mean, young), d, job.sums.mean[c] + at);
        storeSigned(hn::IfThenElse(grows, rest, old_rest), job.sums.rest[c] + at);
    }
    const V shown_count = loadBytes(job.shown_count + at);
    storeBytes(hn::IfThenElse(show, growth.grown, shown_count), job.shown_count + at);
}

}  // namespace sums

HWY_ATTR SumsResult accumulateTile(const Job& job, const TileRect& tile, Stillness stillness,
                                   bool restart) noexcept {
    using namespace sums;
    const D d;
    const int lanes = int(hn::Lanes(d));
    const V zero = hn::Zero(d);
    SumsResult result;
    uint8_t disturbed[kTileSize + kMostLanes] = {};
    for (int y = tile.y0; y < tile.y1; ++y) {
        if (stillness == Stillness::tested) {
            disturbedRow(job, tile, y, disturbed);
        }
        for (int x = tile.x0; x < tile.x1; x += lanes) {
            const ptrdiff_t at = y * job.stride + x;
            V count = restart ? zero : loadBytes(job.sums.count + at);
            M grows = hn::Not(reaches(count, set(job.sample_cap)));
            if (stillness == Stillness::tested) {
                const V disturbance = loadBytes(disturbed + (x - tile.x0));
                const M anew = hn::Ne(disturbance, zero);
                result.changed |= any(hn::And(anew, hn::Ne(count, zero)));
                count = hn::IfThenZeroElse(anew, count);
                grows = hn::And(hn::Ne(disturbance, set(kMoved)), hn::Or(anew, grows));
            }
            const V grown = hn::Add(count, hn::IfThenElseZero(grows, set(1)));
            storeBytes(grown, job.sums.count + at);
            result.settled &= all(reaches(grown, set(job.settled)));
            result.finished &= all(reaches(grown, set(job.sample_cap)));
            if (!any(grows)) {
                continue;
            }
            result.changed = true;
            const int first = hn::GetLane(count);
            if (all(hn::And(grows, hn::Eq(count, set(first))))) {
                growAlike(job, at, first);
            } else {
                growApart(job, at, count, grows);
            }
        }
    }
    return result;
}

}  // namespace HWY_NAMESPACE
}  // namespace still::taa
HWY_AFTER_NAMESPACE();
