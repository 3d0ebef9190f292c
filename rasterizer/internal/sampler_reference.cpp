#include "rasterizer/internal/sampler_reference.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "rasterizer/fixed.h"

namespace still::internal {

TextureCoordinates textureCoordinates(const PixelBarycentrics& p, const Surface& s) {
    const ShadeTriangle& t = *p.triangle;
    const float* attributes = s.attributes;
    TextureCoordinates c;
    c.u = attribute(p, attributes, kAttributeStride, 3);
    c.v = attribute(p, attributes, kAttributeStride, 4);
    float u[3], v[3];
    for (int k = 0; k < 3; ++k) {
        u[k] = attributes[t.vertex[k] * kAttributeStride + 3];
        v[k] = attributes[t.vertex[k] * kAttributeStride + 4];
    }
    const float sum_dx = (t.p_dx[0] + t.p_dx[1]) + t.p_dx[2];
    const float sum_dy = (t.p_dy[0] + t.p_dy[1]) + t.p_dy[2];
    const auto slope = [&](const float d[3], const float f[3], float value, float sum) {
        return (((f[0] * d[0] + f[1] * d[1]) + f[2] * d[2]) - value * sum) * p.w;
    };
    c.du_dx = slope(t.p_dx, u, c.u, sum_dx);
    c.du_dy = slope(t.p_dy, u, c.u, sum_dy);
    c.dv_dx = slope(t.p_dx, v, c.v, sum_dx);
    c.dv_dy = slope(t.p_dy, v, c.v, sum_dy);
    c.u = c.u + s.material->u_offset;
    c.v = c.v + s.material->v_offset;
    return c;
}

namespace {

/// log2 of the longer axis of the pixel's footprint, in 1/256 levels, within the chain.
int mipLevel_fx8(const TextureCoordinates& c, const std::vector<TextureLevel>& levels,
                 int bias_fx8) {
    const float w = float(levels[0].width), h = float(levels[0].height);
    const float ax = c.du_dx * w, bx = c.dv_dx * h, ay = c.du_dy * w, by = c.dv_dy * h;
    const float rho2 = smaller(larger(larger(ax * ax + bx * bx, ay * ay + by * by), kTiny), 1e30f);
    const uint32_t bits = std::bit_cast<uint32_t>(rho2);
    const float exponent = float(int32_t(bits >> 23) - 127);
    const float t = std::bit_cast<float>((bits & 0x007FFFFFu) | 0x3F800000u) - 1.0f;
    const float log2 = exponent + t * (kLog2C1 + t * (kLog2C2 + t * kLog2C3));
    return std::clamp<int>(roundToInt(log2 * 128.0f) + bias_fx8, 0, (int(levels.size()) - 1) * 256);
}

/// The four texels around a point of one level, and the fractions between them.
struct Footprint {
    uint32_t index[4];  ///< (x0,y0) (x1,y0) (x0,y1) (x1,y1)
    float fx, fy;
};

float wrapped(float c, Wrap wrap) {
    const float w = wrap == Wrap::repeat ? c - std::floor(c) : smaller(larger(c, 0.0f), 1.0f);
    return w <= 1.0f ? w : 0.0f;  // not a number
}

/// First texel and the next one along one axis.
void texelPair(float position, int size, Wrap wrap, int& i0, int& i1, float& fraction) {
    const float floor = std::floor(position);
    fraction = position - floor;
    i0 = int(floor);
    i1 = i0 + 1;
    if (wrap == Wrap::repeat) {
        i0 = i0 < 0 ? i0 + size : i0;
        i1 = i1 >= size ? i1 - size : i1;
    }
    i0 = std::max(std::min(i0, size - 1), 0);
    i1 = std::max(std::min(i1, size - 1), 0);
}

Footprint footprint(float u, float v, const TextureLevel& level, Wrap wrap) {
    Footprint f;
    int x0, x1, y0, y1;
    texelPair(wrapped(u, wrap) * float(int(level.width)) - 0.5f, int(level.width), wrap, x0, x1,
              f.fx);
    texelPair((1.0f - wrapped(v, wrap)) * float(int(level.height)) - 0.5f, int(level.height), wrap,
              y0, y1, f.fy);
    const uint32_t row0 = level.offset + uint32_t(y0) * level.stride;
    const uint32_t row1 = level.offset + uint32_t(y1) * level.stride;
    f.index[0] = row0 + uint32_t(x0);
    f.index[1] = row0 + uint32_t(x1);
    f.index[2] = row1 + uint32_t(x0);
    f.index[3] = row1 + uint32_t(x1);
    return f;
}

float bilinear(const Footprint& f, float t00, float t10, float t01, float t11) {
    const float top = t00 + (t10 - t00) * f.fx;
    const float bottom = t01 + (t11 - t01) * f.fx;
    return top + (bottom - top) * f.fy;
}

template <bool kSquare>
Float3 sampleLevel(const Texture& texture, const TextureLevel& level, float u, float v) {
    const Footprint f = footprint(u, v, level, texture.wrap);
    float channel[3];
    for (int c = 0; c < 3; ++c) {
        float t[4];
        for (int i = 0; i < 4; ++i) {
            t[i] = float(int32_t(texture.texels[f.index[i]] >> (10 * c) & kTexelMask));
            t[i] = kSquare ? t[i] * t[i] : t[i];
        }
        channel[c] = bilinear(f, t[0], t[1], t[2], t[3]);
    }
    return {channel[0], channel[1], channel[2]};
}

}  // namespace

template <bool kSquare>
Float3 sampleTexture(const Texture& texture, const TextureCoordinates& c, int bias_fx8) {
    const int lod_fx8 = mipLevel_fx8(c, texture.levels, bias_fx8);
    const int level0 = lod_fx8 >> 8;
    const int level1 = std::min(level0 + 1, int(texture.levels.size()) - 1);
    const float fraction = float(lod_fx8 & 255) * (1.0f / 256.0f);
    const Float3 a = sampleLevel<kSquare>(texture, texture.levels[size_t(level0)], c.u, c.v);
    const Float3 b = sampleLevel<kSquare>(texture, texture.levels[size_t(level1)], c.u, c.v);
    return {a.x + (b.x - a.x) * fraction, a.y + (b.y - a.y) * fraction,
            a.z + (b.z - a.z) * fraction};
}

template Float3 sampleTexture<false>(const Texture&, const TextureCoordinates&, int);
template Float3 sampleTexture<true>(const Texture&, const TextureCoordinates&, int);

float sampleAlpha(const AlphaTexture& texture, const TextureCoordinates& c, int bias_fx8) {
    const int lod_fx8 = mipLevel_fx8(c, texture.levels, bias_fx8);
    const int level0 = lod_fx8 >> 8;
    const int level1 = std::min(level0 + 1, int(texture.levels.size()) - 1);
    float value[2];
    const int level[2] = {level0, level1};
    for (int i = 0; i < 2; ++i) {
        const Footprint f = footprint(c.u, c.v, texture.levels[size_t(level[i])], texture.wrap);
        float t[4];
        for (int k = 0; k < 4; ++k) {
            t[k] = float(int32_t{texture.texels[f.index[k]]});
        }
        value[i] = bilinear(f, t[0], t[1], t[2], t[3]);
    }
    const float fraction = float(lod_fx8 & 255) * (1.0f / 256.0f);
    return (value[0] + (value[1] - value[0]) * fraction) * (1.0f / 255.0f);
}

}  // namespace still::internal
