// Texture sampling, one pixel per lane; see sampler_reference.cpp for the truth.
// Included once per target by kernels_simd.cpp.

HWY_BEFORE_NAMESPACE();
namespace still::internal {
namespace HWY_NAMESPACE {
namespace shading {
namespace hn = hwy::HWY_NAMESPACE;

struct LaneTexture {
    FVec u, v;
    FVec du_dx, du_dy, dv_dx, dv_dy;
};

/// The slopes are those of the mesh's own coordinates: an offset leaves the mip level as it is.
template <class Triangles>
HWY_INLINE LaneTexture textureCoordinates(const Triangles& t, const LaneBarycentrics& p,
                                          const Surface& s) {
    const Quad u = t.quad(kQuadU), v = t.quad(kQuadV), slopes = t.quad(kQuadSlopes);
    LaneTexture c;
    c.u = attribute(p, u);
    c.v = attribute(p, v);
    const FVec sum_dx = u.word[3], sum_dy = v.word[3];
    const auto slope = [&](FVec of_triangle, FVec value, FVec sum) {
        return hn::Mul(hn::Sub(of_triangle, hn::Mul(value, sum)), p.w);
    };
    c.du_dx = slope(slopes.word[0], c.u, sum_dx);
    c.du_dy = slope(slopes.word[1], c.u, sum_dy);
    c.dv_dx = slope(slopes.word[2], c.v, sum_dx);
    c.dv_dy = slope(slopes.word[3], c.v, sum_dy);
    c.u = hn::Add(c.u, splat(s.material->u_offset));
    c.v = hn::Add(c.v, splat(s.material->v_offset));
    return c;
}

HWY_INLINE IVec mipLevel_fx8(const LaneTexture& c, const std::vector<TextureLevel>& levels,
                             int bias_fx8) {
    const FVec w = splat(float(int32_t(levels[0].width)));
    const FVec h = splat(float(int32_t(levels[0].height)));
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
    const IVec lod =
        hn::Add(roundSmall(hn::Mul(hn::Add(exponent, poly), splat(128.0f))), splatInt(bias_fx8));
    return hn::Min(hn::Max(lod, splatInt(0)), splatInt((int32_t(levels.size()) - 1) * 256));
}

/// Texture coordinates that are wrapped or clamped to 0 … 1; the same for all levels.
struct LanePoint {
    FVec u, down;  ///< down = 1 − v: row 0 is the top
};

HWY_INLINE FVec wrapLanes(FVec c, Wrap wrap) {
    const FVec wrapped = wrap == Wrap::repeat ? hn::Sub(c, hn::Floor(c))
                                              : hn::Min(hn::Max(c, splat(0.0f)), splat(1.0f));
    // What is no number must not lead out of the texture.
    return hn::IfThenElseZero(hn::Le(wrapped, splat(1.0f)), wrapped);
}

HWY_INLINE LanePoint pointAt(FVec u, FVec v, Wrap wrap) {
    return {wrapLanes(u, wrap), hn::Sub(splat(1.0f), wrapLanes(v, wrap))};
}

/// Size and place of each lane's mip level.
struct LaneLevel {
    IVec width, height, offset, stride;
};

HWY_INLINE LaneLevel levelOf(const std::vector<TextureLevel>& levels, IVec level) {
    const int32_t first = hn::GetLane(level);
    if (hn::AllTrue(ITag(), hn::Eq(level, splatInt(first)))) {
        const TextureLevel& l = levels[size_t(first)];
        return {splatInt(int32_t(l.width)), splatInt(int32_t(l.height)),
                splatInt(int32_t(l.offset)), splatInt(int32_t(l.stride))};
    }
    static_assert(sizeof(TextureLevel) == 16);
    alignas(64) int32_t at[hn::MaxLanes(ITag())];
    hn::Store(hn::ShiftLeft<2>(level), ITag(), at);
    const Quad q = loadQuads(reinterpret_cast<const float*>(levels.data()), at);
    return {hn::BitCast(ITag(), q.word[0]), hn::BitCast(ITag(), q.word[1]),
            hn::BitCast(ITag(), q.word[2]), hn::BitCast(ITag(), q.word[3])};
}

/// The four texels around a point of one level. Neighbours follow one another in memory, thanks to
/// the level's border.
struct LaneFootprint {
    alignas(64) int32_t row[2][hn::MaxLanes(ITag())];  ///< of the first texel of both rows
    FVec fx, fy;
};

HWY_INLINE void footprint(const LanePoint& p, const std::vector<TextureLevel>& levels, IVec level,
                          LaneFootprint& f) {
    const LaneLevel l = levelOf(levels, level);
    const FVec half = splat(0.5f);
    const FVec x = hn::Sub(hn::Mul(p.u, hn::ConvertTo(FTag(), l.width)), half);
    const FVec y = hn::Sub(hn::Mul(p.down, hn::ConvertTo(FTag(), l.height)), half);
    const FVec x0 = hn::Floor(x), y0 = hn::Floor(y);
    f.fx = hn::Sub(x, x0);
    f.fy = hn::Sub(y, y0);
    const IVec at = hn::Add(hn::Add(l.offset, hn::Mul(smallInt(y0), l.stride)), smallInt(x0));
    hn::Store(at, ITag(), f.row[0]);
    hn::Store(hn::Add(at, l.stride), ITag(), f.row[1]);
}

HWY_INLINE FVec mix(FVec a, FVec b, FVec t) {
    return hn::Add(a, hn::Mul(hn::Sub(b, a), t));
}

HWY_INLINE FVec bilinear(const LaneFootprint& f, const FVec t[4]) {
    return mix(mix(t[0], t[1], f.fx), mix(t[2], t[3], f.fx), f.fy);
}

/// Two neighbours of a row.
struct TexelPair {
    IVec first, second;
};

/// Vectors of indices go to single loads by way of memory; without `volatile` compilers take them
/// apart lane by lane instead, which is three instructions for each.
HWY_INLINE ptrdiff_t indexAt(const int32_t* at) {
    return *static_cast<const volatile int32_t*>(at);
}

#if HWY_TARGET != HWY_SCALAR
/// The 64 bits at texels + at[0], at[2], at[4], … Loads twice as much: textures carry spare texels
/// at their end.
template <class D>
HWY_INLINE hn::Vec<D> everySecond(D d, const int32_t* texels, const int32_t* at) {
    if constexpr (hn::MaxLanes(D()) <= 4) {
        const hn::RepartitionToWide<D> d64;
        const auto a = hn::BitCast(d64, hn::LoadU(d, texels + indexAt(at)));
        const auto b = hn::BitCast(d64, hn::LoadU(d, texels + indexAt(at + 2)));
        return hn::BitCast(d, hn::InterleaveLower(d64, a, b));
    } else {
        const hn::Half<D> half;
        constexpr size_t kHalf = hn::MaxLanes(D()) / 2;
        return hn::Combine(d, everySecond(half, texels, at + kHalf), everySecond(half, texels, at));
    }
}
#endif

/// Texels at texels + at[lane] and behind them. A gather would fetch them one by one, and takes as
/// long for each as a load of both.
HWY_INLINE TexelPair loadPairs(const int32_t* texels, const int32_t* at) {
#if HWY_TARGET == HWY_SCALAR
    return {splatInt(texels[at[0]]), splatInt(texels[at[0] + 1])};
#else
    const ITag d;
    const hn::RepartitionToWide<UTag> d64;
    const IVec even = everySecond(d, texels, at), odd = everySecond(d, texels, at + 1);
    return {
        hn::OddEven(hn::BitCast(d, hn::ShiftLeft<32>(hn::BitCast(d64, odd))), even),
        hn::OddEven(odd, hn::BitCast(d, hn::ShiftRight<32>(hn::BitCast(d64, even)))),
    };
#endif
}

/// Channel k is times 2^(10 k), or 2^(20 k) when squared: left where it stands in the texel's word.
template <bool kSquare>
HWY_INLINE Vec3 sampleLevel(const Texture& texture, const LaneFootprint& f) {
    const int32_t* texels = reinterpret_cast<const int32_t*>(texture.texels.data());
    const TexelPair top = loadPairs(texels, f.row[0]), bottom = loadPairs(texels, f.row[1]);
    const IVec texel[4] = {top.first, top.second, bottom.first, bottom.second};
    FVec channel[3];
    for (int k = 0; k < 3; ++k) {
        const IVec mask = splatInt(int32_t(kTexelMask << (10 * k)));
        FVec t[4];
        for (int i = 0; i < 4; ++i) {
            t[i] = hn::ConvertTo(FTag(), hn::And(texel[i], mask));
            t[i] = kSquare ? hn::Mul(t[i], t[i]) : t[i];
        }
        channel[k] = bilinear(f, t);
    }
    return {channel[0], channel[1], channel[2]};
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

/// Where a texture will be read. Found out early, other work hides how long that takes.
struct LaneSample {
    LaneMip mip;
    LaneFootprint footprint[2];
};

HWY_INLINE void findTexels(const Texture& texture, const LaneTexture& c, int bias_fx8,
                           LaneSample& out) {
    out.mip = mipOf(c, texture.levels, bias_fx8);
    const LanePoint p = pointAt(c.u, c.v, texture.wrap);
    footprint(p, texture.levels, out.mip.level0, out.footprint[0]);
    footprint(p, texture.levels, out.mip.level1, out.footprint[1]);
}

/// Channels in 0 … 1023 · scale, or 0 … 1023² · scale when squared: multiplied by `scale` as the
/// last step.
template <bool kSquare>
HWY_INLINE Vec3 sampleTexture(const Texture& texture, const LaneSample& sample, float scale) {
    Vec3 a = sampleLevel<kSquare>(texture, sample.footprint[0]);
    if (!sample.mip.single) {
        const Vec3 b = sampleLevel<kSquare>(texture, sample.footprint[1]);
        const FVec fraction = sample.mip.fraction;
        a = {mix(a.x, b.x, fraction), mix(a.y, b.y, fraction), mix(a.z, b.z, fraction)};
    }
    // Powers of two take the channels back to their places and change no digit.
    constexpr float kStep = kSquare ? 1.0f / (1 << 20) : 1.0f / (1 << 10);
    return {hn::Mul(a.x, splat(scale)), hn::Mul(a.y, splat(scale * kStep)),
            hn::Mul(a.z, splat(scale * kStep * kStep))};
}

#if HWY_TARGET != HWY_SCALAR
/// The 32 bits at bytes + at[lane].
template <class D>
HWY_INLINE hn::Vec<D> loadBytes4(D d, const uint8_t* bytes, const int32_t* at) {
    if constexpr (hn::MaxLanes(D()) == 1) {
        int32_t word;
        std::memcpy(&word, bytes + indexAt(at), sizeof(word));
        return hn::Set(d, word);
    } else {
        const hn::Half<D> half;
        constexpr size_t kHalf = hn::MaxLanes(D()) / 2;
        return hn::Combine(d, loadBytes4(half, bytes, at + kHalf), loadBytes4(half, bytes, at));
    }
}
#endif

/// Alpha at bytes + at[lane] and behind it: four bytes from any texel, the texture carries spare
/// ones at its end.
HWY_INLINE TexelPair loadAlphaPairs(const uint8_t* bytes, const int32_t* at) {
#if HWY_TARGET == HWY_SCALAR
    return {splatInt(bytes[at[0]]), splatInt(bytes[at[0] + 1])};
#else
    const IVec words = loadBytes4(ITag(), bytes, at);
    return {hn::And(words, splatInt(255)), hn::And(hn::ShiftRight<8>(words), splatInt(255))};
#endif
}

HWY_INLINE FVec sampleAlphaLevel(const AlphaTexture& texture, IVec level, const LanePoint& p) {
    LaneFootprint f;
    footprint(p, texture.levels, level, f);
    const uint8_t* texels = texture.texels.data();
    const TexelPair top = loadAlphaPairs(texels, f.row[0]);
    const TexelPair bottom = loadAlphaPairs(texels, f.row[1]);
    const FVec t[4] = {hn::ConvertTo(FTag(), top.first), hn::ConvertTo(FTag(), top.second),
                       hn::ConvertTo(FTag(), bottom.first), hn::ConvertTo(FTag(), bottom.second)};
    return bilinear(f, t);
}

/// The texture at (u, v), in the levels of `m`.
HWY_INLINE FVec sampleAlphaAt(const AlphaTexture& texture, const LaneMip& m, FVec u, FVec v) {
    const LanePoint p = pointAt(u, v, texture.wrap);
    FVec alpha = sampleAlphaLevel(texture, m.level0, p);
    if (!m.single) {
        alpha = mix(alpha, sampleAlphaLevel(texture, m.level1, p), m.fraction);
    }
    return hn::Mul(alpha, splat(1.0f / 255.0f));
}

HWY_INLINE FVec sampleAlpha(const AlphaTexture& texture, const LaneTexture& c, int bias_fx8) {
    return sampleAlphaAt(texture, mipOf(c, texture.levels, bias_fx8), c.u, c.v);
}

}  // namespace shading
}  // namespace HWY_NAMESPACE
}  // namespace still::internal
HWY_AFTER_NAMESPACE();
