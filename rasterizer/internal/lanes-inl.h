// What kernels of several stages share. Included once per target by each file that compiles
// kernels.

HWY_BEFORE_NAMESPACE();
namespace still::internal {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// floor(v + 0.5) as integers, as roundToInt().
template <class D, class V = hn::Vec<D>>
hn::Vec<hn::RebindToSigned<D>> roundLanes(D d, V v) {
    return hn::ConvertTo(hn::RebindToSigned<D>(), hn::Floor(hn::Add(v, hn::Set(d, 0.5f))));
}

// Quotients and roots are rounded once, as IEEE wants it. 32-bit NEON has neither of both, and
// Highway estimates them there: lane by lane the processor has them after all. Doubles it has not
// even as lanes.
#if HWY_ARCH_ARM_V7

template <class V>
HWY_INLINE V div(V a, V b) {
    const hn::DFromV<V> d;
    HWY_ALIGN float x[hn::MaxLanes(d)], y[hn::MaxLanes(d)];
    hn::Store(a, d, x);
    hn::Store(b, d, y);
    for (size_t i = 0; i < hn::MaxLanes(d); ++i) {
        x[i] /= y[i];
    }
    return hn::Load(d, x);
}
template <class V>
HWY_INLINE V squareRoot(V v) {
    const hn::DFromV<V> d;
    HWY_ALIGN float x[hn::MaxLanes(d)];
    hn::Store(v, d, x);
    for (float& lane : x) {
        lane = std::sqrt(lane);
    }
    return hn::Load(d, x);
}
/// Pairs of floats as one lane each, to be moved about.
template <class D>
using PairsOf = hn::Repartition<uint64_t, D>;

#else

template <class V>
HWY_INLINE V div(V a, V b) {
    return hn::Div(a, b);
}
template <class V>
HWY_INLINE V squareRoot(V v) {
    return hn::Sqrt(v);
}
template <class D>
using PairsOf = hn::RepartitionToWide<D>;

#endif

// Lanes of double, for what float cannot hold. Highway 1.0.3 has no arithmetic on them for
// WebAssembly and 32-bit NEON, although the processors have it: there they stand for themselves.
#if HWY_HAVE_FLOAT64

template <class D>
using DoubleVec = hn::Vec<D>;

template <class D>
HWY_INLINE DoubleVec<D> doubles(D d, double v) {
    return hn::Set(d, v);
}
/// From as many lanes of int32_t or float, without rounding.
template <class D, class V>
HWY_INLINE DoubleVec<D> toDoubles(D d, V v) {
    return hn::PromoteTo(d, v);
}
/// Rounded to the nearest float.
template <class DF, class V>
HWY_INLINE hn::Vec<DF> toFloats(DF d, V v) {
    return hn::DemoteTo(d, v);
}
template <class V>
HWY_INLINE V add(V a, V b) {
    return hn::Add(a, b);
}
template <class V>
HWY_INLINE V sub(V a, V b) {
    return hn::Sub(a, b);
}
template <class V>
HWY_INLINE V mul(V a, V b) {
    return hn::Mul(a, b);
}

#elif HWY_TARGET == HWY_WASM

struct WasmDoubles {
    v128_t raw;
};
template <class D>
using DoubleVec = WasmDoubles;

template <class D>
HWY_INLINE WasmDoubles doubles(D, double v) {
    return {wasm_f64x2_splat(v)};
}
template <class D>
HWY_INLINE WasmDoubles toDoubles(D, hn::Vec128<int32_t, 2> v) {
    return {wasm_f64x2_convert_low_i32x4(v.raw)};
}
template <class D>
HWY_INLINE WasmDoubles toDoubles(D, hn::Vec128<float, 2> v) {
    return {wasm_f64x2_promote_low_f32x4(v.raw)};
}
template <class DF>
HWY_INLINE hn::Vec<DF> toFloats(DF, WasmDoubles v) {
    return hn::Vec<DF>{wasm_f32x4_demote_f64x2_zero(v.raw)};
}
HWY_INLINE WasmDoubles add(WasmDoubles a, WasmDoubles b) {
    return {wasm_f64x2_add(a.raw, b.raw)};
}
HWY_INLINE WasmDoubles sub(WasmDoubles a, WasmDoubles b) {
    return {wasm_f64x2_sub(a.raw, b.raw)};
}
HWY_INLINE WasmDoubles mul(WasmDoubles a, WasmDoubles b) {
    return {wasm_f64x2_mul(a.raw, b.raw)};
}
HWY_INLINE WasmDoubles div(WasmDoubles a, WasmDoubles b) {
    return {wasm_f64x2_div(a.raw, b.raw)};
}

#elif HWY_ARCH_ARM_V7

struct TwoDoubles {
    double lane[2];
};
template <class D>
using DoubleVec = TwoDoubles;

template <class D>
HWY_INLINE TwoDoubles doubles(D, double v) {
    return {{v, v}};
}
/// From two lanes of int32_t or float.
template <class D, class V>
HWY_INLINE TwoDoubles toDoubles(D, V v) {
    return {{double(hn::GetLane(v)), double(hn::ExtractLane(v, 1))}};
}
template <class DF>
HWY_INLINE hn::Vec<DF> toFloats(DF d, TwoDoubles v) {
    HWY_ALIGN const float lanes[2] = {float(v.lane[0]), float(v.lane[1])};
    return hn::Load(d, lanes);
}
HWY_INLINE TwoDoubles add(TwoDoubles a, TwoDoubles b) {
    return {{a.lane[0] + b.lane[0], a.lane[1] + b.lane[1]}};
}
HWY_INLINE TwoDoubles sub(TwoDoubles a, TwoDoubles b) {
    return {{a.lane[0] - b.lane[0], a.lane[1] - b.lane[1]}};
}
HWY_INLINE TwoDoubles mul(TwoDoubles a, TwoDoubles b) {
    return {{a.lane[0] * b.lane[0], a.lane[1] * b.lane[1]}};
}
HWY_INLINE TwoDoubles div(TwoDoubles a, TwoDoubles b) {
    return {{a.lane[0] / b.lane[0], a.lane[1] / b.lane[1]}};
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace still::internal
HWY_AFTER_NAMESPACE();
