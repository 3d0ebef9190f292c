// Lanes of 16 bits, one pixel each: everything that the ring keeps fits them. Sums of products are
// 32-bit lanes in pairs of vectors, by parity of the pixel or as InterleaveLower/Upper orders them.
// Included once per target by taa_simd.cpp.

HWY_BEFORE_NAMESPACE();
namespace still::taa {
namespace HWY_NAMESPACE {

constexpr int kMaxHalves = 32;
using DS = hn::CappedTag<int16_t, kMaxHalves>;
using DU = hn::RebindToUnsigned<DS>;
using DW = hn::RepartitionToWide<DS>;  // int32_t
using DWU = hn::RebindToUnsigned<DW>;
using VS = hn::Vec<DS>;
using VU = hn::Vec<DU>;
using VW = hn::Vec<DW>;
using VWU = hn::Vec<DWU>;
using MS = hn::Mask<DS>;
constexpr int kHalves = int(hn::MaxLanes(DS()));

HWY_INLINE VS set(int v) {
    return hn::Set(DS(), int16_t(v));
}
HWY_INLINE VS zero() {
    return hn::Zero(DS());
}
HWY_INLINE VS load(const int16_t* p) {
    return hn::LoadU(DS(), p);
}
HWY_INLINE VU unsign(VS v) {
    return hn::BitCast(DU(), v);
}
HWY_INLINE VS sign(VU v) {
    return hn::BitCast(DS(), v);
}
/// To and from values less kOffset.
HWY_INLINE VS flipTop(VS v) {
    return hn::Xor(v, set(-kOffset));
}
HWY_INLINE MS never() {
    return hn::MaskFromVec(zero());
}
HWY_INLINE bool any(MS m) {
    return !hn::AllFalse(DS(), m);
}
HWY_INLINE MS lanesUnder(int end) {
    return hn::Lt(hn::Iota(DS(), 0), set(end < kHalves ? end : kHalves));
}
/// 0 where 0 ≤ v ≤ last.
HWY_INLINE VS beyond(VS v, int last) {
    return sign(hn::SaturatedSub(unsign(v), hn::Set(DU(), uint16_t(last))));
}
/// |v|, held at 32767.
HWY_INLINE VS magnitude(VS v) {
    return hn::Max(v, hn::SaturatedSub(zero(), v));
}
/// |a − b|, held at 32767.
HWY_INLINE VS distance(VS a, VS b) {
    return hn::Max(hn::SaturatedSub(a, b), hn::SaturatedSub(b, a));
}

/// The best of sample(row 0 … 2, column −1 … 1). take(best, other) leaves the first on a tie:
/// middle before top before bottom, then middle before left before right.
template <class Sample, class Take>
HWY_INLINE auto bestOfWindow(const Sample& sample, const Take& take) {
    const auto column = [&](int i) {
        auto best = sample(1, i);
        take(best, sample(0, i));
        take(best, sample(2, i));
        return best;
    };
    auto best = column(0);
    take(best, column(-1));
    take(best, column(1));
    return best;
}

/// sum + a.even · b.even + a.odd · b.odd in each wide lane.
HWY_INLINE VW addProducts(VW sum, VS a, VS b) {
#if HWY_ARCH_X86
    VW unused = sum;
    return hn::ReorderWidenMulAccumulate(DW(), a, b, sum, unused);
#else
    const DW dw;
    const auto even = [&](VS v) {
        return hn::ShiftRight<16>(hn::ShiftLeft<16>(hn::BitCast(dw, v)));
    };
    const auto odd = [&](VS v) { return hn::ShiftRight<16>(hn::BitCast(dw, v)); };
    return hn::Add(sum, hn::Add(hn::Mul(even(a), even(b)), hn::Mul(odd(a), odd(b))));
#endif
}

/// a and b of the even pixels next to each other; of the odd ones.
HWY_INLINE VS evenPairs(VS a, VS b) {
    return hn::OddEven(hn::BitCast(DS(), hn::ShiftLeft<16>(hn::BitCast(DW(), b))), a);
}
HWY_INLINE VS oddPairs(VS a, VS b) {
    return hn::OddEven(b, hn::BitCast(DS(), hn::ShiftRight<16>(hn::BitCast(DWU(), a))));
}

/// One 32-bit number for each pixel, in the order of InterleaveLower and InterleaveUpper.
struct Wide {
    VW lower, upper;

    HWY_INLINE void clear() { lower = upper = hn::Zero(DW()); }
    /// += a · x + b · y
    HWY_INLINE void add(VS a, VS b, VS x, VS y) {
        const DS d;
        lower = addProducts(lower, hn::InterleaveLower(d, a, b), hn::InterleaveLower(d, x, y));
        upper = addProducts(upper, hn::InterleaveUpper(d, a, b), hn::InterleaveUpper(d, x, y));
    }
};
/// Back to 16 bits; what does not fit is held at the ends.
HWY_INLINE VS narrow(VW lower, VW upper) {
#if HWY_ARCH_ARM_V7  // where Highway 1.0.3 puts them the other way round than elsewhere
    return hn::ReorderDemote2To(DS(), upper, lower);
#else
    return hn::ReorderDemote2To(DS(), lower, upper);
#endif
}
template <class Function>
HWY_INLINE VS narrowed(Function&& function) {
    return narrow(function(std::true_type()), function(std::false_type()));
}

/// table[v] for tables of values up to 16 bits.
HWY_INLINE VS lookUp(const uint32_t* table, VS v) {
    alignas(64) uint16_t index[kHalves];
    alignas(64) int16_t found[kHalves];
    hn::Store(unsign(v), DU(), index);
    for (int i = 0; i < kHalves; ++i) {
        found[i] = int16_t(table[index[i]]);
    }
    return hn::Load(DS(), found);
}

/// Lanes whose places lie next to each other as the pixels do form a cluster, which is loaded at
/// once. Calls visit(column of the first lane, row, lanes) for each; `column` is less the lane's
/// number, and some lane must be set.
template <class Visit>
HWY_INLINE void forClusters(VS column, VS row, MS lanes, Visit&& visit) {
    const DS d;
    const int16_t column0 = hn::GetLane(column), row0 = hn::GetLane(row);
    const MS with0 = hn::And(hn::Eq(column, hn::Set(d, column0)), hn::Eq(row, hn::Set(d, row0)));
    if (hn::AllFalse(d, hn::AndNot(with0, lanes))) {  // the usual case
        visit(int(column0), int(row0), lanes);
        return;
    }
    alignas(64) int16_t columns[kHalves], rows[kHalves];
    hn::Store(column, d, columns);
    hn::Store(row, d, rows);
    do {
        const intptr_t first = hn::FindFirstTrue(d, lanes);
        const MS near = hn::And(hn::Eq(column, hn::Set(d, columns[first])),
                                hn::Eq(row, hn::Set(d, rows[first])));
        visit(int(columns[first]), int(rows[first]), hn::And(near, lanes));
        lanes = hn::AndNot(near, lanes);
    } while (any(lanes));
}

}  // namespace HWY_NAMESPACE
}  // namespace still::taa
HWY_AFTER_NAMESPACE();
