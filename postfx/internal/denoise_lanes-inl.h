// What the denoiser's kernels in lanes share: 32-bit lanes, one pixel each. Included once per
// target by denoise_simd.cpp.

HWY_BEFORE_NAMESPACE();
namespace still::denoising {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using internal::HWY_NAMESPACE::div;
using internal::HWY_NAMESPACE::squareRoot;

constexpr int kMostLanes = 16;
using DF = hn::CappedTag<float, kMostLanes>;
using DI = hn::RebindToSigned<DF>;
using D16 = hn::Rebind<uint16_t, DF>;
using D8 = hn::Rebind<uint8_t, DF>;
using VF = hn::Vec<DF>;
using VI = hn::Vec<DI>;
using MF = hn::Mask<DF>;

HWY_INLINE int laneCount() {
    return int(hn::Lanes(DF()));
}
HWY_INLINE VF set(float v) {
    return hn::Set(DF(), v);
}
HWY_INLINE VI setInt(int v) {
    return hn::Set(DI(), v);
}
HWY_INLINE VF load(const float* p) {
    return hn::LoadU(DF(), p);
}
HWY_INLINE VF loadDepth(const uint32_t* p) {
    return hn::BitCast(DF(), hn::LoadU(hn::RebindToUnsigned<DF>(), p));
}
HWY_INLINE VI loadInt(const uint16_t* p) {
    return hn::PromoteTo(DI(), hn::LoadU(D16(), p));
}
HWY_INLINE VF loadLight(const uint16_t* p) {
    return hn::ConvertTo(DF(), loadInt(p));
}
HWY_INLINE VF loadByte(const uint8_t* p) {
    return hn::ConvertTo(DF(), hn::PromoteTo(DI(), hn::LoadU(D8(), p)));
}
HWY_INLINE void store(VF v, float* p) {
    hn::StoreU(v, DF(), p);
}
/// toPlane()
HWY_INLINE void storeLight(VF v, uint16_t* p) {
    const VI whole = hn::ConvertTo(DI(), hn::Add(hn::Min(v, set(65535.0f)), set(0.5f)));
    hn::StoreU(hn::DemoteTo(D16(), whole), D16(), p);
}
/// Of 0 … 255, rounded half up.
HWY_INLINE void storeByte(VF v, uint8_t* p) {
    const VI whole = hn::ConvertTo(DI(), hn::Add(v, set(0.5f)));
    hn::StoreU(hn::DemoteTo(D8(), whole), D8(), p);
}
HWY_INLINE VF multiplyAdd(VF sum, VF a, VF b) {
    return hn::Add(sum, hn::Mul(a, b));
}
HWY_INLINE MF noLanes() {
    return hn::Ne(hn::Zero(DF()), hn::Zero(DF()));
}
HWY_INLINE bool any(MF m) {
    return !hn::AllFalse(DF(), m);
}
HWY_INLINE VF luminanceLanes(VF red, VF green, VF blue) {
    return hn::Add(hn::Add(hn::Mul(set(0.2126f), red), hn::Mul(set(0.7152f), green)),
                   hn::Mul(set(0.0722f), blue));
}
/// fallOff()
HWY_INLINE VF fallOffLanes(VF x) {
    const VF rest = hn::Max(hn::Zero(DF()), hn::Sub(set(1.0f), x));
    return hn::Mul(rest, rest);
}
/// Lanes of pixels from `x` on that lie in low … high − 1.
HWY_INLINE MF lanesWithin(int x, int low, int high) {
    const VI column = hn::Add(hn::Iota(DI(), 0), setInt(x));
    const auto in = hn::And(hn::Gt(column, setInt(low - 1)), hn::Lt(column, setInt(high)));
    return hn::RebindMask(DF(), in);
}

}  // namespace HWY_NAMESPACE
}  // namespace still::denoising
HWY_AFTER_NAMESPACE();
