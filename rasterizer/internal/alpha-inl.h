// Alpha test and stochastic transparency, one pixel per lane; see alphaPasses() in
// shade_reference.cpp for the truth. Included once per target by kernels_simd.cpp.

HWY_BEFORE_NAMESPACE();
namespace still::internal {
namespace HWY_NAMESPACE {
namespace shading {
namespace hn = hwy::HWY_NAMESPACE;

/// Which of the tile's pixels (x, y) have a sample of the triangle.
HWY_INLINE FMask alphaMask(const TileContext& tile, const ShadeTriangle& triangle, IVec x, IVec y) {
    const Surface& s = tile.frame->surfaces[triangle.surface];
    FVec alpha = splat(s.material->opacity);
    if (s.alpha != nullptr) {
        const LaneTriangles<true> t{&triangle};
        const LaneBarycentrics p =
            barycentrics(t, hn::ConvertTo(FTag(), x), hn::ConvertTo(FTag(), y));
        LaneTexture c = textureCoordinates(t, p, s);
        if (s.height != nullptr) {
            c = displacedCoordinates(*tile.frame, t, p, s, c);
        }
        alpha = hn::Mul(alpha, sampleAlpha(*s.alpha, c, s.mip_bias_fx8));
    }
    if (s.material->alpha_mode == AlphaMode::test) {
        return hn::Ge(alpha, splat(0.5f));
    }
    const UTag du;
    const UVec px = hn::BitCast(du, hn::Add(x, splatInt(tile.x0)));
    const UVec py = hn::BitCast(du, hn::Add(y, splatInt(tile.y0)));
    UVec h = hn::Xor(hn::Xor(hn::Mul(px, hn::Set(du, kHashX)), hn::Mul(py, hn::Set(du, kHashY))),
                     hn::Set(du, uint32_t(triangle.surface) * kHashSurface));
    h = hn::Xor(h, hn::ShiftRight<15>(h));
    h = hn::Mul(h, hn::Set(du, kHashMix));
    h = hn::Xor(h, hn::ShiftRight<12>(h));
    h = hn::Add(h, hn::Set(du, tile.frame->view->sample * kGoldenRatio));
    const FVec draw = hn::ConvertTo(FTag(), hn::BitCast(ITag(), hn::ShiftRight<16>(h)));
    return hn::Lt(draw, hn::Mul(alpha, splat(65536.0f)));
}

}  // namespace shading
}  // namespace HWY_NAMESPACE
}  // namespace still::internal
HWY_AFTER_NAMESPACE();
