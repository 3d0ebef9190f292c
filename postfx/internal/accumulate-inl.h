// Sums of still pixels in lanes of 16 bits; accumulate_reference.cpp is the truth. Whole vectors
// reach into the rows' padding. Included once per target by taa_simd.cpp.

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

/// All pixels of a row have `count` samples and take one more. Channel after channel: few streams.
HWY_INLINE void growRow(const Job& job, ptrdiff_t at, int width, int count) {
    const D d;
    const int lanes = int(hn::Lanes(d));
    const Growth growth = growthOf(count + 1);
    for (int c = 0; c < 3; ++c) {
        const uint16_t* samples = job.now.colour[c] + at;
        const uint16_t* from = (count < job.settled ? job.sums.mean[c] : job.shown[c]) + at;
        uint16_t* to = (count + 1 < job.settled ? job.sums.mean[c] : job.shown[c]) + at;
        int8_t* rests = job.sums.rest[c] + at;
        for (int x = 0; x < width; x += lanes) {
            const V sample = hn::LoadU(d, samples + x);
            V mean = sample, rest = hn::Zero(d);
            if (count > 0) {
                mean = hn::LoadU(d, from + x);
                rest = loadSigned(rests + x);
                addSamples(growth, sample, mean, rest);
            }
            hn::StoreU(mean, d, to + x);
            storeSigned(rest, rests + x);
        }
    }
    for (int x = 0; x < width; x += lanes) {
        storeBytes(growth.grown, job.sums.count + at + x);
        if (count + 1 >= job.settled) {
            storeBytes(growth.grown, job.shown_count + at + x);
        }
    }
}

/// The count that all pixels of a row have, or −1.
HWY_INLINE int countOfRow(const uint8_t* count, int width) {
    const D d;
    const V first = set(count[0]);
    M same = hn::Eq(first, first);
    for (int x = 0; x < width; x += int(hn::Lanes(d))) {
        same = hn::And(same, hn::Eq(loadBytes(count + x), first));
    }
    return all(same) ? count[0] : -1;
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

/// disturbedRow()
HWY_INLINE bool disturbedLanes(const Job& job, const TileRect& tile, int y, uint8_t* flags) {
    if (job.change_age != nullptr) {
        return disturbedRow(job, tile, y, flags);
    }
    const D d;
    const int lanes = int(hn::Lanes(d)), width = tile.x1 - tile.x0;
    const ptrdiff_t at = y * job.stride + tile.x0;
    const ptrdiff_t up = y > 0 ? -job.stride : 0, down = y + 1 < job.height ? job.stride : 0;
    const uint16_t* ids[3] = {job.now.id + at + up, job.now.id + at, job.now.id + at + down};
    uint8_t columns[kTileSize + 2 * kMostLanes] = {};  // that of tile.x0 is the second
    M any_moved = hn::Ne(set(0), set(0));
    for (int x = 0; x < width; x += lanes) {
        const V all_three = hn::Or(hn::Or(hn::LoadU(d, ids[0] + x), hn::LoadU(d, ids[1] + x)),
                                   hn::LoadU(d, ids[2] + x));
        const M moved = hn::Ne(hn::And(all_three, set(kMovedBit)), hn::Zero(d));
        storeBytes(hn::IfThenElseZero(moved, set(kMoved)), columns + 1 + x);
        any_moved = hn::Or(any_moved, moved);
    }
    const auto column = [&](int x) {
        const int both = ids[0][x] | ids[1][x] | ids[2][x];
        return uint8_t((both & kMovedBit) != 0 ? kMoved : 0);
    };
    columns[0] = tile.x0 > 0 ? column(-1) : 0;
    columns[width + 1] = tile.x1 < job.width ? column(width) : 0;
    if (!any(any_moved) && columns[0] + columns[width + 1] == 0) {
        return false;
    }
    for (int x = 0; x < width; x += lanes) {
        const V sides = hn::Or(loadBytes(columns + x), loadBytes(columns + x + 2));
        storeBytes(hn::Or(sides, loadBytes(columns + x + 1)), flags + x);
    }
    return true;
}

/// Marks pixels whose sums hold samples from before their light changed; whether there are any.
HWY_INLINE bool agedLanes(const Job& job, ptrdiff_t at, int width, uint8_t* flags) {
    M any_old = hn::Ne(set(0), set(0));
    for (int x = 0; x < width; x += int(hn::Lanes(D()))) {
        const V age = loadBytes(job.light_age + at + x);
        const M old = reaches(loadBytes(job.sums.count + at + x), hn::Add(age, set(1)));
        const V flag = hn::IfThenElseZero(old, set(kChanged));
        storeBytes(hn::Max(loadBytes(flags + x), flag), flags + x);
        any_old = hn::Or(any_old, old);
    }
    return any(any_old);
}

/// Pixels of a row that differ in their counts or in what happens to them.
HWY_INLINE void sumRow(const Job& job, ptrdiff_t at, int width, const uint8_t* disturbed,
                       bool restart, SumsResult& result) {
    const D d;
    const V zero = hn::Zero(d);
    for (int x = 0; x < width; x += int(hn::Lanes(d))) {
        V count = restart ? zero : loadBytes(job.sums.count + at + x);
        const V disturbance = loadBytes(disturbed + x);
        const M anew = hn::Ne(disturbance, zero);
        result.changed |= any(hn::And(anew, hn::Ne(count, zero)));
        count = hn::IfThenZeroElse(anew, count);
        const M padding = reaches(hn::Iota(d, uint16_t(x)), set(width));
        const M full = hn::Or(padding, reaches(count, set(job.sample_cap)));
        const M grows = hn::AndNot(full, hn::Ne(disturbance, set(kMoved)));
        const V grown = hn::Add(count, hn::IfThenElseZero(grows, set(1)));
        storeBytes(grown, job.sums.count + at + x);
        result.settled &= all(hn::Or(padding, reaches(grown, set(job.settled))));
        result.finished &= all(hn::Or(padding, reaches(grown, set(job.sample_cap))));
        if (any(grows)) {
            growApart(job, at + x, count, grows);
            result.changed = true;
        }
    }
}

/// Rows of a tile lie too far apart for the hardware to know where the next one is.
constexpr int kRowsAhead = 3;
HWY_INLINE void prefetchRow(const Job& job, ptrdiff_t at) {
    const auto lines = [](const auto* p) {
        for (size_t i = 0; i < kTileSize; i += 64 / sizeof(*p)) {
            hwy::Prefetch(p + i);
        }
    };
    for (int c = 0; c < 3; ++c) {
        lines(job.now.colour[c] + at);
        lines(job.shown[c] + at);
        lines(job.sums.rest[c] + at);
    }
    lines(job.sums.count + at);
    lines(job.shown_count + at);
}

}  // namespace sums

HWY_ATTR SumsResult accumulateTile(const Job& job, const TileRect& tile, Stillness stillness,
                                   bool restart) noexcept {
    SumsResult result;
    uint8_t disturbed[kTileSize + sums::kMostLanes] = {};
    const int width = tile.x1 - tile.x0;
    for (int y = tile.y0; y < tile.y1; ++y) {
        const ptrdiff_t at = y * job.stride + tile.x0;
        if (y + sums::kRowsAhead < tile.y1) {
            sums::prefetchRow(job, at + sums::kRowsAhead * job.stride);
        }
        bool calm = stillness == Stillness::all || !sums::disturbedLanes(job, tile, y, disturbed);
        if (job.light_age != nullptr && stillness == Stillness::tested && !restart) {
            if (calm) {
                std::fill_n(disturbed, kTileSize, uint8_t{0});
            }
            calm &= !sums::agedLanes(job, at, width, disturbed);
        }
        const int count = restart ? 0 : sums::countOfRow(job.sums.count + at, width);
        if (!calm || count < 0) {
            if (calm) {
                std::fill_n(disturbed, kTileSize, uint8_t{0});
            }
            sums::sumRow(job, at, width, disturbed, restart, result);
        } else if (count < job.sample_cap) {
            sums::growRow(job, at, width, count);
            result.changed = true;
            result.settled &= count + 1 >= job.settled;
            result.finished &= count + 1 >= job.sample_cap;
        }
    }
    return result;
}

}  // namespace HWY_NAMESPACE
}  // namespace still::taa
HWY_AFTER_NAMESPACE();
