// Lambert + Blinn-Phong (Blinn 1977) with textures, normal maps and height maps.

#include "rasterizer/internal/shade_reference.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "rasterizer/fixed.h"
#include "rasterizer/internal/parallax_reference.h"
#include "rasterizer/internal/sampler_reference.h"
#include "rasterizer/internal/surface_reference.h"

namespace still::internal {

namespace {

// ---- lighting --------------------------------------------------------------------------------

Float3 shadingNormal(const PixelBarycentrics& p, const Surface& s, const InstanceSetup& instance,
                     const TextureCoordinates& c) {
    Float3 n = worldNormal(p, s, instance);
    if (s.normal != nullptr) {
        const Float3 t = worldTangent(p, s, instance);
        const Float3 b = worldBitangent(p, s, instance, n, t);
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
    const float cosine = larger(dot(n, to_light), 0.0f) * attenuation;
    lit.diffuse.x = lit.diffuse.x + colour.x * cosine;
    lit.diffuse.y = lit.diffuse.y + colour.y * cosine;
    lit.diffuse.z = lit.diffuse.z + colour.z * cosine;
    if (shininess > 0) {
        const Float3 half =
            normalized({to_light.x + to_eye.x, to_light.y + to_eye.y, to_light.z + to_eye.z});
        // Only where the light reaches the surface.
        const float highlight =
            cosine > 0.0f ? power(larger(dot(n, half), 0.0f), shininess) * attenuation : 0.0f;
        lit.specular.x = lit.specular.x + colour.x * highlight;
        lit.specular.y = lit.specular.y + colour.y * highlight;
        lit.specular.z = lit.specular.z + colour.z * highlight;
    }
}

Lit lightSurface(const TileContext& tile, const PixelBarycentrics& p, const Surface& s,
                 const InstanceSetup& instance, const Float3& n) {
    const PlainLight& lighting = tile.frame->light;
    Lit lit{toFloat3(lighting.ambient), {0, 0, 0}};
    Float3 position{}, to_eye{};
    if ((s.features & kShadePosition) != 0) {
        position = worldPosition(p, s, instance);
        to_eye = towardsEye(*tile.frame->view, position);
    }
    const Float3 d = toFloat3(lighting.sun.direction);
    addLight(lit, {-d.x, -d.y, -d.z}, toFloat3(lighting.sun.colour), 1.0f, n, to_eye, s.shininess);
    for (const PointLight& light : lighting.points) {
        const Float3 to{light.position[0] - position.x, light.position[1] - position.y,
                        light.position[2] - position.z};
        const float d2 = larger(dot(to, to), 1e-12f);
        const Float3 direction = scale(to, 1.0f / std::sqrt(d2));
        addLight(lit, direction, toFloat3(light.colour), 1.0f / d2, n, to_eye, s.shininess);
    }
    return lit;
}

// ---- output ----------------------------------------------------------------------------------

uint32_t packOctahedral(const Float3& n) {
    const float sum = larger((std::fabs(n.x) + std::fabs(n.y)) + std::fabs(n.z), kTiny);
    const float inv = 1.0f / sum;
    const float px = n.x * inv, py = n.y * inv;
    float u = px, v = py;
    if (n.z < 0.0f) {
        u = (1.0f - std::fabs(py)) * (px < 0.0f ? -1.0f : 1.0f);
        v = (1.0f - std::fabs(px)) * (py < 0.0f ? -1.0f : 1.0f);
    }
    const auto snorm = [](float f) {
        return f == f ? uint32_t(roundToInt(f * kSnormScale)) & 0xFFFFu : 0u;
    };
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

Float3 surfaceAlbedo(const Surface& s, const TextureCoordinates& c) {
    const Float3 albedo = toFloat3(s.material->diffuse);
    if (s.colour == nullptr) {
        return albedo;
    }
    const Float3 texel = sampleTexture<true>(*s.colour, c, s.mip_bias_fx8);
    return {albedo.x * (texel.x * kTexelToLinear), albedo.y * (texel.y * kTexelToLinear),
            albedo.z * (texel.z * kTexelToLinear)};
}

Float3 surfaceColour(const TileContext& tile, const PixelBarycentrics& p, const Surface& s,
                     const InstanceSetup& instance, const Float3& n, const Float3& albedo) {
    const Material& m = *s.material;
    const Lit lit = lightSurface(tile, p, s, instance, n);
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

bool alphaPasses(const TileContext& tile, const ShadeTriangle& t, int x, int y) {
    const Surface& s = tile.frame->surfaces[t.surface];
    float alpha = s.material->opacity;
    if (s.alpha != nullptr) {
        const PixelBarycentrics p = barycentricsAt(t, x, y);
        const TextureCoordinates c =
            displacedCoordinates(*tile.frame, p, s, textureCoordinates(p, s));
        alpha = alpha * sampleAlpha(*s.alpha, c, s.mip_bias_fx8);
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
    Float3 albedo{0, 0, 0};
    uint16_t id = 0;
    uint32_t normal = 0;
    bool own_motion = false;
    if (triangle != nullptr) {
        const Surface& s = frame.surfaces[triangle->surface];
        const InstanceSetup& instance = frame.instances[s.instance];
        const PixelBarycentrics p = barycentricsAt(*triangle, x, y);
        TextureCoordinates c{};
        if ((s.features & (kShadeTexture | kShadeNormalMap)) != 0) {
            c = displacedCoordinates(frame, p, s, textureCoordinates(p, s));
        }
        const Float3 n = shadingNormal(p, s, instance, c);
        albedo = surfaceAlbedo(s, c);
        colour = surfaceColour(tile, p, s, instance, n, albedo);
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
    if (tile.planes.albedo_red != nullptr) {
        tile.planes.albedo_red[at] = toFx12(albedo.x);
        tile.planes.albedo_green[at] = toFx12(albedo.y);
        tile.planes.albedo_blue[at] = toFx12(albedo.z);
    }
    if (tile.planes.normal != nullptr) {
        tile.planes.normal[at] = normal;
    }
    if (tile.planes.motion != nullptr && !own_motion) {
        storeMotion(tile, at, reprojectStatic(tile, x, y, depth));
    } else if (tile.planes.motion == nullptr && tile.planes.depth_before != nullptr) {
        tile.planes.depth_before[at] = logDepth16(std::bit_cast<uint32_t>(depth));
    }
}

}  // namespace still::internal
