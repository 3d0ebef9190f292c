// Directions are drawn, rays are made for all points of a batch, traced, and what was not in
// shadow is added.

#include <algorithm>
#include <cmath>

#include "rasterizer/draw_list_check.h"
#include "rasterizer/internal/light_scene.h"
#include "rasterizer/internal/sun_map.h"

namespace still::internal {

namespace {

constexpr float kFarAway = 1e30f;
/// Rays to an area light end a little before it, so that a model of the lamp does not cast its
/// light's shadow.
constexpr float kBeforeLight = 1.0f - 1.0f / 1024.0f;
constexpr float kQuarterPi = 0.785398163f;

Float3 operator+(const Float3& a, const Float3& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}

Float3 operator-(const Float3& a, const Float3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

/// Taylor's polynomials, |x| ≤ π/4: errors below 4e-7.
float sineOf(float x) {
    const float x2 = x * x;
    return x * (1.0f + x2 * (-1.0f / 6.0f + x2 * (1.0f / 120.0f - x2 * (1.0f / 5040.0f))));
}

float cosineOf(float x) {
    const float x2 = x * x;
    return 1.0f + x2 * (-0.5f + x2 * (1.0f / 24.0f + x2 * (-1.0f / 720.0f + x2 / 40320.0f)));
}

/// Rays of a batch, and what each of them brings if nothing is in its way.
struct Shadows {
    int count = 0;
    int point[kLightBatch];
    Ray rays[kLightBatch];
    Float3 diffuse[kLightBatch], highlight[kLightBatch];
    uint8_t blocked[kLightBatch];

    void add(int p, const Ray& ray, const Float3& light, const Float3& shine) {
        point[count] = p;
        rays[count] = ray;
        diffuse[count] = light;
        highlight[count++] = shine;
    }
    /// `together`: from pixels side by side, not from what their bounces hit.
    void trace(const LightScene& scene, LightBatch& batch, bool together) {
        const auto occluded = together ? scene.trace.occludedTogether : scene.trace.occluded;
        occluded(scene.tree, rays, count, blocked);
        light(batch);
    }
    void lookUp(const SunMap& map, LightBatch& batch) {
        for (int i = 0; i < count; ++i) {
            const int p = point[i];
            blocked[i] =
                map.blocks(batch.points[p], rays[i], batch.random[kRandomHoles][p]) ? 1 : 0;
        }
        light(batch);
    }
    /// Adds what nothing is in the way of.
    void light(LightBatch& batch) const {
        for (int i = 0; i < count; ++i) {
            if (blocked[i] == 0) {
                batch.direct[point[i]] = batch.direct[point[i]] + diffuse[i];
                batch.highlight[point[i]] = batch.highlight[point[i]] + highlight[i];
            }
        }
    }
};

bool areWithin(const Float3& v, float limit) {
    return within(v.x, limit) && within(v.y, limit) && within(v.z, limit);
}

/// From what is nowhere, or to there, a ray that ends before it begins and hits nothing.
Ray rayFrom(const LitPoint& point, const Float3& direction, float end, uint32_t random) {
    if (!areWithin(point.origin, kMaxPosition) || !areWithin(direction, 2.0f) ||
        !(end <= kFarAway)) {
        return {{0, 0, 0}, -1.0f, {0, 0, 1}, random};
    }
    return {{point.origin.x, point.origin.y, point.origin.z},
            end,
            {direction.x, direction.y, direction.z},
            random};
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

/// Blinn-Phong, as shade_reference.cpp has it.
Float3 highlightOf(const LitPoint& point, const Float3& to_light, const Float3& light) {
    if (point.shininess == 0) {
        return {0, 0, 0};
    }
    const Float3 half = normalized(to_light + point.to_eye);
    return scale(light, power(std::max(dot(point.normal, half), 0.0f), point.shininess));
}

void addSun(const LightScene& scene, RandomUse use, const LightBatch& batch, Shadows& shadows) {
    for (int i = 0; i < batch.count; ++i) {
        const LitPoint& point = batch.points[i];
        const DiscPoint at = toDisc(batch.random[use][i]);
        const Float3 direction = normalized(
            scene.to_sun + (scale(scene.sun_across_u, at.x) + scale(scene.sun_across_v, at.y)));
        const float cosine = dot(point.normal, direction);
        if (cosine > 0.0f) {
            shadows.add(i, rayFrom(point, direction, kFarAway, batch.random[kRandomHoles][i].x),
                        scale(scene.sun_colour, cosine),
                        highlightOf(point, direction, scene.sun_colour));
        }
    }
}

// ---- area lights -----------------------------------------------------------------------------

/// A direction towards a light, how far it is, and what comes from there.
struct LightDraw {
    Float3 direction{};
    float distance = 0.0f;
    float strength = 0.0f;  ///< factor on the light's colour; 0: nothing comes
};

/// Evenly in the cone that the sphere fills.
LightDraw drawSphere(const AreaLight& light, const LitPoint& point, const RandomPair& random) {
    const Float3 to = light.centre - point.origin;
    const float r2 = light.radius * light.radius;
    const float d2 = std::max(dot(to, to), r2 * 1.0001f);
    const float sine2 = r2 / d2;
    const float cone = sine2 / (1.0f + std::sqrt(1.0f - sine2));  // 1 − cosine of its edge
    const DiscPoint at = toDisc(random);
    const float h = (at.x * at.x + at.y * at.y) * cone;  // 1 − cosine of the draw
    const float sine = std::sqrt(cone * (2.0f - h));     // over the radius in the disc
    const Float3 axis = normalized(to);
    Float3 u, v;
    acrossOf(axis, u, v);
    LightDraw draw;
    draw.direction = scale(axis, 1.0f - h) + (scale(u, at.x * sine) + scale(v, at.y * sine));
    const float along = dot(draw.direction, to);
    const float inside = std::max(r2 - (dot(to, to) - along * along), 0.0f);
    draw.distance = along - std::sqrt(inside);
    draw.strength = 2.0f * cone / r2;
    return draw;
}

/// Evenly on the rectangle.
LightDraw drawRectangle(const AreaLight& light, const LitPoint& point, const RandomPair& random) {
    const float a = toUnit(random.x) - 0.5f, b = toUnit(random.y) - 0.5f;
    const Float3 to =
        (light.centre - point.origin) + (scale(light.edge_u, a) + scale(light.edge_v, b));
    const float d2 = std::max(dot(to, to), kTiny);
    LightDraw draw;
    draw.distance = std::sqrt(d2);
    draw.direction = scale(to, 1.0f / draw.distance);
    draw.strength = std::max(-dot(draw.direction, light.normal), 0.0f) / d2;
    return draw;
}

/// How likely a light is drawn: about what it would bring without shadows; above 0 wherever it
/// brings anything.
float importance(const AreaLight& light, const LitPoint& point) {
    const Float3 to = light.centre - point.origin;
    const float d2 = dot(to, to), r2 = light.radius * light.radius;
    const float d = std::sqrt(std::max(d2, kTiny));
    const float above = dot(point.normal, to) + light.radius;
    const bool behind = !light.sphere && dot(light.normal, to) >= light.radius;
    if (!(above > 0.0f) || behind) {
        return 0.0f;
    }
    return light.luminance * std::min(above, d) / (d * std::max(d2, r2));
}

/// The light that `random` falls on; `chance` of it. Null where none brings anything.
const AreaLight* pickLight(const std::vector<AreaLight>& lights, const LitPoint& point,
                           uint32_t random, float& chance) {
    if (lights.size() == 1) {
        chance = 1.0f;
        return lights.data();
    }
    float total = 0.0f;
    for (const AreaLight& light : lights) {
        total = total + importance(light, point);
    }
    const float wanted = toUnit(random) * total;
    float sum = 0.0f;
    const AreaLight* picked = nullptr;
    for (const AreaLight& light : lights) {
        const float weight = importance(light, point);
        if (weight > 0.0f) {
            picked = &light;
            chance = weight / total;
            sum = sum + weight;
            if (wanted < sum) {
                break;
            }
        }
    }
    return picked;
}

void addAreaLights(const LightScene& scene, RandomUse use, bool second_pick,
                   const LightBatch& batch, Shadows& shadows) {
    for (int i = 0; i < batch.count; ++i) {
        const LitPoint& point = batch.points[i];
        const RandomPair& pick = batch.random[kRandomPick][i];
        float chance = 1.0f;
        const AreaLight* light =
            pickLight(scene.lights, point, second_pick ? pick.y : pick.x, chance);
        if (light == nullptr) {
            continue;
        }
        const LightDraw draw = light->sphere ? drawSphere(*light, point, batch.random[use][i])
                                             : drawRectangle(*light, point, batch.random[use][i]);
        const float cosine = dot(point.normal, draw.direction);
        if (cosine > 0.0f && draw.strength > 0.0f) {
            const Float3 bright = scale(light->colour, draw.strength / chance);
            shadows.add(i,
                        rayFrom(point, draw.direction, draw.distance * kBeforeLight,
                                batch.random[kRandomHoles][i].x),
                        scale(bright, cosine), highlightOf(point, draw.direction, bright));
        }
    }
}

// ---- indirect light --------------------------------------------------------------------------

void addOcclusion(const LightScene& scene, LightBatch& batch) {
    Ray rays[kLightBatch];
    uint8_t blocked[kLightBatch];
    const Lighting& lighting = scene.list->lighting;
    for (int i = 0; i < batch.count; ++i) {
        const LitPoint& point = batch.points[i];
        rays[i] = rayFrom(point, drawHemisphere(point.normal, batch.random[kRandomHemisphere][i]),
                          lighting.sampled.occlusion_distance, batch.random[kRandomHoles][i].y);
    }
    scene.trace.occludedTogether(scene.tree, rays, batch.count, blocked);
    const Float3 ambient{lighting.ambient[0], lighting.ambient[1], lighting.ambient[2]};
    for (int i = 0; i < batch.count; ++i) {
        batch.indirect[i] = blocked[i] != 0 ? Float3{0, 0, 0} : ambient;
    }
}

void clear(LightBatch& batch) {
    for (int i = 0; i < batch.count; ++i) {
        batch.direct[i] = batch.indirect[i] = batch.highlight[i] = {0, 0, 0};
    }
}

void addBounce(const LightScene& scene, LightBatch& batch, LightBatch& hits) {
    Ray rays[kLightBatch];
    RayHit hit[kLightBatch];
    for (int i = 0; i < batch.count; ++i) {
        const LitPoint& point = batch.points[i];
        rays[i] = rayFrom(point, drawHemisphere(point.normal, batch.random[kRandomHemisphere][i]),
                          kFarAway, batch.random[kRandomHoles][i].y);
    }
    scene.trace.closest(scene.tree, rays, batch.count, hit);
    const Lighting& lighting = scene.list->lighting;
    int owner[kLightBatch];
    Float3 albedo[kLightBatch];
    hits.count = 0;
    for (int i = 0; i < batch.count; ++i) {
        if (hit[i].instance == kNothingHit) {
            batch.indirect[i] = {lighting.ambient[0], lighting.ambient[1], lighting.ambient[2]};
            continue;
        }
        const int h = hits.count++;
        owner[h] = i;
        for (RandomUse use : {kRandomHitSun, kRandomHitLight, kRandomPick, kRandomHoles}) {
            hits.random[use][h] = batch.random[use][i];
        }
    }
    surfacesAt(scene, rays, hit, owner, hits.count, hits.points, albedo);
    clear(hits);
    if (lighting.sampled.sun_shadow != SunShadow::none) {
        Shadows shadows;
        addSun(scene, kRandomHitSun, hits, shadows);
        shadows.trace(scene, hits, false);
    }
    if (!scene.lights.empty()) {
        Shadows shadows;
        addAreaLights(scene, kRandomHitLight, true, hits, shadows);
        shadows.trace(scene, hits, false);
    }
    for (int h = 0; h < hits.count; ++h) {
        const Float3 light = hits.direct[h] + plainLight(lighting, hits.points[h]);
        batch.indirect[owner[h]] = {albedo[h].x * light.x, albedo[h].y * light.y,
                                    albedo[h].z * light.z};
    }
}

}  // namespace

void acrossOf(const Float3& n, Float3& u, Float3& v) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z);
    const float b = n.x * n.y * a;
    u = {1.0f + sign * (n.x * n.x * a), sign * b, -(sign * n.x)};
    v = {b, sign + n.y * n.y * a, -n.y};
}

DiscPoint toDisc(const RandomPair& random) {
    const float a = toUnit(random.x) * 2.0f - 1.0f, b = toUnit(random.y) * 2.0f - 1.0f;
    if (std::fabs(a) > std::fabs(b)) {
        const float angle = kQuarterPi * (b / a);
        return {a * cosineOf(angle), a * sineOf(angle)};
    }
    const float angle = b != 0.0f ? kQuarterPi * (a / b) : 0.0f;
    return {b * sineOf(angle), b * cosineOf(angle)};  // of π/2 − angle
}

Float3 drawHemisphere(const Float3& normal, const RandomPair& random) {
    const DiscPoint at = toDisc(random);
    const float z = std::sqrt(std::max(1.0f - (at.x * at.x + at.y * at.y), 1e-6f));
    Float3 u, v;
    acrossOf(normal, u, v);
    return scale(normal, z) + (scale(u, at.x) + scale(v, at.y));
}

void lightBatch(const LightScene& scene, LightBatch& batch, LightBatch& scratch) {
    const SampledLight& sampled = scene.list->lighting.sampled;
    clear(batch);
    if (sampled.sun_shadow == SunShadow::traced) {
        Shadows shadows;
        addSun(scene, kRandomSun, batch, shadows);
        shadows.trace(scene, batch, true);
    }
    if (sampled.sun_shadow == SunShadow::mapped) {
        Shadows shadows;
        addSun(scene, kRandomSun, batch, shadows);
        shadows.lookUp(*scene.sun_map, batch);
    }
    if (!scene.lights.empty()) {
        Shadows shadows;
        addAreaLights(scene, kRandomLight, false, batch, shadows);
        shadows.trace(scene, batch, true);
    }
    if (sampled.ambient == AmbientLight::traced_occlusion) {
        addOcclusion(scene, batch);
    } else if (sampled.ambient == AmbientLight::bounce) {
        addBounce(scene, batch, scratch);
    } else if (sampled.ambient == AmbientLight::screen_occlusion) {
        const std::array<float, 3>& ambient = scene.list->lighting.ambient;
        std::fill_n(batch.indirect, batch.count, Float3{ambient[0], ambient[1], ambient[2]});
    }
}

}  // namespace still::internal
