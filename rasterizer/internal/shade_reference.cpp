// Lambert + Blinn-Phong (Blinn 1977) with trilinear textures (Williams 1983) and normal maps.

#include "rasterizer/internal/shade_reference.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "rasterizer/fixed.h"
#include "rasterizer/internal/shading_constants.h"

namespace still::internal {

namespace {

struct Float3 {
    float x, y, z;
};

float dot(const Float3& a, const Float3& b) {
    return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

Float3 scale(const Float3& a, float s) {
    return {a.x * s, a.y * s, a.z * s};
}

Float3 normalized(const Float3& a) {
    return scale(a, 1.0f / std::sqrt(std::max(dot(a, a), kTiny)));
}

Float3 cross(const Float3& a, const Float3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

float interpolate(const PixelBarycentrics& p, float f0, float f1, float f2) {
    return (p.b[0] * f0 + p.b[1] * f1) + p.b[2] * f2;
}

/// Field `field` of an interleaved per-vertex array.
float attribute(const PixelBarycentrics& p, const float* base, int stride, int field) {
    const int32_t* v = p.triangle->vertex;
    return interpolate(p, base[v[0] * stride + field], base[v[1] * stride + field],
                       base[v[2] * stride + field]);
}

constexpr int kAttributeStride = 5;
constexpr int kTangentStride = 4;

// ---- sampling --------------------------------------------------------------------------------

struct TextureCoordinates {
    float u, v;
    float du_dx, du_dy, dv_dx, dv_dy;  ///< per pixel
};

/// The slopes are those of the mesh's own coordinates: an offset leaves the mip level as it is.
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

/// log2 of the longer axis of the pixel's footprint, in 1/256 levels, within the chain.
int mipLevel_fx8(const TextureCoordinates& c, const std::vector<TextureLevel>& levels,
                 int bias_fx8) {
    const float w = float(levels[0].width), h = float(levels[0].height);
    const float ax = c.du_dx * w, bx = c.dv_dx * h, ay = c.du_dy * w, by = c.dv_dy * h;
    const float rho2 =
        std::min(std::max(std::max(ax * ax + bx * bx, ay * ay + by * by), kTiny), 1e30f);
    const uint32_t bits = std::bit_cast<uint32_t>(rho2);
    const float exponent = float(int32_t(bits >> 23) - 127);
    const float t = std::bit_cast<float>((bits & 0x007FFFFFu) | 0x3F800000u) - 1.0f;
    const float log2 = exponent + t * (kLog2C1 + t * (kLog2C2 + t * kLog2C3));
    return std::clamp(roundToInt(log2 * 128.0f) + bias_fx8, 0, (int(levels.size()) - 1) * 256);
}

/// The four texels around a point of one level, and the fractions between them.
struct Footprint {
    uint32_t index[4];  ///< (x0,y0) (x1,y0) (x0,y1) (x1,y1)
    float fx, fy;
};

float wrapped(float c, Wrap wrap) {
    return wrap == Wrap::repeat ? c - std::floor(c) : std::min(std::max(c, 0.0f), 1.0f);
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
    const uint32_t row0 = level.offset + uint32_t(y0) * level.width;
    const uint32_t row1 = level.offset + uint32_t(y1) * level.width;
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

/// Raw texel units: squared for colour, 0 … 1023 for normal maps.
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

// ---- lighting --------------------------------------------------------------------------------

Float3 rotate(const float m[9], const Float3& v) {
    return {(m[0] * v.x + m[1] * v.y) + m[2] * v.z, (m[3] * v.x + m[4] * v.y) + m[5] * v.z,
            (m[6] * v.x + m[7] * v.y) + m[8] * v.z};
}

Float3 transformPoint(const Affine& m, const Float3& p) {
    return {(m[0] * p.x + m[1] * p.y) + (m[2] * p.z + m[3]),
            (m[4] * p.x + m[5] * p.y) + (m[6] * p.z + m[7]),
            (m[8] * p.x + m[9] * p.y) + (m[10] * p.z + m[11])};
}

Float3 objectPosition(const PixelBarycentrics& p, const Surface& s) {
    return {attribute(p, s.x, 1, 0), attribute(p, s.y, 1, 0), attribute(p, s.z, 1, 0)};
}

Float3 worldTangent(const PixelBarycentrics& p, const Surface& s, const InstanceSetup& instance) {
    Float3 t{attribute(p, s.tangents, kTangentStride, 0),
             attribute(p, s.tangents, kTangentStride, 1),
             attribute(p, s.tangents, kTangentStride, 2)};
    if (!instance.identity) {
        const Affine& m = instance.world;
        t = {(m[0] * t.x + m[1] * t.y) + m[2] * t.z, (m[4] * t.x + m[5] * t.y) + m[6] * t.z,
             (m[8] * t.x + m[9] * t.y) + m[10] * t.z};
    }
    return normalized(t);
}

Float3 shadingNormal(const PixelBarycentrics& p, const Surface& s, const InstanceSetup& instance,
                     const TextureCoordinates& c) {
    Float3 n{attribute(p, s.attributes, kAttributeStride, 0),
             attribute(p, s.attributes, kAttributeStride, 1),
             attribute(p, s.attributes, kAttributeStride, 2)};
    if (!instance.identity) {
        n = rotate(instance.normal, n);
    }
    n = normalized(n);
    if (s.normal != nullptr) {
        const Float3 t = worldTangent(p, s, instance);
        const float handedness = s.tangents[p.triangle->vertex[0] * kTangentStride + 3];
        const Float3 b = scale(cross(n, t), handedness);
        const Float3 raw = sampleTexture<false>(*s.normal, c, s.mip_bias_fx8);
        const float x = raw.x * kTexelToNormal - 1.0f;
        const float y = raw.y * kTexelToNormal - 1.0f;
        const float z = raw.z * kTexelToNormal - 1.0f;
        n = normalized({(t.x * x + b.x * y) + n.x * z, (t.y * x + b.y * y) + n.y * z,
                        (t.z * x + b.z * y) + n.z * z});
    }
    return scale(n, p.triangle->flip);
}

/// x^n by squaring; n ≥ 1.
float power(float x, int n) {
    float result = 1.0f;
    for (; n > 0; n >>= 1) {
        if ((n & 1) != 0) {
            result = result * x;
        }
        x = x * x;
    }
    return result;
}

struct Lit {
    Float3 diffuse, specular;
};

Float3 toFloat3(const std::array<float, 3>& a) {
    return {a[0], a[1], a[2]};
}

void addLight(Lit& lit, const Float3& to_light, const Float3& colour, float attenuation,
              const Float3& n, const Float3& to_eye, int shininess) {
    const float cosine = std::max(dot(n, to_light), 0.0f) * attenuation;
    lit.diffuse.x = lit.diffuse.x + colour.x * cosine;
    lit.diffuse.y = lit.diffuse.y + colour.y * cosine;
    lit.diffuse.z = lit.diffuse.z + colour.z * cosine;
    if (shininess > 0) {
        const Float3 half =
            normalized({to_light.x + to_eye.x, to_light.y + to_eye.y, to_light.z + to_eye.z});
        // Only where the light reaches the surface.
        const float highlight =
            cosine > 0.0f ? power(std::max(dot(n, half), 0.0f), shininess) * attenuation : 0.0f;
        lit.specular.x = lit.specular.x + colour.x * highlight;
        lit.specular.y = lit.specular.y + colour.y * highlight;
        lit.specular.z = lit.specular.z + colour.z * highlight;
    }
}

Lit lightSurface(const TileContext& tile, const PixelBarycentrics& p, const Surface& s,
                 const InstanceSetup& instance, const Float3& n) {
    const Lighting& lighting = tile.frame->list->lighting;
    Lit lit{toFloat3(lighting.ambient), {0, 0, 0}};
    Float3 position{}, to_eye{};
    if ((s.features & kShadePosition) != 0) {
        position = objectPosition(p, s);
        if (!instance.identity) {
            position = transformPoint(instance.world, position);
        }
        const glm::vec3& eye = tile.frame->view->eye;
        to_eye = normalized({eye.x - position.x, eye.y - position.y, eye.z - position.z});
    }
    const Float3 d = toFloat3(lighting.sun.direction);
    addLight(lit, {-d.x, -d.y, -d.z}, toFloat3(lighting.sun.colour), 1.0f, n, to_eye, s.shininess);
    for (const PointLight& light : lighting.points) {
        const Float3 to{light.position[0] - position.x, light.position[1] - position.y,
                        light.position[2] - position.z};
        const float d2 = std::max(dot(to, to), 1e-12f);
        const Float3 direction = scale(to, 1.0f / std::sqrt(d2));
        addLight(lit, direction, toFloat3(light.colour), 1.0f / d2, n, to_eye, s.shininess);
    }
    return lit;
}

// ---- output ----------------------------------------------------------------------------------

uint16_t toFx12(float linear) {
    return uint16_t(roundToInt(std::min(std::max(linear, 0.0f), kColourMax) * kColourScale));
}

uint32_t packOctahedral(const Float3& n) {
    const float sum = std::max((std::fabs(n.x) + std::fabs(n.y)) + std::fabs(n.z), kTiny);
    const float inv = 1.0f / sum;
    const float px = n.x * inv, py = n.y * inv;
    float u = px, v = py;
    if (n.z < 0.0f) {
        u = (1.0f - std::fabs(py)) * (px < 0.0f ? -1.0f : 1.0f);
        v = (1.0f - std::fabs(px)) * (py < 0.0f ? -1.0f : 1.0f);
    }
    const auto snorm = [](float f) { return uint32_t(roundToInt(f * kSnormScale)) & 0xFFFFu; };
    return snorm(u) | (snorm(v) << 16);
}

struct Reprojected {
    float x, y;      ///< motion in pixels
    float depth, w;  ///< reversed depth and w in the previous frame
};

void storeMotion(const TileContext& tile, size_t at, const Reprojected& r) {
    const bool known =
        r.w > 1e-20f && std::fabs(r.x) < kMotionMax_px && std::fabs(r.y) < kMotionMax_px;
    Motion m{kNoHistory, 0};
    uint16_t depth = 0;
    if (known) {
        m = {int16_t(roundToInt(r.x * kMotionScale)), int16_t(roundToInt(r.y * kMotionScale))};
        // Not max(): it may keep −0, whose bits are large.
        depth = logDepth16(std::bit_cast<uint32_t>(r.depth > 0.0f ? r.depth : 0.0f));
    }
    tile.planes.motion[at] = m;
    tile.planes.depth_before[at] = depth;
}

Reprojected reprojectStatic(const TileContext& tile, int x, int y, float depth) {
    const auto& m = tile.reproject.m;
    const float fx = float(x), fy = float(y);
    float q[4];
    for (int i = 0; i < 4; ++i) {
        q[i] = ((m[i][0] * fx + m[i][1] * fy) + m[i][2] * depth) + m[i][3];
    }
    const float inv = 1.0f / (q[3] > 1e-20f ? q[3] : 1.0f);
    return {q[0] * inv - fx, q[1] * inv - fy, q[2] * inv, q[3]};
}

Reprojected reprojectMoved(const InstanceSetup& instance, const Float3& p) {
    const auto row = [&](const float m[4]) {
        return (m[0] * p.x + m[1] * p.y) + (m[2] * p.z + m[3]);
    };
    const auto& now = instance.pixels_now.m;
    const auto& before = instance.pixels_before.m;
    const float w_now = row(now[3]), w_before = row(before[3]);
    const float inv_now = 1.0f / (w_now > 1e-20f ? w_now : 1.0f);
    const float inv_before = 1.0f / (w_before > 1e-20f ? w_before : 1.0f);
    return {row(before[0]) * inv_before - row(now[0]) * inv_now,
            row(before[1]) * inv_before - row(now[1]) * inv_now, row(before[2]) * inv_before,
            w_before};
}

Float3 surfaceColour(const TileContext& tile, const PixelBarycentrics& p, const Surface& s,
                     const InstanceSetup& instance, const Float3& n, const TextureCoordinates& c) {
    const Material& m = *s.material;
    const Lit lit = lightSurface(tile, p, s, instance, n);
    Float3 albedo = toFloat3(m.diffuse);
    if (s.colour != nullptr) {
        const Float3 texel = sampleTexture<true>(*s.colour, c, s.mip_bias_fx8);
        albedo = {albedo.x * (texel.x * kTexelToLinear), albedo.y * (texel.y * kTexelToLinear),
                  albedo.z * (texel.z * kTexelToLinear)};
    }
    Float3 colour{albedo.x * lit.diffuse.x + m.emission[0],
                  albedo.y * lit.diffuse.y + m.emission[1],
                  albedo.z * lit.diffuse.z + m.emission[2]};
    if (s.shininess > 0) {
        colour = {colour.x + m.specular[0] * lit.specular.x,
                  colour.y + m.specular[1] * lit.specular.y,
                  colour.z + m.specular[2] * lit.specular.z};
    }
    return colour;
}

}  // namespace

PixelBarycentrics barycentricsAt(const ShadeTriangle& t, int x, int y) {
    PixelBarycentrics p;
    const float rx = float(x) - t.anchor_x, ry = float(y) - t.anchor_y;
    for (int k = 0; k < 3; ++k) {
        p.b[k] = std::max((t.p[k] + t.p_dy[k] * ry) + t.p_dx[k] * rx, 0.0f);
    }
    p.w = 1.0f / std::max((p.b[0] + p.b[1]) + p.b[2], kTiny);
    for (float& b : p.b) {
        b = b * p.w;
    }
    p.triangle = &t;
    return p;
}

bool alphaPasses(const TileContext& tile, const ShadeTriangle& t, int x, int y) {
    const Surface& s = tile.frame->surfaces[t.surface];
    float alpha = s.material->opacity;
    if (s.alpha != nullptr) {
        const PixelBarycentrics p = barycentricsAt(t, x, y);
        alpha = alpha * sampleAlpha(*s.alpha, textureCoordinates(p, s), s.mip_bias_fx8);
    }
    if (s.material->alpha_mode == AlphaMode::test) {
        return alpha >= 0.5f;
    }
    uint32_t h = uint32_t(tile.x0 + x) * kHashX ^ uint32_t(tile.y0 + y) * kHashY ^
                 uint32_t(t.surface) * kHashSurface;
    h ^= h >> 15;
    h *= kHashMix;
    h ^= h >> 12;
    h += tile.frame->view->sample * kGoldenRatio;
    return float(int32_t(h >> 16)) < alpha * 65536.0f;
}

void shadePixel(const TileContext& tile, const ShadeTriangle* triangle, int x, int y, float depth) {
    const FrameTables& frame = *tile.frame;
    const size_t at = size_t(y) * size_t(tile.planes.stride) + size_t(x);
    Float3 colour = toFloat3(frame.list->background);
    uint16_t id = 0;
    uint32_t normal = 0;
    bool own_motion = false;
    if (triangle != nullptr) {
        const Surface& s = frame.surfaces[triangle->surface];
        const InstanceSetup& instance = frame.instances[s.instance];
        const PixelBarycentrics p = barycentricsAt(*triangle, x, y);
        TextureCoordinates c{};
        if ((s.features & (kShadeTexture | kShadeNormalMap)) != 0) {
            c = textureCoordinates(p, s);
        }
        const Float3 n = shadingNormal(p, s, instance, c);
        colour = surfaceColour(tile, p, s, instance, n, c);
        normal = packOctahedral(n);
        own_motion = instance.own_motion;
        id = uint16_t(triangle->surface | (instance.moved ? kMovedBit : 0));
        if (own_motion && tile.planes.motion != nullptr) {
            storeMotion(tile, at, reprojectMoved(instance, objectPosition(p, s)));
        }
    }
    tile.planes.red[at] = toFx12(colour.x);
    tile.planes.green[at] = toFx12(colour.y);
    tile.planes.blue[at] = toFx12(colour.z);
    tile.planes.depth[at] = std::bit_cast<uint32_t>(depth);
    tile.planes.id[at] = id;
    if (tile.planes.normal != nullptr) {
        tile.planes.normal[at] = normal;
    }
    if (tile.planes.motion != nullptr && !own_motion) {
        storeMotion(tile, at, reprojectStatic(tile, x, y, depth));
    }
}

}  // namespace still::internal
