#include "rasterizer/internal/light_setup.h"

#include <algorithm>
#include <cmath>

#include "rasterizer/fixed.h"

namespace still::internal {

namespace {

Float3 toFloat3(const std::array<float, 3>& a) {
    return {a[0], a[1], a[2]};
}

float luminanceOf(const Float3& c) {
    return (0.2126f * c.x + 0.7152f * c.y) + 0.0722f * c.z;
}

}  // namespace

/// Numbers are drawn for the rays that there are, and no others.
static uint32_t usesOf(const SampledLight& sampled) {
    const bool bounce = sampled.ambient == AmbientLight::bounce;
    uint32_t uses = 1u << kRandomHoles;
    const auto add = [&](bool wanted, RandomUse use) { uses |= wanted ? 1u << use : 0u; };
    const bool areas = !sampled.spheres.empty() || !sampled.rectangles.empty();
    add(sampled.sun_shadow != SunShadow::none, kRandomSun);
    add(areas, kRandomLight);
    add(sampled.spheres.size() + sampled.rectangles.size() > 1, kRandomPick);
    add(sampled.ambient != AmbientLight::plain, kRandomHemisphere);
    add(bounce && sampled.sun_shadow != SunShadow::none, kRandomHitSun);
    add(bounce && areas, kRandomHitLight);
    return uses;
}

bool traces(const SampledLight& sampled) {
    return sampled.sun_shadow == SunShadow::traced || !sampled.spheres.empty() ||
           !sampled.rectangles.empty() || sampled.ambient == AmbientLight::traced_occlusion ||
           sampled.ambient == AmbientLight::bounce;
}

void TreeKeeper::update(const DrawList& list, SceneTree& tree, Workers& workers) {
    const bool other = meshes_of_ != list.meshes.data() || meshes_.size() != list.meshes.size();
    if (other) {
        meshes_of_ = list.meshes.data();
        meshes_.assign(list.meshes.size(), {});
        workers.parallelFor(int(meshes_.size()), 1, [&](int begin, int end, int) {
            for (size_t i = size_t(begin); i < size_t(end); ++i) {
                const Mesh& mesh = list.meshes[i];
                std::vector<uint8_t> holes;
                for (const MeshPart& part : mesh.parts) {
                    const bool any = list.materials[part.material].alpha_mode != AlphaMode::opaque;
                    holes.push_back(any ? 1 : 0);
                }
                buildMeshTree(mesh, holes, meshes_[i]);
            }
        });
    }
    const bool stays =
        !other && std::equal(transforms_.begin(), transforms_.end(), list.instances.begin(),
                             list.instances.end(), [](const Affine& a, const Instance& instance) {
                                 return a == instance.transform;
                             });
    if (!stays) {
        transforms_.clear();
        for (const Instance& instance : list.instances) {
            transforms_.push_back(instance.transform);
        }
        buildSceneTree(list, meshes_, tree);
    }
    tree.list = &list;
}

void setUpLights(const DrawList& list, LightScene& scene) {
    scene.list = &list;
    scene.random_uses = usesOf(list.lighting.sampled);
    const SampledLight& sampled = list.lighting.sampled;
    scene.lights.clear();
    for (const SphereLight& sphere : sampled.spheres) {
        AreaLight light;
        light.sphere = true;
        light.centre = toFloat3(sphere.position);
        light.colour = toFloat3(sphere.colour);
        light.radius = sphere.radius;
        scene.lights.push_back(light);
    }
    for (const RectangleLight& rectangle : sampled.rectangles) {
        AreaLight light;
        light.centre = toFloat3(rectangle.centre);
        light.colour = toFloat3(rectangle.colour);
        light.edge_u = toFloat3(rectangle.edge_u);
        light.edge_v = toFloat3(rectangle.edge_v);
        light.normal = normalized(cross(light.edge_u, light.edge_v));
        light.radius =
            0.5f * std::sqrt(dot(light.edge_u, light.edge_u) + dot(light.edge_v, light.edge_v));
        scene.lights.push_back(light);
    }
    for (AreaLight& light : scene.lights) {
        light.luminance = luminanceOf(light.colour);
    }
    scene.surfaces.assign(1, {});
    for (uint32_t i = 0; i < list.instances.size(); ++i) {
        for (const MeshPart& part : list.meshes[list.instances[i].mesh].parts) {
            const Material& m = list.materials[part.material];
            LitSurface surface{.instance = i, .specular = toFloat3(m.specular)};
            if (m.specular[0] > 0.0f || m.specular[1] > 0.0f || m.specular[2] > 0.0f) {
                surface.shininess = roundToInt(std::clamp(m.shininess, 1.0f, 1024.0f));
            }
            scene.surfaces.push_back(surface);
        }
    }
    const Float3 sun = toFloat3(list.lighting.sun.direction);
    const float tangent = sampled.sun_tangent;
    scene.to_sun = scale(sun, -1.0f);
    acrossOf(scene.to_sun, scene.sun_across_u, scene.sun_across_v);
    scene.sun_across_u = scale(scene.sun_across_u, tangent);
    scene.sun_across_v = scale(scene.sun_across_v, tangent);
    // One over the mean cosine between the disc's middle and its points.
    scene.sun_colour = scale(toFloat3(list.lighting.sun.colour),
                             0.5f * (std::sqrt(1.0f + tangent * tangent) + 1.0f));
}

void LightState::take(const DrawList& list) {
    lighting = list.lighting;
    materials.assign(list.materials.begin(), list.materials.end());
}

bool LightState::same(const DrawList& list) const {
    const Lighting& a = lighting;
    const Lighting& b = list.lighting;
    const SampledLight& s = a.sampled;
    const SampledLight& t = b.sampled;
    const auto samePoint = [](const PointLight& p, const PointLight& q) {
        return p.position == q.position && p.colour == q.colour;
    };
    const auto sameSphere = [](const SphereLight& p, const SphereLight& q) {
        return p.position == q.position && p.radius == q.radius && p.colour == q.colour;
    };
    const auto sameRectangle = [](const RectangleLight& p, const RectangleLight& q) {
        return p.centre == q.centre && p.edge_u == q.edge_u && p.edge_v == q.edge_v &&
               p.colour == q.colour;
    };
    return a.ambient == b.ambient && a.sun.direction == b.sun.direction &&
           a.sun.colour == b.sun.colour && s.sun_shadow == t.sun_shadow &&
           s.sun_tangent == t.sun_tangent && s.ambient == t.ambient &&
           s.occlusion_distance == t.occlusion_distance &&
           std::equal(a.points.begin(), a.points.end(), b.points.begin(), b.points.end(),
                      samePoint) &&
           std::equal(s.spheres.begin(), s.spheres.end(), t.spheres.begin(), t.spheres.end(),
                      sameSphere) &&
           std::equal(s.rectangles.begin(), s.rectangles.end(), t.rectangles.begin(),
                      t.rectangles.end(), sameRectangle) &&
           std::equal(materials.begin(), materials.end(), list.materials.begin(),
                      list.materials.end());
}

Carry carryOf(const Instance& instance) {
    Carry carry;
    carry.moved = instance.moved;
    if (!carry.moved) {
        return carry;
    }
    const Matrix before = inverse(fromAffine(instance.transform_before));
    const Matrix m = fromAffine(instance.transform) * before;
    for (size_t i = 0; i < 12; ++i) {
        carry.points[i] = float(m.m[i / 4][i % 4]);
    }
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {  // cofactors: inverse transpose up to a factor
            const int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
            carry.normals[r * 3 + c] = float(m.m[r1][c1] * m.m[r2][c2] - m.m[r1][c2] * m.m[r2][c1]);
        }
    }
    return carry;
}

namespace {

/// Snapping moves a surface by up to 1/512 pixel in x and in y; rounding by some 2^-22 of its
/// coordinates.
constexpr double kLiftPixels = 1.0 / 64.0;
constexpr double kLiftPart = 1.0 / (1 << 19);

}  // namespace

PixelRays::PixelRays(const FrameView& view)
    : to_world_(
          inverse(toPixels(reverseDepth(fromGlm(view.view_projection)), view.width, view.height))),
      offset_x_((kSubpixelHalf + view.jitter_x_fx8) / double(kSubpixelOne)),
      offset_y_((kSubpixelHalf + view.jitter_y_fx8) / double(kSubpixelOne)),
      eye_{view.eye.x, view.eye.y, view.eye.z} {
    const auto& m = to_world_.m;
    pixel_size_ = std::sqrt((m[0][0] * m[0][0] + m[1][0] * m[1][0]) + m[2][0] * m[2][0]);
}

LitPoint PixelRays::pointAt(int x, int y, float depth, const Float3& normal) const {
    const double px = x + offset_x_, py = y + offset_y_, z = double(depth);
    double q[4];
    for (int r = 0; r < 4; ++r) {
        const double* m = to_world_.m[r];
        q[r] = (m[0] * px + m[1] * py) + (m[2] * z + m[3]);
    }
    const double w = 1.0 / q[3];
    const double p[3] = {q[0] * w, q[1] * w, q[2] * w};
    LitPoint point;
    const Float3 place{float(p[0]), float(p[1]), float(p[2])};
    point.normal = normal;
    const double largest = std::max({std::fabs(p[0]), std::fabs(p[1]), std::fabs(p[2])});
    const float lift = float(pixel_size_ * w * kLiftPixels + largest * kLiftPart);
    point.to_eye = normalized({eye_.x - place.x, eye_.y - place.y, eye_.z - place.z});
    // Along the normal, which may be bent away from the surface's own, and towards the eye, which
    // sees the surface and is therefore on its right side.
    point.origin = {place.x + (2.0f * normal.x + point.to_eye.x) * lift,
                    place.y + (2.0f * normal.y + point.to_eye.y) * lift,
                    place.z + (2.0f * normal.z + point.to_eye.z) * lift};
    return point;
}

}  // namespace still::internal
