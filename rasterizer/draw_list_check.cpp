#include "rasterizer/draw_list_check.h"

#include <algorithm>

#include "rasterizer/texture_layout.h"

namespace still {

namespace {

template <class AnyTexture>
const char* flawOfLevels(const AnyTexture& texture) {
    if (texture.levels.empty() || texture.wrap > Wrap::clamp) {
        return "texture: no levels, or no such wrap";
    }
    std::vector<TextureLevel> laid_out;
    for (size_t k = 0; k < texture.levels.size(); ++k) {
        const TextureLevel& level = texture.levels[k];
        const TextureLevel& above = texture.levels[k == 0 ? 0 : k - 1];
        const bool halved = level.width == std::max<uint32_t>(above.width / 2, 1) &&
                            level.height == std::max<uint32_t>(above.height / 2, 1);
        if (level.width < 1 || level.height < 1 || level.width > kMaxTextureSize ||
            level.height > kMaxTextureSize) {
            return "texture: a level of no size or too large";
        }
        if (k > 0 && !halved) {
            return "texture: a level that is not half of the one before";
        }
        addLevel(laid_out, level.width, level.height);
        if (level != laid_out[k]) {
            return "texture: levels that are not laid out";
        }
    }
    return texture.texels.size() == texelCount(laid_out) ? nullptr
                                                         : "texture: another number of texels";
}

template <size_t kCount>
bool areWithin(const std::array<float, kCount>& values, float limit) {
    return std::all_of(values.begin(), values.end(), [=](float v) { return within(v, limit); });
}

bool isColour(const std::array<float, 3>& colour) {
    return areWithin(colour, kMaxColour) &&
           std::all_of(colour.begin(), colour.end(), [](float c) { return c >= 0.0f; });
}

bool usesTangents(const Material& material) {
    return material.normal_texture != kNoTexture || material.height_texture != kNoTexture;
}

const char* flawOf(const SampledLight& sampled) {
    if (sampled.sun_shadow > SunShadow::traced || sampled.ambient > AmbientLight::bounce) {
        return "light: no such kind of shadow or ambient light";
    }
    if (!(sampled.sun_tangent >= 0.0f && sampled.sun_tangent <= kMaxPosition &&
          sampled.occlusion_distance >= 0.0f && sampled.occlusion_distance <= kMaxPosition)) {
        return "light: a width of the sun or a distance out of range";
    }
    for (const SphereLight& sphere : sampled.spheres) {
        if (!areWithin(sphere.position, kMaxPosition) || !isColour(sphere.colour) ||
            !(sphere.radius > 0.0f && sphere.radius <= kMaxPosition)) {
            return "light: a sphere with a number out of range";
        }
    }
    for (const RectangleLight& rectangle : sampled.rectangles) {
        if (!areWithin(rectangle.centre, kMaxPosition) ||
            !areWithin(rectangle.edge_u, kMaxPosition) ||
            !areWithin(rectangle.edge_v, kMaxPosition) || !isColour(rectangle.colour)) {
            return "light: a rectangle with a number out of range";
        }
    }
    return nullptr;
}

const char* flawOfInstances(const DrawList& list) {
    uint32_t surface = 1;
    for (const Instance& instance : list.instances) {
        if (instance.mesh >= list.meshes.size()) {
            return "instance: a mesh that there is not";
        }
        if (instance.first_surface != surface) {
            return "instance: surfaces are not numbered one after the other";
        }
        surface += uint32_t(list.meshes[instance.mesh].parts.size());
        if (surface > kMaxSurfaces + 1) {
            return "instance: too many surfaces";
        }
    }
    return nullptr;
}

bool haveWindings(const DrawList& list) {
    bool complete = list.windings.empty() || list.windings.size() == list.meshes.size();
    for (size_t i = 0; complete && i < list.windings.size(); ++i) {
        complete = list.windings[i].size() == (size_t{list.meshes[i].triangleCount()} + 31) / 32;
    }
    return complete;
}

/// The first flaw of any of them.
template <class List, class Check>
const char* firstFlaw(const List& list, const Check& check) {
    for (const auto& each : list) {
        if (const char* const flaw = check(each)) {
            return flaw;
        }
    }
    return nullptr;
}

}  // namespace

const char* flawOfIndices(const Mesh& mesh, std::span<const Material> materials) {
    const size_t vertices = mesh.x.size();
    if (mesh.y.size() != vertices || mesh.z.size() != vertices ||
        mesh.attributes.size() != vertices) {
        return "mesh: coordinates and attributes of different numbers";
    }
    uint64_t triangles = 0;
    bool tangents = !mesh.tangents.empty();
    for (const MeshPart& part : mesh.parts) {
        if (part.first_triangle != triangles) {
            return "mesh: parts that do not follow one another";
        }
        if (part.material >= materials.size()) {
            return "mesh: a material that there is not";
        }
        triangles += part.triangle_count;
        tangents |= usesTangents(materials[part.material]);
    }
    if (mesh.indices.size() != triangles * 3) {
        return "mesh: triangles that are in no part, or parts without triangles";
    }
    if (tangents && mesh.tangents.size() != vertices) {
        return "mesh: a normal or height map without a tangent at each vertex";
    }
    const bool in_range = std::all_of(mesh.indices.begin(), mesh.indices.end(),
                                      [=](uint32_t index) { return index < vertices; });
    return in_range ? nullptr : "mesh: an index beyond the vertices";
}

const char* flawOf(const Mesh& mesh, std::span<const Material> materials) {
    for (const std::vector<float>* axis : {&mesh.x, &mesh.y, &mesh.z}) {
        if (!std::all_of(axis->begin(), axis->end(),
                         [](float v) { return within(v, kMaxPosition); })) {
            return "mesh: a coordinate out of range";
        }
    }
    const auto sound = [](const auto& element) { return isSound(element); };
    if (!std::all_of(mesh.attributes.begin(), mesh.attributes.end(), sound)) {
        return "mesh: a normal or texture coordinate out of range";
    }
    if (!std::all_of(mesh.tangents.begin(), mesh.tangents.end(), sound)) {
        return "mesh: a tangent out of range";
    }
    return flawOfIndices(mesh, materials);
}

const char* flawOf(const Texture& texture) {
    return flawOfLevels(texture);
}

const char* flawOf(const AlphaTexture& texture) {
    return flawOfLevels(texture);
}

const char* flawOf(const Material& m, size_t textures, size_t alpha_textures) {
    const auto inRange = [](int32_t texture, size_t count) {
        return texture >= kNoTexture && texture < int64_t(count);
    };
    if (!inRange(m.colour_texture, textures) || !inRange(m.normal_texture, textures) ||
        !inRange(m.alpha_texture, alpha_textures) || !inRange(m.height_texture, alpha_textures)) {
        return "material: a texture that there is not";
    }
    const bool sound =
        isColour(m.diffuse) && isColour(m.specular) && isColour(m.emission) &&
        m.shininess >= 1.0f && m.shininess <= 1024.0f && m.opacity >= 0.0f && m.opacity <= 1.0f &&
        m.height_scale >= 0.0f && m.height_scale <= 1.0f && within(m.u_offset, kMaxTextureOffset) &&
        within(m.v_offset, kMaxTextureOffset) && m.alpha_mode <= AlphaMode::stochastic;
    return sound ? nullptr : "material: a number out of range";
}

const char* flawOf(const Lighting& lighting) {
    if (!isColour(lighting.ambient) || !isColour(lighting.sun.colour) ||
        !areWithin(lighting.sun.direction, kMaxUnitLength)) {
        return "light: ambient or sun out of range";
    }
    for (const PointLight& point : lighting.points) {
        if (!areWithin(point.position, kMaxPosition) || !isColour(point.colour)) {
            return "light: a point light with a number out of range";
        }
    }
    return flawOf(lighting.sampled);
}

const char* flawOf(const DrawList& list) {
    const auto material = [&](const Material& m) {
        return flawOf(m, list.textures.size(), list.alpha_textures.size());
    };
    const char* flaw = firstFlaw(list.materials, material);
    const auto next = [&](auto&& check) { flaw = flaw != nullptr ? flaw : check(); };
    const auto texture = [](const auto& t) { return flawOf(t); };
    next([&] { return firstFlaw(list.textures, texture); });
    next([&] { return firstFlaw(list.alpha_textures, texture); });
    next([&] {
        return firstFlaw(list.meshes, [&](const Mesh& m) { return flawOf(m, list.materials); });
    });
    next([&] { return flawOfInstances(list); });
    next([&] { return haveWindings(list) ? nullptr : "windings: not of all triangles"; });
    next([&] { return flawOf(list.lighting); });
    next([&] { return isColour(list.background) ? nullptr : "background: out of range"; });
    return flaw;
}

}  // namespace still
