// Texture sampling, one pixel per lane; see sampler_reference.cpp for the truth.
// Included once per target by kernels_simd.cpp.

HWY_BEFORE_NAMESPACE();
namespace still::internal {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

struct LaneTexture {
    FVec u, v;
    FVec du_dx, du_dy, dv_dx, dv_dy;
};

/// The slopes are those of the mesh's own coordinates: an offset leaves the mip level as it is.
template <class Triangles>
HWY_INLINE LaneTexture textureCoordinates(const Triangles& t, const LaneBarycentrics& p,
                                          const Surface& s) {
    const float* attributes = s.attributes;
    FVec dx[3], dy[3], u[3], v[3];
    for (int k = 0; k < 3; ++k) {
        dx[k] = t.word(kWordDx + k);
        dy[k] = t.word(kWordDy + k);
        u[k] = t.vertexField(attributes, kAttributeStride, 3, k);
        v[k] = t.vertexField(attributes, kAttributeStride, 4, k);
    }
    LaneTexture c;
    c.u = interpolate3(p.b, u[0], u[1], u[2]);
    c.v = interpolate3(p.b, v[0], v[1], v[2]);
    const FVec sum_dx = hn::Add(hn::Add(dx[0], dx[1]), dx[2]);
    const FVec sum_dy = hn::Add(hn::Add(dy[0], dy[1]), dy[2]);
    const auto slope = [&](const FVec d[3], const FVec f[3], FVec value, FVec sum) {
        return hn::Mul(hn::Sub(interpolate3(f, d[0], d[1], d[2]), hn::Mul(value, sum)), p.w);
    };
    c.du_dx = slope(dx, u, c.u, sum_dx);
    c.du_dy = slope(dy, u, c.u, sum_dy);
    c.dv_dx = slope(dx, v, c.v, sum_dx);
    c.dv_dy = slope(dy, v, c.v, sum_dy);
    c.u = hn::Add(c.u, splat(s.material->u_offset));
    c.v = hn::Add(c.v, splat(s.material->v_offset));
    return c;
}

HWY_INLINE IVec mipLevel_fx8(const LaneTexture& c, const std::vector<TextureLevel>& levels,
                             int bias_fx8) {
    const FVec w = splat(float(levels[0].width)), h = splat(float(levels[0].height));
    const FVec ax = hn::Mul(c.du_dx, w), bx = hn::Mul(c.dv_dx, h);
    const FVec ay = hn::Mul(c.du_dy, w), by = hn::Mul(c.dv_dy, h);
    const FVec rho2 = hn::Min(hn::Max(hn::Max(hn::Add(hn::Mul(ax, ax), hn::Mul(bx, bx)),
                                              hn::Add(hn::Mul(ay, ay), hn::Mul(by, by))),
                                      splat(kTiny)),
                              splat(1e30f));
    const UVec bits = hn::BitCast(UTag(), rho2);
    const FVec exponent = hn::ConvertTo(
        FTag(), hn::Sub(hn::BitCast(ITag(), hn::ShiftRight<23>(bits)), splatInt(127)));
    const UVec mantissa =
        hn::Or(hn::And(bits, hn::Set(UTag(), 0x007FFFFFu)), hn::Set(UTag(), 0x3F800000u));
    const FVec t = hn::Sub(hn::BitCast(FTag(), mantissa), splat(1.0f));
    const FVec inner = hn::Add(splat(kLog2C2), hn::Mul(t, splat(kLog2C3)));
    const FVec poly = hn::Mul(t, hn::Add(splat(kLog2C1), hn::Mul(t, inner)));
    const IVec lod = hn::Add(roundLanes(FTag(), hn::Mul(hn::Add(exponent, poly), splat(128.0f))),
                             splatInt(bias_fx8));
    return hn::Min(hn::Max(lod, splatInt(0)), splatInt((int32_t(levels.size()) - 1) * 256));
}

struct LaneFootprint {
    IVec index[4];
    FVec fx, fy;
};

HWY_INLINE FVec wrapLanes(FVec c, Wrap wrap) {
    return wrap == Wrap::repeat ? hn::Sub(c, hn::Floor(c))
                                : hn::Min(hn::Max(c, splat(0.0f)), splat(1.0f));
}

HWY_INLINE void texelPair(FVec position, IVec size, Wrap wrap, IVec& i0, IVec& i1, FVec& fraction) {
    const FVec floor = hn::Floor(position);
    fraction = hn::Sub(position, floor);
    i0 = hn::ConvertTo(ITag(), floor);
    i1 = hn::Add(i0, splatInt(1));
    if (wrap == Wrap::repeat) {
        i0 = hn::IfThenElse(hn::Lt(i0, splatInt(0)), hn::Add(i0, size), i0);
        i1 = hn::IfThenElse(hn::Lt(i1, size), i1, hn::Sub(i1, size));
    }
    const IVec last = hn::Sub(size, splatInt(1));
    i0 = hn::Max(hn::Min(i0, last), splatInt(0));
    i1 = hn::Max(hn::Min(i1, last), splatInt(0));
}

/// Size and place of each lane's mip level.
struct LaneLevel {
    IVec width, height, offset;
};

HWY_INLINE LaneLevel levelOf(const std::vector<TextureLevel>& levels, IVec level) {
    const int32_t first = hn::GetLane(level);
    if (hn::AllTrue(ITag(), hn::Eq(level, splatInt(first)))) {
        const TextureLevel& l = levels[size_t(first)];
        return {splatInt(int32_t(l.width)), splatInt(int32_t(l.height)),
                splatInt(int32_t(l.offset))};
    }
    static_assert(sizeof(TextureLevel) == 12);
    const int32_t* fields = reinterpret_cast<const int32_t*>(levels.data());
    const IVec at = hn::Mul(level, splatInt(3));
    return {hn::GatherIndex(ITag(), fields, at), hn::GatherIndex(ITag(), fields + 1, at),
            hn::GatherIndex(ITag(), fields + 2, at)};
}

HWY_INLINE LaneFootprint footprint(FVec u, FVec v, const std::vector<TextureLevel>& levels,
                                   IVec level, Wrap wrap) {
    const auto [width, height, offset] = levelOf(levels, level);
    const FVec half = splat(0.5f);
    LaneFootprint f;
    IVec x0, x1, y0, y1;
    texelPair(hn::Sub(hn::Mul(wrapLanes(u, wrap), hn::ConvertTo(FTag(), width)), half), width, wrap,
              x0, x1, f.fx);
    texelPair(
        hn::Sub(hn::Mul(hn::Sub(splat(1.0f), wrapLanes(v, wrap)), hn::ConvertTo(FTag(), height)),
                half),
        height, wrap, y0, y1, f.fy);
    const IVec row0 = hn::Add(offset, hn::Mul(y0, width));
    const IVec row1 = hn::Add(offset, hn::Mul(y1, width));
    f.index[0] = hn::Add(row0, x0);
    f.index[1] = hn::Add(row0, x1);
    f.index[2] = hn::Add(row1, x0);
    f.index[3] = hn::Add(row1, x1);
    return f;
}

HWY_INLINE FVec mix(FVec a, FVec b, FVec t) {
    return hn::Add(a, hn::Mul(hn::Sub(b, a), t));
}

HWY_INLINE FVec bilinear(const LaneFootprint& f, const FVec t[4]) {
    return mix(mix(t[0], t[1], f.fx), mix(t[2], t[3], f.fx), f.fy);
}

template <bool kSquare>
HWY_INLINE Vec3 sampleLevel(const Texture& texture, IVec level, FVec u, FVec v) {
    const LaneFootprint f = footprint(u, v, texture.levels, level, texture.wrap);
    const int32_t* texels = reinterpret_cast<const int32_t*>(texture.texels.data());
    FVec t[3][4];
    for (int i = 0; i < 4; ++i) {
        const IVec texel = hn::GatherIndex(ITag(), texels, f.index[i]);
        const IVec mask = splatInt(int32_t{kTexelMask});
        const IVec c[3] = {hn::And(texel, mask), hn::And(hn::ShiftRight<10>(texel), mask),
                           hn::And(hn::ShiftRight<20>(texel), mask)};
        for (int k = 0; k < 3; ++k) {
            t[k][i] = hn::ConvertTo(FTag(), c[k]);
            if (kSquare) {
                t[k][i] = hn::Mul(t[k][i], t[k][i]);
            }
        }
    }
    return {bilinear(f, t[0]), bilinear(f, t[1]), bilinear(f, t[2])};
}

struct LaneMip {
    IVec level0, level1;
    FVec fraction;
    bool single;  ///< all fractions are zero (magnified textures): the second level adds nothing
};

HWY_INLINE LaneMip mipOf(const LaneTexture& c, const std::vector<TextureLevel>& levels,
                         int bias_fx8) {
    const IVec lod = mipLevel_fx8(c, levels, bias_fx8);
    LaneMip m;
    m.level0 = hn::ShiftRight<8>(lod);
    m.level1 = hn::Min(hn::Add(m.level0, splatInt(1)), splatInt(int32_t(levels.size()) - 1));
    const IVec fraction = hn::And(lod, splatInt(255));
    m.single = hn::AllTrue(ITag(), hn::Eq(fraction, splatInt(0)));
    m.fraction = hn::Mul(hn::ConvertTo(FTag(), fraction), splat(1.0f / 256.0f));
    return m;
}

template <bool kSquare>
HWY_INLINE Vec3 sampleTexture(const Texture& texture, const LaneTexture& c, int bias_fx8) {
    const LaneMip m = mipOf(c, texture.levels, bias_fx8);
    const Vec3 a = sampleLevel<kSquare>(texture, m.level0, c.u, c.v);
    if (m.single) {
        return a;
    }
    const Vec3 b = sampleLevel<kSquare>(texture, m.level1, c.u, c.v);
    return {mix(a.x, b.x, m.fraction), mix(a.y, b.y, m.fraction), mix(a.z, b.z, m.fraction)};
}

HWY_INLINE FVec sampleAlphaLevel(const AlphaTexture& texture, IVec level, FVec u, FVec v) {
    const LaneFootprint f = footprint(u, v, texture.levels, level, texture.wrap);
    const int32_t* texels = reinterpret_cast<const int32_t*>(texture.texels.data());
    FVec t[4];
    for (int i = 0; i < 4; ++i) {
        // Four bytes from any texel: the texture carries spare ones at its end.
        const IVec bytes = hn::GatherOffset(ITag(), texels, f.index[i]);
        t[i] = hn::ConvertTo(FTag(), hn::And(bytes, splatInt(255)));
    }
    return bilinear(f, t);
}

/// The texture at (u, v), in the levels of `m`.
HWY_INLINE FVec sampleAlphaAt(const AlphaTexture& texture, const LaneMip& m, FVec u, FVec v) {
    FVec alpha = sampleAlphaLevel(texture, m.level0, u, v);
    if (!m.single) {
        alpha = mix(alpha, sampleAlphaLevel(texture, m.level1, u, v), m.fraction);
    }
    return hn::Mul(alpha, splat(1.0f / 255.0f));
}

HWY_INLINE FVec sampleAlpha(const AlphaTexture& texture, const LaneTexture& c, int bias_fx8) {
    return sampleAlphaAt(texture, mipOf(c, texture.levels, bias_fx8), c.u, c.v);
}

}  // namespace HWY_NAMESPACE
}  // namespace still::internal
HWY_AFTER_NAMESPACE();
