// Output pixels in lanes: lane i holds one of the few output pixels whose centres lie in the i-th
// of a group of the frame's pixels, so that samples are loaded as the gather loads them. Included
// once per target by taa_simd.cpp.

HWY_BEFORE_NAMESPACE();
namespace still::taa {
namespace HWY_NAMESPACE {

/// The output pixels of a tile's columns, by their number within the frame's pixel.
struct OutputColumns {
    static constexpr int kPad = kTileSize + kMaxHalves;
    alignas(64) int16_t offset[kMaxUpscale][kPad];  ///< from its centre, 1/256 pixel of the frame
    alignas(64) int16_t used[kMaxUpscale][kPad];    ///< −1: there is such an output pixel; else 0
    int first[kPad];                                ///< first output pixel
    int most = 0;                                   ///< in any pixel

    OutputColumns(const upscale::Job& job, const TileRect& tile) {
        for (int i = 0; i < kPad; ++i) {
            const int pixel = std::min(tile.x0 + i, tile.x1 - 1);
            first[i] = job.x.firstOf(pixel);
            const int count = tile.x0 + i < tile.x1 ? job.x.firstOf(pixel + 1) - first[i] : 0;
            most = std::max(most, count);
            for (int p = 0; p < kMaxUpscale; ++p) {
                used[p][i] = p < count ? int16_t(-1) : int16_t(0);
                offset[p][i] = p < count
                                   ? int16_t(job.x.toFrame(job.x.offsetOf(first[i] + p, pixel)))
                                   : int16_t(0);
            }
        }
    }
};

/// What an axis has to say about samples near the places: see upscale_rules.h.
struct AxisSite {
    VS number;  ///< the sample's column or row
    VS place;   ///< from the output pixel's centre, 1/64 output pixel
    VS kernel;  ///< axisKernel()
    VS tent;    ///< 256 at the centre, 0 a sample away
};
HWY_INLINE AxisSite siteAt(VS number, VS distance_fx8, int ratio_fx8) {
    AxisSite site;
    const VS e = hn::MulHigh(hn::ShiftLeft<6>(distance_fx8), set(4 * ratio_fx8));
    const VS scaled = hn::Add(hn::Mul(hn::Sub(set(205), hn::Abs(e)), set(53)), set(256));
    const VS place = hn::ShiftRight<2>(e);
    site.number = number;
    site.place = hn::Max(hn::Min(place, set(upscale::kFarthest)), set(-upscale::kFarthest));
    site.kernel = hn::Min(hn::Max(hn::ShiftRight<9>(scaled), zero()), set(kAxisWeight));
    site.tent = hn::Sub(set(256), hn::Abs(distance_fx8));
    return site;
}
/// The nearest sample to a place at `whole` and `part_fx8`, −512 … 511.
HWY_INLINE AxisSite nearestSite(VS whole, VS part_fx8, int ratio_fx8) {
    const VS rounded = hn::Add(part_fx8, set(128));
    return siteAt(hn::Add(whole, hn::ShiftRight<8>(rounded)),
                  hn::Sub(set(128), hn::And(rounded, set(255))), ratio_fx8);
}
/// The one before (0) or after it (1).
HWY_INLINE AxisSite besideSite(VS whole, VS part_fx8, int which, int ratio_fx8) {
    return siteAt(hn::Add(whole, hn::Add(hn::ShiftRight<8>(part_fx8), set(which))),
                  hn::Sub(set(which * 256), hn::And(part_fx8, set(255))), ratio_fx8);
}

}  // namespace HWY_NAMESPACE
}  // namespace still::taa
HWY_AFTER_NAMESPACE();
