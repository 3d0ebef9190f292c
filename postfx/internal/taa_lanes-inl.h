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

HWY_INLINE hn::Mask<DI32> atLeast(VI32 a, VI32 b) {
    return hn::Not(hn::Lt(a, b));
}
HWY_INLINE hn::Mask<DI32> atMost(VI32 a, VI32 b) {
    return hn::Not(hn::Gt(a, b));
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
                               ? hn::Set(d, kReciprocals[size_t(hn::GetLane(grown))])
                               : hn::GatherIndex(d, kReciprocals.data(), grown);
    const VI32 offset = hn::Add(hn::ShiftRight<1>(grown), hn::Mul(grown, hn::Set(di, kBias)));
    return {grown, offset, reciprocal};
}

template <class V>
HWY_INLINE V highProduct(V a, V b) {
    const hn::DFromV<V> d;
    const hn::RepartitionToWide<decltype(d)> dw;
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

HWY_INLINE Mask32 maskOf(hn::Mask<DI32> m) {
    return hn::RebindMask(D32(), m);
}
HWY_INLINE hn::Mask<DI32> signedMask(Mask32 m) {
    return hn::RebindMask(DI32(), m);
}
/// Lanes of the group that are pixels of the tile.
HWY_INLINE Mask32 lanesBefore(int end) {
    const DI32 di;
    return maskOf(hn::Lt(hn::Iota(di, 0), hn::Set(di, end)));
}
HWY_INLINE V32 choose(Mask32 mask, V32 yes, V32 no) {
    return hn::IfThenElse(mask, yes, no);
}
HWY_INLINE VI32 choose(Mask32 mask, VI32 yes, VI32 no) {
    return hn::IfThenElse(signedMask(mask), yes, no);
}
}  // namespace HWY_NAMESPACE
}  // namespace still::taa
HWY_AFTER_NAMESPACE();
