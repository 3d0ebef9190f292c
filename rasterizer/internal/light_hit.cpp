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

/// Asks for memory that is read soon: what bounces hit lies anywhere, and many wait better
/// together than one by one.
void fetch(const void* memory) {
#if defined(__GNUC__)
    __builtin_prefetch(memory);
#else
    (void)memory;
#endif
}

/// What a ray hit, while its memory is on the way.
struct HitSurface {
    const InstanceTree* instance;
    const uint32_t* index;  ///< of the corners
    const Material* material;
    const uint32_t* texel;  ///< null without a texture
};

/// The nearest texel of a level that is small enough.
const uint32_t* texelOf(const Texture& texture, float u, float v) {
    size_t l = 0;
    while (l + 1 < texture.levels.size() &&
           std::max(texture.levels[l].width, texture.levels[l].height) > kLargestLevel) {
        ++l;
    }
    const TextureLevel& level = texture.levels[l];
    const auto along = [&](float c, uint32_t size) {
        const float wrapped =
            texture.wrap == Wrap::repeat ? c - std::floor(c) : std::min(std::max(c, 0.0f), 1.0f);
        const float at = wrapped <= 1.0f ? wrapped : 0.0f;  // not a number
        return uint32_t(std::min(int(at * float(int32_t(size))), int(size) - 1));
    };
    return &texture.texels[level.offset + along(1.0f - v, level.height) * level.stride +
                           along(u, level.width)];
}

const uint32_t* texelAt(const DrawList& list, const HitSurface& hit, const float b[3]) {
    const Material& material = *hit.material;
    if (material.colour_texture == kNoTexture) {
        return nullptr;
    }
    const VertexAttributes* a = hit.instance->mesh->attributes.data();
    const VertexAttributes &c0 = a[hit.index[0]], &c1 = a[hit.index[1]], &c2 = a[hit.index[2]];
    const float u = ((b[0] * c0.u + b[1] * c1.u) + b[2] * c2.u) + material.u_offset;
    const float v = ((b[0] * c0.v + b[1] * c1.v) + b[2] * c2.v) + material.v_offset;
    return texelOf(list.textures[size_t(material.colour_texture)], u, v);
}

Float3 albedoOf(const HitSurface& hit) {
    const auto& kd = hit.material->diffuse;
    if (hit.texel == nullptr) {
        return {kd[0], kd[1], kd[2]};
    }
    float linear[3];
    for (int c = 0; c < 3; ++c) {
        const float t = float(int32_t(*hit.texel >> (10 * c) & kTexelMask));
        linear[c] = (t * t) * kTexelToLinear;
    }
    return {kd[0] * linear[0], kd[1] * linear[1], kd[2] * linear[2]};
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

/// Place and normal, on the side that the ray came from.
LitPoint pointAt(const DrawList& list, const HitSurface& surface, const Ray& ray, const RayHit& hit,
                 const float b[3]) {
    const InstanceTree& instance = *surface.instance;
    const Mesh& mesh = *instance.mesh;
    Float3 p[3];
    for (int c = 0; c < 3; ++c) {
        const uint32_t vertex = surface.index[c];
        p[c] = {mesh.x[vertex], mesh.y[vertex], mesh.z[vertex]};
        if (!instance.identity) {
            p[c] = transformPoint(list.instances[hit.instance].transform, p[c]);
        }
    }
    const Float3 place = plus(plus(scale(p[0], b[0]), scale(p[1], b[1])), scale(p[2], b[2]));
    const Float3 direction{ray.direction[0], ray.direction[1], ray.direction[2]};
    Float3 flat = normalized(cross(minus(p[1], p[0]), minus(p[2], p[0])));
    flat = dot(flat, direction) > 0.0f ? scale(flat, -1.0f) : flat;
    Float3 n = normalized(vertexNormal(instance, surface.index, b));
    n = dot(n, n) > 0.5f ? n : flat;
    const float largest = std::max(std::max(std::fabs(place.x), std::fabs(place.y)),
                                   std::max(std::fabs(place.z), hit.t));
    LitPoint point;
    point.normal = dot(n, flat) < 0.0f ? scale(n, -1.0f) : n;
    point.origin = plus(place, scale(flat, kLift * largest));
    return point;
}

}  // namespace

void surfacesAt(const LightScene& scene, const Ray* rays, const RayHit* hits, const int* which,
                int count, LitPoint* points, Float3* albedos) {
    HitSurface surfaces[kLightBatch];
    for (int i = 0; i < count; ++i) {
        const RayHit& hit = hits[which[i]];
        HitSurface& s = surfaces[i];
        s.instance = &scene.tree.instances[hit.instance];
        s.index = &s.instance->mesh->indices[size_t(hit.triangle) * 3];
        fetch(s.index);
    }
    for (int i = 0; i < count; ++i) {
        const Mesh& mesh = *surfaces[i].instance->mesh;
        for (int c = 0; c < 3; ++c) {
            const uint32_t vertex = surfaces[i].index[c];
            fetch(&mesh.x[vertex]);
            fetch(&mesh.y[vertex]);
            fetch(&mesh.z[vertex]);
            fetch(mesh.attributes.data() + vertex);
        }
    }
    for (int i = 0; i < count; ++i) {
        const RayHit& hit = hits[which[i]];
        HitSurface& s = surfaces[i];
        const auto& parts = s.instance->mesh->parts;
        const auto part = std::upper_bound(
            parts.begin(), parts.end(), hit.triangle,
            [](uint32_t t, const MeshPart& p) { return t < p.first_triangle + p.triangle_count; });
        s.material = &scene.list->materials[part->material];
        const float b[3] = {(1.0f - hit.b1) - hit.b2, hit.b1, hit.b2};
        s.texel = texelAt(*scene.list, s, b);
        fetch(s.texel);
        points[i] = pointAt(*scene.list, s, rays[which[i]], hit, b);
    }
    for (int i = 0; i < count; ++i) {
        albedos[i] = albedoOf(surfaces[i]);
    }
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
