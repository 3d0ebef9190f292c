// The arithmetic of lab_rules.h in lanes: 32 bits, one pixel each. Included once per target by
// lab_simd.cpp. A function here has the name it has there.

HWY_BEFORE_NAMESPACE();
namespace still::lab {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr int kMaxLanes = 16;
using D32 = hn::CappedTag<uint32_t, kMaxLanes>;
using DI32 = hn::RebindToSigned<D32>;
using D16 = hn::Rebind<uint16_t, D32>;
using D8 = hn::Rebind<uint8_t, D32>;
using V32 = hn::Vec<D32>;
using VI32 = hn::Vec<DI32>;
using MaskI = hn::Mask<DI32>;

HWY_INLINE V32 asUnsigned(VI32 v) {
    return hn::BitCast(D32(), v);
}
HWY_INLINE VI32 asSigned(V32 v) {
    return hn::BitCast(DI32(), v);
}
HWY_INLINE VI32 all(int32_t v) {
    return hn::Set(DI32(), v);
}
HWY_INLINE VI32 zero() {
    return hn::Zero(DI32());
}
HWY_INLINE MaskI noLanes() {
    return hn::MaskFromVec(zero());
}
HWY_INLINE bool any(MaskI mask) {
    return !hn::AllFalse(DI32(), mask);
}
HWY_INLINE VI32 choose(MaskI mask, VI32 yes, VI32 no) {
    return hn::IfThenElse(mask, yes, no);
}
/// 1 in the mask's lanes, 0 elsewhere.
HWY_INLINE VI32 oneWhere(MaskI mask) {
    return hn::IfThenElseZero(mask, all(1));
}

HWY_INLINE VI32 load(const int32_t* p) {
    return hn::LoadU(DI32(), p);
}
HWY_INLINE VI32 load(const uint32_t* p) {
    return asSigned(hn::LoadU(D32(), p));
}
HWY_INLINE VI32 load(const uint16_t* p) {
    return asSigned(hn::PromoteTo(D32(), hn::LoadU(D16(), p)));
}
HWY_INLINE VI32 load(const uint8_t* p) {
    return asSigned(hn::PromoteTo(D32(), hn::LoadU(D8(), p)));
}
/// Both components in a lane: x in the low half.
HWY_INLINE VI32 load(const Motion* p) {
    static_assert(sizeof(Motion) == sizeof(uint32_t));
    const hn::Repartition<uint8_t, D32> bytes;
    return hn::BitCast(DI32(), hn::LoadU(bytes, reinterpret_cast<const uint8_t*>(p)));
}
HWY_INLINE VI32 motionX(VI32 motion) {
    return hn::ShiftRight<16>(hn::ShiftLeft<16>(motion));
}
HWY_INLINE VI32 motionY(VI32 motion) {
    return hn::ShiftRight<16>(motion);
}

HWY_INLINE void store(VI32 v, int32_t* p) {
    hn::StoreU(v, DI32(), p);
}
HWY_INLINE void store(VI32 v, uint32_t* p) {
    hn::StoreU(asUnsigned(v), D32(), p);
}
/// Keeps the low 16 bits.
HWY_INLINE void store(VI32 v, uint16_t* p) {
    const hn::RepartitionToNarrow<D32> twice;
    hn::StoreU(hn::LowerHalf(D16(), hn::ConcatEven(twice, hn::Zero(twice), hn::BitCast(twice, v))),
               D16(), p);
}
/// Values must be 0 … 255.
HWY_INLINE void store(VI32 v, uint8_t* p) {
    hn::StoreU(hn::DemoteTo(D8(), v), D8(), p);
}
HWY_INLINE void store(VI32 v, Motion* p) {
    const hn::Repartition<uint8_t, D32> bytes;
    hn::StoreU(hn::BitCast(bytes, v), bytes, reinterpret_cast<uint8_t*>(p));
}

template <int kShift>
HWY_INLINE VI32 roundShift(VI32 v) {
    return hn::ShiftRight<kShift>(hn::Add(v, all(1 << (kShift - 1))));
}
template <int kShift>
HWY_INLINE VI32 shiftUnsigned(VI32 v) {
    return asSigned(hn::ShiftRight<kShift>(asUnsigned(v)));
}
HWY_INLINE VI32 clamped(VI32 v, VI32 low, VI32 high) {
    return hn::Min(hn::Max(v, low), high);
}
HWY_INLINE VI32 minUnsigned(VI32 a, VI32 b) {
    return asSigned(hn::Min(asUnsigned(a), asUnsigned(b)));
}

template <int kBits>
HWY_INLINE VI32 quotient(VI32 numerator, VI32 denominator) {
    VI32 rest = numerator, result = zero();
    for (int bit = 0; bit < kBits; ++bit) {
        rest = hn::Add(rest, rest);
        const MaskI small = hn::Lt(rest, denominator);
        rest = hn::Sub(rest, hn::IfThenZeroElse(small, denominator));
        result = hn::Add(hn::Add(result, result), hn::IfThenZeroElse(small, all(1)));
    }
    return result;
}

HWY_INLINE VI32 highProduct(VI32 a, VI32 b) {
    const D32 d;
    const hn::RepartitionToWide<D32> wide;
    const auto even = hn::MulEven(asUnsigned(a), asUnsigned(b));
    const auto odd = hn::MulEven(hn::BitCast(d, hn::ShiftRight<32>(hn::BitCast(wide, a))),
                                 hn::BitCast(d, hn::ShiftRight<32>(hn::BitCast(wide, b))));
    return asSigned(hn::OddEven(hn::BitCast(d, odd), hn::BitCast(d, hn::ShiftRight<32>(even))));
}

/// table[index]
HWY_INLINE VI32 lookUp(const uint32_t* table, VI32 index) {
    return asSigned(hn::GatherIndex(D32(), table, index));
}
/// The same, where all lanes often agree.
HWY_INLINE VI32 lookUpAlike(const uint32_t* table, VI32 index) {
    const int32_t first = hn::GetLane(index);
    return hn::AllTrue(DI32(), hn::Eq(index, all(first))) ? all(int32_t(table[first]))
                                                          : lookUp(table, index);
}

HWY_INLINE VI32 rootOf(VI32 n) {
    const VI32 limit = all(RootTable::kSize / 64 - 1);
    VI32 index = n, scale = all(1);
    VI32 shifted = shiftUnsigned<6>(n);
    for (int level = 1; level <= 4; ++level) {
        const MaskI big = hn::Gt(shifted, limit);
        index = choose(big, shifted, index);
        scale = choose(big, all(1 << (3 * level)), scale);
        shifted = shiftUnsigned<6>(shifted);
    }
    return hn::Mul(lookUp(kRoots.of, index), scale);
}

/// Three channels of a vector of pixels.
struct Colours {
    VI32 v[3];
};

HWY_INLINE VI32 largest(const Colours& c) {
    return hn::Max(hn::Max(c.v[0], c.v[1]), c.v[2]);
}

template <int kBits>
HWY_INLINE VI32 interpolated(const uint32_t* table, VI32 index) {
    const VI32 whole = hn::ShiftRight<kBits>(index);
    const VI32 first = lookUp(table, whole);
    const VI32 step = hn::Sub(lookUp(table + 1, whole), first);
    const VI32 part = hn::Mul(step, hn::And(index, all((1 << kBits) - 1)));
    return hn::Add(first, hn::ShiftRight<kBits>(part));
}

STILL_LAB_PHASE Colours toneIn(const Colours& c) {
    const VI32 scale = interpolated<6>(kToneIn.of, largest(c));
    Colours t;
    for (int k = 0; k < 3; ++k) {
        t.v[k] = shiftUnsigned<12>(hn::Mul(c.v[k], scale));
    }
    return t;
}

STILL_LAB_PHASE Colours toneOut(const Colours& c) {
    Colours t;
    for (int k = 0; k < 3; ++k) {
        t.v[k] = hn::Min(c.v[k], all(kToneMax));
    }
    const VI32 scale = interpolated<5>(kToneOut.of, largest(t));
    for (int k = 0; k < 3; ++k) {
        t.v[k] = hn::Min(roundShift<15>(hn::Mul(t.v[k], scale)), all(65535));
    }
    return t;
}

HWY_INLINE VI32 lumaOf(const Colours& c) {
    return roundShift<2>(hn::Add(hn::Add(c.v[0], c.v[2]), hn::Add(c.v[1], c.v[1])));
}

HWY_INLINE Colours toYcocg(const Colours& c) {
    const VI32 green = hn::Add(c.v[1], c.v[1]), magenta = hn::Add(c.v[0], c.v[2]);
    return {{roundShift<2>(hn::Add(magenta, green)), roundShift<1>(hn::Sub(c.v[0], c.v[2])),
             roundShift<2>(hn::Sub(green, magenta))}};
}

HWY_INLINE Colours fromYcocg(const Colours& c) {
    const VI32 magenta = hn::Sub(c.v[0], c.v[2]);
    return {{hn::Add(magenta, c.v[1]), hn::Add(c.v[0], c.v[2]), hn::Sub(magenta, c.v[1])}};
}

HWY_INLINE Colours toSpace(const TaaPolicy& p, const Colours& c) {
    return p.space == ColourSpace::ycocg ? toYcocg(c) : c;
}

HWY_INLINE Colours fromSpace(const TaaPolicy& p, const Colours& c) {
    Colours rgb = p.space == ColourSpace::ycocg ? fromYcocg(c) : c;
    for (VI32& v : rgb.v) {
        v = clamped(v, zero(), all(kWorkingMax));
    }
    return rgb;
}

HWY_INLINE Colours rounded(const Colours& colour_w24) {
    return {{roundShift<kFractionBits>(colour_w24.v[0]), roundShift<kFractionBits>(colour_w24.v[1]),
             roundShift<kFractionBits>(colour_w24.v[2])}};
}

struct Cubic {
    VI32 w[4];
};
HWY_INLINE Cubic cubicWeights(VI32 f) {
    const VI32 f1 = hn::ShiftLeft<16>(f), ff = hn::Mul(f, f);
    const VI32 f2 = hn::ShiftLeft<8>(ff), f3 = hn::Mul(ff, f);
    const VI32 before = roundShift<15>(hn::Sub(hn::Add(f2, f2), hn::Add(f1, f3)));
    const VI32 three_f3 = hn::Add(hn::Add(f3, f3), f3);
    const VI32 right = roundShift<15>(hn::Sub(hn::Add(f1, hn::ShiftLeft<2>(f2)), three_f3));
    const VI32 after = roundShift<15>(hn::Sub(f3, f2));
    const VI32 left = hn::Sub(hn::Sub(all(1 << kCubicBits), before), hn::Add(right, after));
    return {{before, left, right, after}};
}

HWY_INLINE VI32 cornerGain(const Cubic& x, const Cubic& y) {
    const VI32 e = hn::Mul(hn::Add(x.w[0], x.w[3]), hn::Add(y.w[0], y.w[3]));
    const VI32 square = hn::Mul(e, e);
    return roundShift<4>(
        hn::Add(e, hn::Add(hn::ShiftRight<20>(square), hn::ShiftRight<26>(square))));
}

struct Vectors {
    VI32 x, y, z;
};
HWY_INLINE Vectors decodeNormal(VI32 n) {
    VI32 x = hn::ShiftRight<24>(hn::ShiftLeft<24>(n));
    VI32 y = hn::ShiftRight<24>(hn::ShiftLeft<16>(n));
    const VI32 z = hn::Sub(hn::Sub(all(127), hn::Abs(x)), hn::Abs(y));
    const VI32 fold = hn::Max(hn::Neg(z), zero());
    x = hn::Add(x, choose(hn::Lt(x, zero()), fold, hn::Neg(fold)));
    y = hn::Add(y, choose(hn::Lt(y, zero()), fold, hn::Neg(fold)));
    return {x, y, z};
}
HWY_INLINE VI32 dot(const Vectors& a, const Vectors& b) {
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE MaskI differentNormals(VI32 a, VI32 b, uint32_t square_q15) {
    const Vectors p = decodeNormal(a), q = decodeNormal(b);
    const VI32 cosine = dot(p, q);
    const VI32 scaled = shiftUnsigned<15>(hn::Mul(dot(p, p), all(int32_t(square_q15))));
    return hn::Or(hn::Lt(cosine, all(1)),
                  hn::Lt(hn::Mul(cosine, cosine), hn::Mul(scaled, dot(q, q))));
}

HWY_INLINE MaskI differentDepths(VI32 a, VI32 b, int32_t limit_q15) {
    const VI32 far = hn::Min(a, b), near = hn::Max(a, b);
    const VI32 exponents = hn::Sub(hn::ShiftRight<11>(near), hn::ShiftRight<11>(far));
    const VI32 one = all(2048), fraction = all(2047);
    const VI32 mantissa = hn::Add(one, hn::And(near, fraction));
    const VI32 scaled = choose(hn::Gt(exponents, zero()), hn::Add(mantissa, mantissa), mantissa);
    const VI32 difference = hn::Sub(scaled, hn::Add(one, hn::And(far, fraction)));
    return hn::Or(hn::Gt(exponents, all(1)),
                  hn::Gt(hn::ShiftLeft<15>(difference), hn::Mul(scaled, all(limit_q15))));
}

HWY_INLINE MaskI differentMotions(VI32 dx, VI32 dy, int32_t limit_fx8) {
    const VI32 x = hn::Min(hn::Abs(dx), all(32767)), y = hn::Min(hn::Abs(dy), all(32767));
    return hn::Gt(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), all(limit_fx8 * limit_fx8));
}

HWY_INLINE MaskI differentLumas(VI32 a, VI32 b, int32_t limit_q15) {
    const VI32 high = hn::Max(a, b);
    return hn::Gt(hn::ShiftLeft<15>(hn::Sub(high, hn::Min(a, b))), hn::Mul(high, all(limit_q15)));
}

HWY_INLINE VI32 speedOf(VI32 x, VI32 y) {
    return shiftUnsigned<3>(rootOf(hn::Add(hn::Mul(x, x), hn::Mul(y, y))));
}

HWY_INLINE VI32 blended(VI32 history_w24, VI32 sample_w24, VI32 alpha_q15) {
    const VI32 d = hn::Sub(sample_w24, history_w24);
    const VI32 low = hn::ShiftRight<8>(hn::Mul(hn::And(d, all(255)), alpha_q15));
    const VI32 product = hn::Add(hn::Mul(hn::ShiftRight<8>(d), alpha_q15), low);
    return hn::Add(history_w24, roundShift<7>(product));
}

/// What extendedMean() needs of the count, for all channels.
struct Growth {
    VI32 count, grown, half, reciprocal;
};
HWY_INLINE Growth growthOf(VI32 count) {
    const VI32 grown = hn::Add(count, all(1));
    return {count, grown, hn::ShiftRight<1>(grown), lookUpAlike(kReciprocals.of, grown)};
}

HWY_INLINE VI32 extendedMean(VI32 history_w24, VI32 sample_w24, const Growth& g,
                             bool whole_samples) {
    VI32 sum = hn::Mul(history_w24, g.count);
    sum = whole_samples ? hn::ShiftLeft<8>(shiftUnsigned<8>(hn::Add(sum, all(128)))) : sum;
    const VI32 total = hn::Add(sum, sample_w24);
    const VI32 top = shiftUnsigned<8>(total);
    const VI32 high = highProduct(top, g.reciprocal);
    const VI32 rest = hn::Sub(top, hn::Mul(high, g.grown));
    const VI32 low = hn::Add(hn::Add(hn::ShiftLeft<8>(rest), hn::And(total, all(255))), g.half);
    return hn::Add(hn::ShiftLeft<8>(high), highProduct(low, g.reciprocal));
}

}  // namespace HWY_NAMESPACE
}  // namespace still::lab
HWY_AFTER_NAMESPACE();
