// Loads, stores and the arithmetic of rules.h in lanes. Included once per target by
// resolve_simd.cpp; 32-bit lanes, one pixel each.

HWY_BEFORE_NAMESPACE();
namespace still::taa {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr int kMaxLanes = 16;
using D32 = hn::CappedTag<uint32_t, kMaxLanes>;
using DI32 = hn::RebindToSigned<D32>;
using D16 = hn::Rebind<uint16_t, D32>;
using D8 = hn::Rebind<uint8_t, D32>;
using DI8 = hn::Rebind<int8_t, D32>;
using V32 = hn::Vec<D32>;
using VI32 = hn::Vec<DI32>;
using V16 = hn::Vec<D16>;
using Mask32 = hn::Mask<D32>;

HWY_INLINE V32 load16(const uint16_t* p) {
    return hn::PromoteTo(D32(), hn::LoadU(D16(), p));
}
HWY_INLINE V32 load8(const uint8_t* p) {
    return hn::PromoteTo(D32(), hn::LoadU(D8(), p));
}
HWY_INLINE VI32 loadI8(const int8_t* p) {
    return hn::PromoteTo(DI32(), hn::LoadU(DI8(), p));
}
HWY_INLINE V32 asUnsigned(VI32 v) {
    return hn::BitCast(D32(), v);
}
HWY_INLINE VI32 asSigned(V32 v) {
    return hn::BitCast(DI32(), v);
}

HWY_INLINE V16 narrow16(V32 v) {
    const hn::RepartitionToNarrow<D32> d_twice;
    return hn::LowerHalf(D16(),
                         hn::ConcatEven(d_twice, hn::Zero(d_twice), hn::BitCast(d_twice, v)));
}
/// Values must be 0 … 255.
HWY_INLINE void store8(V32 v, uint8_t* p) {
    hn::StoreU(hn::DemoteTo(D8(), asSigned(v)), D8(), p);
}
HWY_INLINE void storeI8(VI32 v, int8_t* p) {
    hn::StoreU(hn::DemoteTo(DI8(), v), DI8(), p);
}
HWY_INLINE void store16(V32 v, uint16_t* p) {
    hn::StoreU(narrow16(v), D16(), p);
}

HWY_INLINE Mask32 noLanes() {
    return hn::MaskFromVec(hn::Zero(D32()));
}

/// roundShift() of rules.
template <int kShift>
HWY_INLINE VI32 roundedShift(VI32 v) {
    return hn::ShiftRight<kShift>(hn::Add(v, hn::Set(DI32(), 1 << (kShift - 1))));
}

HWY_INLINE V32 clampedLogDepth(V32 bits) {
    constexpr int32_t kTop = int32_t(0x3F800000u >> 12) - 65535;
    const DI32 di;
    const VI32 v = hn::Sub(asSigned(hn::ShiftRight<12>(bits)), hn::Set(di, kTop));
    return asUnsigned(hn::Min(hn::Max(v, hn::Zero(di)), hn::Set(di, 65535)));
}

HWY_INLINE V32 compacted(V32 normal) {
    const D32 d;
    return hn::Or(hn::And(hn::ShiftRight<8>(normal), hn::Set(d, 0x00FFu)),
                  hn::And(hn::ShiftRight<16>(normal), hn::Set(d, 0xFF00u)));
}

/// floor(2^32 / n) + 1: (v · table[n]) >> 32 is floor(v / n) exactly for n ≥ 2 and n · v < 2^32.
struct Reciprocals {
    uint32_t of[256];
};
constexpr Reciprocals makeReciprocals() {
    Reciprocals table{};
    for (uint64_t n = 2; n < 256; ++n) {
        table.of[n] = uint32_t((uint64_t{1} << 32) / n + 1);
    }
    return table;
}
alignas(64) constexpr Reciprocals kReciprocals = makeReciprocals();

/// What addSample() needs of the count: computed once for three channels.
struct Growth {
    VI32 grown;   ///< count + 1, 2 … 255
    VI32 offset;  ///< grown / 2 + grown · kBias: makes the numerator positive, rounds half up
    V32 reciprocal;
};
constexpr int32_t kBias = 32832;  // > (65535 + 127 · 2) / 2, and 255 · (255 · kBias + 2^17) < 2^32

HWY_INLINE Growth growthOf(V32 count) {
    const D32 d;
    const DI32 di;
    const VI32 grown = hn::Add(asSigned(count), hn::Set(di, 1));
    const VI32 first = hn::Set(di, hn::GetLane(grown));
    const V32 reciprocal = hn::AllTrue(di, hn::Eq(grown, first))
                               ? hn::Set(d, kReciprocals.of[hn::GetLane(grown)])
                               : hn::GatherIndex(d, kReciprocals.of, grown);
    const VI32 offset = hn::Add(hn::ShiftRight<1>(grown), hn::Mul(grown, hn::Set(di, kBias)));
    return {grown, offset, reciprocal};
}

HWY_INLINE V32 highProduct(V32 a, V32 b) {
    const D32 d;
    const hn::RepartitionToWide<D32> dw;
    const auto even = hn::MulEven(a, b);
    const auto odd = hn::MulEven(hn::BitCast(d, hn::ShiftRight<32>(hn::BitCast(dw, a))),
                                 hn::BitCast(d, hn::ShiftRight<32>(hn::BitCast(dw, b))));
    return hn::OddEven(hn::BitCast(d, odd), hn::BitCast(d, hn::ShiftRight<32>(even)));
}

/// addSample() for count ≥ 1.
HWY_INLINE void addSamples(const Growth& growth, V32 sample, V32& mean, VI32& rest) {
    const DI32 di;
    const VI32 excess = hn::Add(rest, asSigned(hn::Sub(sample, mean)));
    const V32 quotient = highProduct(asUnsigned(hn::Add(excess, growth.offset)), growth.reciprocal);
    const VI32 step = hn::Sub(asSigned(quotient), hn::Set(di, kBias));
    mean = asUnsigned(hn::Add(asSigned(mean), step));
    rest = hn::Sub(excess, hn::Mul(step, growth.grown));
}

struct Cubic {
    VI32 w[4];
};
/// cubicWeights()
HWY_INLINE Cubic cubicOf(VI32 f) {
    const DI32 di;
    const VI32 f1 = hn::ShiftLeft<16>(f);
    const VI32 ff = hn::Mul(f, f);
    const VI32 f2 = hn::ShiftLeft<8>(ff);
    const VI32 f3 = hn::Mul(ff, f);
    const auto times = [&](int k, VI32 v) { return hn::Mul(hn::Set(di, k), v); };
    const VI32 before = roundedShift<17>(times(-5, hn::Add(hn::Sub(f3, hn::Add(f2, f2)), f1)));
    const VI32 right =
        roundedShift<17>(hn::Add(hn::Sub(times(14, f2), times(11, f3)), times(5, f1)));
    const VI32 after = roundedShift<17>(times(5, hn::Sub(f3, f2)));
    const VI32 left = hn::Sub(hn::Sub(hn::Set(di, 1 << kCubicBits), before), hn::Add(right, after));
    return {{before, left, right, after}};
}

/// resampledCount(): 16 / (blur + 1) by comparisons would need 7 of them; a table is one gather.
struct CountTable {
    uint32_t of[129];
};
constexpr CountTable makeCountTable() {
    CountTable table{};
    for (int blur = 0; blur <= 128; ++blur) {
        table.of[blur] = uint32_t(resampledCount(blur));
    }
    return table;
}
alignas(64) constexpr CountTable kCountTable = makeCountTable();

HWY_INLINE V32 resampledCounts(VI32 fx, VI32 fy) {
    const DI32 di;
    const VI32 one = hn::Set(di, 256);
    const VI32 blur = hn::Add(hn::Mul(fx, hn::Sub(one, fx)), hn::Mul(fy, hn::Sub(one, fy)));
    return hn::GatherIndex(D32(), kCountTable.of, hn::ShiftRight<8>(blur));
}

/// Compact normals as vectors: see similarNormals().
struct Normals {
    VI32 x, y, z, square;
};
HWY_INLINE Normals decodeNormals(V32 packed) {
    const DI32 di;
    const VI32 n = asSigned(packed);
    const VI32 zero = hn::Zero(di);
    VI32 x = hn::ShiftRight<24>(hn::ShiftLeft<24>(n));
    VI32 y = hn::ShiftRight<24>(hn::ShiftLeft<16>(n));
    const VI32 z = hn::Sub(hn::Sub(hn::Set(di, 127), hn::Abs(x)), hn::Abs(y));
    const VI32 fold = hn::Max(hn::Neg(z), zero);
    x = hn::Add(x, hn::IfThenElse(hn::Lt(x, zero), fold, hn::Neg(fold)));
    y = hn::Add(y, hn::IfThenElse(hn::Lt(y, zero), fold, hn::Neg(fold)));
    const VI32 square = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
    return {x, y, z, square};
}
HWY_INLINE Mask32 differentNormals(const Normals& p, const Normals& q) {
    const DI32 di;
    const VI32 dot = hn::Add(hn::Add(hn::Mul(p.x, q.x), hn::Mul(p.y, q.y)), hn::Mul(p.z, q.z));
    const VI32 eighth = hn::ShiftRight<3>(dot);
    const VI32 bound =
        hn::Mul(hn::ShiftRight<6>(hn::Mul(p.square, hn::Set(di, 5))), hn::ShiftRight<3>(q.square));
    const auto far =
        hn::Or(hn::Not(hn::Gt(dot, hn::Zero(di))), hn::Lt(hn::Mul(eighth, eighth), bound));
    return hn::RebindMask(D32(), far);
}

}  // namespace HWY_NAMESPACE
}  // namespace still::taa
HWY_AFTER_NAMESPACE();
