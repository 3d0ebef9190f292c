#pragma once
// What the light sampler knows of a frame, and the light of a batch of points.

#include <vector>

#include "rasterizer/internal/light_random.h"
#include "rasterizer/internal/surface_reference.h"
#include "rasterizer/internal/trace.h"

namespace still::internal {

/// A sphere or a rectangle.
struct AreaLight {
    bool sphere = false;
    Float3 centre{}, colour{};
    float radius = 0.0f;  ///< of the sphere; of the circle around the rectangle
    float luminance = 0.0f;
    Float3 edge_u{}, edge_v{}, normal{};  ///< of the rectangle
};

/// What shading reads of a surface, by surface number.
struct LitSurface {
    uint32_t instance = 0;
    int shininess = 0;  ///< 0: no highlight
    Float3 specular{};
};

class SunMap;

struct LightScene {
    SceneTree tree;
    const SunMap* sun_map = nullptr;  ///< with SunShadow::mapped
    TraceKernels trace{};
    const DrawList* list = nullptr;
    std::vector<AreaLight> lights;
    uint32_t random_uses = 0;          ///< bit RandomUse: what is drawn for
    std::vector<LitSurface> surfaces;  ///< [0] is the background
    // Of the sun: towards it, and two directions across of the length of its disc's radius.
    Float3 to_sun{}, sun_across_u{}, sun_across_v{};
    Float3 sun_colour{};  ///< so that the mean over the disc is the light's colour
};

/// A place that light falls on.
struct LitPoint {
    Float3 origin{};  ///< of its rays: a little off the surface
    Float3 normal{};
    Float3 to_eye{};  ///< only with a highlight
    int shininess = 0;
};

/// Points whose rays are traced together.
constexpr int kLightBatch = 64;

/// Points, their random numbers and what light they get. Only the first `count` are used.
struct LightBatch {
    int count = 0;
    LitPoint points[kLightBatch];
    RandomPair random[kRandomUses][kLightBatch];
    Float3 direct[kLightBatch];     ///< without albedo
    Float3 indirect[kLightBatch];   ///< the same
    Float3 highlight[kLightBatch];  ///< without the material's specular colour
};

/// Fills direct, indirect (all of it, with AmbientLight::screen_occlusion) and highlight from
/// points and random numbers. `scratch` is for what the rays of a bounce hit.
void lightBatch(const LightScene& scene, LightBatch& batch, LightBatch& scratch);

/// Two unit vectors across a unit vector (Duff et al. 2017).
void acrossOf(const Float3& n, Float3& u, Float3& v);

/// Evenly in the unit disc (Shirley and Chiu 1997).
struct DiscPoint {
    float x, y;
};
DiscPoint toDisc(const RandomPair& random);

/// In the hemisphere, with a density that goes with the cosine.
Float3 drawHemisphere(const Float3& normal, const RandomPair& random);

// ---- what a ray hits -------------------------------------------------------------------------

/// The surfaces that rays which[0] … which[count − 1] hit, as points to be lit, and their albedo.
/// At most kLightBatch.
void surfacesAt(const LightScene& scene, const Ray* rays, const RayHit* hits, const int* which,
                int count, LitPoint* points, Float3* albedos);

/// Light that needs no ray: the sun and point lights without shadows.
Float3 plainLight(const Lighting& lighting, const LitPoint& point);

}  // namespace still::internal
