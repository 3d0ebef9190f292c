// What a ray of a bounce hits: place, normal, albedo, and the light there that needs no ray.

#include <algorithm>
#include <cmath>

#include "rasterizer/internal/light_scene.h"
#include "rasterizer/internal/shading_constants.h"

namespace still::internal {

namespace {

/// Rays leave a surface this part of its largest coordinate and of the way to it above it.
constexpr float kLift = 1.0f / (1 << 16);
/// Levels larger than this are not looked at: a bounce gathers from all around, fine detail is only
/// noise to it, and small levels stay in cache.
constexpr uint32_t kLargestLevel = 64;

Float3 plus(const Float3& a, const Float3& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}

Float3 minus(const Float3& a, const Float3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

/// The nearest texel of the level.
Float3 texelOf(const Texture& texture, float u, float v) {
    size_t l = 0;
    while (l + 1 < texture.levels.size() &&
           std::max(texture.levels[l].width, texture.levels[l].height) > kLargestLevel) {
        ++l;
    }
    const TextureLevel& level = texture.levels[l];
    const auto along = [&](float c, uint32_t size) {
        const float wrapped =
            texture.wrap == Wrap::repeat ? c - std::floor(c) : std::min(std::max(c, 0.0f), 1.0f);
        return uint32_t(std::min(int(wrapped * float(int32_t(size))), int(size) - 1));
    };
    const uint32_t texel =
        texture.texels[level.offset + along(1.0f - v, level.height) * level.stride +
                       along(u, level.width)];
    Float3 linear;
    float* channel[3] = {&linear.x, &linear.y, &linear.z};
    for (int c = 0; c < 3; ++c) {
        const float t = float(int32_t(texel >> (10 * c) & kTexelMask));
        *channel[c] = (t * t) * kTexelToLinear;
    }
    return linear;
}

Float3 albedoOf(const DrawList& list, const Mesh& mesh, const uint32_t* index, const float b[3],
                const Material& material) {
    const Float3 diffuse{material.diffuse[0], material.diffuse[1], material.diffuse[2]};
    if (material.colour_texture == kNoTexture) {
        return diffuse;
    }
    const auto& a = mesh.attributes;
    const float u =
        ((b[0] * a[index[0]].u + b[1] * a[index[1]].u) + b[2] * a[index[2]].u) + material.u_offset;
    const float v =
        ((b[0] * a[index[0]].v + b[1] * a[index[1]].v) + b[2] * a[index[2]].v) + material.v_offset;
    const Float3 texel = texelOf(list.textures[size_t(material.colour_texture)], u, v);
    return {diffuse.x * texel.x, diffuse.y * texel.y, diffuse.z * texel.z};
}

/// Interpolated vertex normal in the world, of any length.
Float3 vertexNormal(const InstanceTree& instance, const uint32_t* index, const float b[3]) {
    const auto& a = instance.mesh->attributes;
    if (a.empty()) {
        return {0, 0, 0};
    }
    const Float3 n{(b[0] * a[index[0]].nx + b[1] * a[index[1]].nx) + b[2] * a[index[2]].nx,
                   (b[0] * a[index[0]].ny + b[1] * a[index[1]].ny) + b[2] * a[index[2]].ny,
                   (b[0] * a[index[0]].nz + b[1] * a[index[1]].nz) + b[2] * a[index[2]].nz};
    if (instance.identity) {
        return n;
    }
    const float* m = instance.to_object;  // its transpose turns normals into the world
    return {(m[0] * n.x + m[4] * n.y) + m[8] * n.z, (m[1] * n.x + m[5] * n.y) + m[9] * n.z,
            (m[2] * n.x + m[6] * n.y) + m[10] * n.z};
}

}  // namespace

Float3 surfaceAt(const LightScene& scene, const Ray& ray, const RayHit& hit, LitPoint& point) {
    const InstanceTree& instance = scene.tree.instances[hit.instance];
    const Mesh& mesh = *instance.mesh;
    const uint32_t* index = &mesh.indices[size_t(hit.triangle) * 3];
    const float b[3] = {(1.0f - hit.b1) - hit.b2, hit.b1, hit.b2};
    Float3 p[3];
    for (int c = 0; c < 3; ++c) {
        p[c] = {mesh.x[index[c]], mesh.y[index[c]], mesh.z[index[c]]};
        if (!instance.identity) {
            p[c] = transformPoint(scene.list->instances[hit.instance].transform, p[c]);
        }
    }
    const Float3 place = plus(plus(scale(p[0], b[0]), scale(p[1], b[1])), scale(p[2], b[2]));
    // The side that the ray came from.
    const Float3 direction{ray.direction[0], ray.direction[1], ray.direction[2]};
    Float3 flat = normalized(cross(minus(p[1], p[0]), minus(p[2], p[0])));
    flat = dot(flat, direction) > 0.0f ? scale(flat, -1.0f) : flat;
    Float3 n = normalized(vertexNormal(instance, index, b));
    n = dot(n, n) > 0.5f ? n : flat;
    point.normal = dot(n, flat) < 0.0f ? scale(n, -1.0f) : n;
    const float lift = kLift * std::max(std::max(std::fabs(place.x), std::fabs(place.y)),
                                        std::max(std::fabs(place.z), hit.t));
    point.origin = plus(place, scale(flat, lift));
    point.shininess = 0;
    const auto part = std::upper_bound(
        mesh.parts.begin(), mesh.parts.end(), hit.triangle,
        [](uint32_t t, const MeshPart& q) { return t < q.first_triangle + q.triangle_count; });
    return albedoOf(*scene.list, mesh, index, b, scene.list->materials[part->material]);
}

Float3 plainLight(const Lighting& lighting, const LitPoint& point) {
    Float3 sum{0, 0, 0};
    const auto add = [&](const std::array<float, 3>& colour, float factor) {
        sum = {sum.x + colour[0] * factor, sum.y + colour[1] * factor, sum.z + colour[2] * factor};
    };
    if (lighting.sampled.sun_shadow == SunShadow::none) {
        const auto& d = lighting.sun.direction;
        add(lighting.sun.colour, std::max(-dot(point.normal, {d[0], d[1], d[2]}), 0.0f));
    }
    for (const PointLight& light : lighting.points) {
        const Float3 to =
            minus({light.position[0], light.position[1], light.position[2]}, point.origin);
        const float d2 = std::max(dot(to, to), 1e-12f);
        add(light.colour, std::max(dot(point.normal, to), 0.0f) / (std::sqrt(d2) * d2));
    }
    return sum;
}

}  // namespace still::internal
