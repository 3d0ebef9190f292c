// Height maps, one pixel per lane; see parallax_reference.cpp for the truth.
// Included once per target by kernels_simd.cpp. Phases: slope of the ray → steps until every lane
// is below the ground → coordinates at the crossing.

HWY_BEFORE_NAMESPACE();
namespace still::internal {
namespace HWY_NAMESPACE {
namespace shading {
namespace hn = hwy::HWY_NAMESPACE;

/// Change of the texture coordinates along the ray from depth 0 to depth 1.
struct LaneRaySlope {
    FVec u, v;
};

template <bool kUniform>
HWY_INLINE LaneRaySlope raySlope(const FrameTables& frame, const LaneTriangles<kUniform>& t,
                                 const LaneBarycentrics& p, const Surface& s) {
    const InstanceSetup& instance = frame.instances[s.instance];
    const Vec3 n = worldNormal(t, p, instance);
    const Vec3 tangent = worldTangent(t, p, instance);
    const Vec3 bitangent = worldBitangent(t, instance, n, tangent);
    const Vec3 to_eye = towardsEye(*frame.view, worldPosition(t, p, instance));
    const FVec cosine = hn::Max(hn::Mul(dot3(n, to_eye), p.flip), splat(kParallaxMinCosine));
    const FVec scale = hn::Neg(div(splat(s.material->height_scale), cosine));
    return {hn::Mul(dot3(tangent, to_eye), scale), hn::Mul(dot3(bitangent, to_eye), scale)};
}

/// Precondition: the surface has a height map.
template <bool kUniform>
HWY_NOINLINE LaneTexture displacedCoordinates(const FrameTables& frame,
                                              const LaneTriangles<kUniform>& t,
                                              const LaneBarycentrics& p, const Surface& s,
                                              const LaneTexture& c) {
    const LaneRaySlope slope = raySlope(frame, t, p, s);
    const LaneMip mip = mipOf(c, s.height->levels, s.mip_bias_fx8);
    const FVec zero = hn::Zero(FTag());
    FVec gap_before = zero, depth = zero;
    FMask above = hn::Eq(zero, zero);  // lanes whose ray has not met the ground yet
    for (int i = 0; i <= kParallaxSteps && !hn::AllFalse(FTag(), above); ++i) {
        const FVec layer = splat(float(i) * kParallaxStep);
        const FVec height = sampleAlphaAt(*s.height, mip, hn::Add(c.u, hn::Mul(slope.u, layer)),
                                          hn::Add(c.v, hn::Mul(slope.v, layer)));
        const FVec gap = hn::Sub(hn::Sub(splat(1.0f), height), layer);
        const FVec back = div(gap, hn::Min(hn::Sub(gap, gap_before), splat(-kTiny)));
        const FVec hit = hn::Sub(layer, hn::Mul(back, splat(kParallaxStep)));
        const FMask meets = hn::And(above, hn::Le(gap, zero));
        depth = hn::IfThenElse(meets, i == 0 ? zero : hit, depth);
        above = hn::AndNot(meets, above);
        gap_before = gap;
    }
    LaneTexture at = c;
    at.u = hn::Add(c.u, hn::Mul(slope.u, depth));
    at.v = hn::Add(c.v, hn::Mul(slope.v, depth));
    return at;
}

}  // namespace shading
}  // namespace HWY_NAMESPACE
}  // namespace still::internal
HWY_AFTER_NAMESPACE();
