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

/// Compact normals as vectors: decodeNormal().
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
/// similarlyLit()
HWY_INLINE Mask32 litAlike(const Normals& p, const Normals& q) {
    const DI32 di;
    const VI32 dot = hn::Add(hn::Add(hn::Mul(p.x, q.x), hn::Mul(p.y, q.y)), hn::Mul(p.z, q.z));
    const VI32 eighth = hn::ShiftRight<3>(dot);
    const VI32 bound =
        hn::Mul(hn::ShiftRight<8>(hn::Mul(p.square, hn::Set(di, 31))), hn::ShiftRight<3>(q.square));
    return hn::RebindMask(
        D32(), hn::And(hn::Gt(dot, hn::Zero(di)), hn::Not(hn::Lt(hn::Mul(eighth, eighth), bound))));
}

// Halves of packed words.
HWY_INLINE V32 low(V32 v) {
    return hn::And(v, hn::Set(D32(), 0xFFFF));
}
HWY_INLINE V32 high(V32 v) {
    return hn::ShiftRight<16>(v);
}
HWY_INLINE VI32 lowSigned(V32 v) {
    return hn::ShiftRight<16>(hn::ShiftLeft<16>(asSigned(v)));
}
HWY_INLINE VI32 highSigned(V32 v) {
    return hn::ShiftRight<16>(asSigned(v));
}
HWY_INLINE V32 pack(V32 low_half, V32 high_half) {
    return hn::Or(low_half, hn::ShiftLeft<16>(high_half));
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
/// Both coordinates of a pixel lie in the image.
HWY_INLINE Mask32 within(VI32 v, int size) {
    const DI32 di;
    return maskOf(hn::And(atLeast(v, hn::Zero(di)), hn::Lt(v, hn::Set(di, size))));
}
HWY_INLINE V32 loadMotion(const Motion* p) {
    static_assert(sizeof(Motion) == sizeof(uint32_t));
    const hn::Repartition<uint8_t, D32> bytes;
    return hn::BitCast(D32(), hn::LoadU(bytes, reinterpret_cast<const uint8_t*>(p)));
}

}  // namespace HWY_NAMESPACE
}  // namespace still::taa
HWY_AFTER_NAMESPACE();
