// A row of a channel in lanes. Included once per target by sharpen_simd.cpp; 32-bit lanes, one
// pixel each.

HWY_BEFORE_NAMESPACE();
namespace still::sharpening {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D32 = hn::CappedTag<int32_t, 16>;
using D16 = hn::Rebind<uint16_t, D32>;
using D8 = hn::Rebind<uint8_t, D32>;
using V32 = hn::Vec<D32>;

HWY_INLINE V32 load16(const uint16_t* p) {
    return hn::PromoteTo(D32(), hn::LoadU(D16(), p));
}

/// roundShift()
template <int kShift>
HWY_INLINE V32 roundedShift(V32 v) {
    return hn::ShiftRight<kShift>(hn::Add(v, hn::Set(D32(), 1 << (kShift - 1))));
}

HWY_ATTR void sharpenRow(const Rows& rows, int width, int gain, uint16_t* out) {
    const D32 d;
    const V32 full = hn::Set(d, gain), full_257 = hn::Set(d, gain * 257);
    for (int x = 0; x < width; x += int(hn::Lanes(d))) {
        V32 own = full;
        if (rows.confidence != nullptr) {
            const V32 confidence = hn::PromoteTo(d, hn::LoadU(D8(), rows.confidence + x));
            own = roundedShift<16>(hn::Mul(confidence, full_257));
        }
        const V32 e = load16(rows.here + x);
        const V32 above = load16(rows.above + x), below = load16(rows.below + x);
        const V32 left = load16(rows.here + x - 1), right = load16(rows.here + x + 1);
        const V32 sum = hn::Add(hn::Add(above, below), hn::Add(left, right));
        const V32 push = hn::Mul(hn::Sub(hn::ShiftLeft<2>(e), sum), own);
        const V32 moved = hn::Add(e, roundedShift<kGainBits>(push));
        const V32 least = hn::Min(hn::Min(hn::Min(above, below), hn::Min(left, right)), e);
        const V32 most = hn::Max(hn::Max(hn::Max(above, below), hn::Max(left, right)), e);
        hn::StoreU(hn::DemoteTo(D16(), hn::Min(hn::Max(moved, least), most)), D16(), out + x);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace still::sharpening
HWY_AFTER_NAMESPACE();
