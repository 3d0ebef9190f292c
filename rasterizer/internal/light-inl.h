// Shading normal and light, one pixel per lane; see shade_reference.cpp for the truth.
// Included once per target by kernels_simd.cpp.

HWY_BEFORE_NAMESPACE();
namespace still::internal {
namespace HWY_NAMESPACE {
namespace shading {
namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE Vec3 bumped(const Vec3& n, const Vec3& t, const Vec3& b, const Vec3& raw) {
    const FVec one = splat(1.0f);
    const FVec x = hn::Sub(raw.x, one), y = hn::Sub(raw.y, one), z = hn::Sub(raw.z, one);
    const auto combine = [&](FVec tc, FVec bc, FVec nc) {
        return hn::Add(hn::Add(hn::Mul(tc, x), hn::Mul(bc, y)), hn::Mul(nc, z));
    };
    return normalize3({combine(t.x, b.x, n.x), combine(t.y, b.y, n.y), combine(t.z, b.z, n.z)});
}

template <bool kFull, bool kUniform>
HWY_INLINE Vec3 shadingNormal(const LaneTriangles<kUniform>& t, const LaneBarycentrics& p,
                              const Surface& s, const InstanceSetup& instance, const LaneTexture& c,
                              const LaneSample& of_colour) {
    Vec3 n = worldNormal(t, p, instance);
    if constexpr (kFull) {
        if (s.normal != nullptr) {
            const Vec3 tangent = worldTangent(t, p, instance);
            const Vec3 bitangent = worldBitangent(t, instance, n, tangent);
            LaneSample own;
            if (!s.normal_like_colour) {
                findTexels(*s.normal, c, s.mip_bias_fx8, own);
            }
            n = bumped(n, tangent, bitangent,
                       sampleTexture<false>(*s.normal, s.normal_like_colour ? of_colour : own,
                                            kTexelToNormal));
        }
    }
    return scale3(n, p.flip);
}

struct LaneLight {
    Vec3 diffuse, specular;
};

HWY_INLINE FVec power(FVec x, int n) {
    FVec result = splat(1.0f);
    for (; n > 0; n >>= 1) {
        if ((n & 1) != 0) {
            result = hn::Mul(result, x);
        }
        x = hn::Mul(x, x);
    }
    return result;
}

HWY_INLINE Vec3 addScaled(const Vec3& sum, const std::array<float, 3>& colour, FVec factor) {
    return {hn::Add(sum.x, hn::Mul(splat(colour[0]), factor)),
            hn::Add(sum.y, hn::Mul(splat(colour[1]), factor)),
            hn::Add(sum.z, hn::Mul(splat(colour[2]), factor))};
}

HWY_INLINE void addLight(LaneLight& lit, const Vec3& to_light, const std::array<float, 3>& colour,
                         FVec attenuation, const Vec3& n, const Vec3& to_eye, int shininess) {
    const FVec zero = hn::Zero(FTag());
    const FVec cosine = hn::Mul(hn::Max(dot3(n, to_light), zero), attenuation);
    lit.diffuse = addScaled(lit.diffuse, colour, cosine);
    if (shininess > 0) {
        const Vec3 half = normalize3({hn::Add(to_light.x, to_eye.x), hn::Add(to_light.y, to_eye.y),
                                      hn::Add(to_light.z, to_eye.z)});
        const FVec highlight = hn::Mul(power(hn::Max(dot3(n, half), zero), shininess), attenuation);
        lit.specular =
            addScaled(lit.specular, colour, hn::IfThenElseZero(hn::Gt(cosine, zero), highlight));
    }
}

template <bool kFull, bool kUniform>
HWY_INLINE LaneLight lightSurface(const TileContext& tile, const LaneTriangles<kUniform>& t,
                                  const LaneBarycentrics& p, const Surface& s,
                                  const InstanceSetup& instance, const Vec3& n) {
    const PlainLight& lighting = tile.frame->light;
    const FVec zero = hn::Zero(FTag());
    LaneLight lit{
        {splat(lighting.ambient[0]), splat(lighting.ambient[1]), splat(lighting.ambient[2])},
        {zero, zero, zero}};
    Vec3 position{zero, zero, zero}, to_eye{zero, zero, zero};
    if (kFull && (s.features & kShadePosition) != 0) {
        position = worldPosition(t, p, instance);
    }
    const std::array<float, 3>& d = lighting.sun.direction;
    const int shininess = kFull ? s.shininess : 0;
    if (shininess > 0) {
        to_eye = towardsEye(*tile.frame->view, position);
    }
    addLight(lit, {splat(-d[0]), splat(-d[1]), splat(-d[2])}, lighting.sun.colour, splat(1.0f), n,
             to_eye, shininess);
    if constexpr (kFull) {
        for (const PointLight& light : lighting.points) {
            const Vec3 to{hn::Sub(splat(light.position[0]), position.x),
                          hn::Sub(splat(light.position[1]), position.y),
                          hn::Sub(splat(light.position[2]), position.z)};
            const FVec d2 = hn::Max(dot3(to, to), splat(1e-12f));
            const Vec3 direction = scale3(to, div(splat(1.0f), squareRoot(d2)));
            addLight(lit, direction, light.colour, div(splat(1.0f), d2), n, to_eye, shininess);
        }
    }
    return lit;
}

}  // namespace shading
}  // namespace HWY_NAMESPACE
}  // namespace still::internal
HWY_AFTER_NAMESPACE();
