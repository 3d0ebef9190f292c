// What kernels of several stages share. Included once per target by each file that compiles kernels.

HWY_BEFORE_NAMESPACE();
namespace still::internal {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// floor(v + 0.5) as integers, as roundToInt().
template <class D, class V = hn::Vec<D>>
hn::Vec<hn::RebindToSigned<D>> roundLanes(D d, V v) {
    return hn::ConvertTo(hn::RebindToSigned<D>(), hn::Floor(hn::Add(v, hn::Set(d, 0.5f))));
}

// Lanes of double, for what float cannot hold. Highway 1.0.3 has no arithmetic on them for
// WebAssembly, although that has it: there they stand for themselves.
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
template <class V>
HWY_INLINE V div(V a, V b) {
    return hn::Div(a, b);
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

#endif

}  // namespace HWY_NAMESPACE
}  // namespace still::internal
HWY_AFTER_NAMESPACE();
