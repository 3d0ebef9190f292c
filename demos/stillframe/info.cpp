#include "demos/stillframe/info.h"

#include <algorithm>
#include <array>
#include <vector>

#include "demos/stillframe/file_cache.h"
#include "demos/stillframe/formatted.h"
#include "demos/stillframe/json_report.h"
#include "demos/stillframe/report.h"
#include "demos/stillframe/scene_source.h"
#include "engine/read_file.h"
#include "engine/scene_work.h"

namespace still::command {
namespace {

constexpr std::array<const char*, 4> kKernels{"plain", "textured", "lit", "parallax"};

struct TextureInfo {
    std::string use;  ///< colour, normal, alpha or height
    uint32_t width = 0, height = 0;
    uint64_t bytes = 0;
};

/// Surfaces that need something.
struct Need {
    const char* name;
    bool SurfaceWork::*flag;
    uint64_t surfaces = 0;
};

struct SceneInfo {
    uint64_t vertices = 0;
    uint64_t surfaces = 0;
    std::vector<TextureInfo> textures;
    uint64_t texture_bytes = 0;
    Bounds bounds;
    std::vector<Need> needs{{"textures", &SurfaceWork::textured},
                            {"normal_maps", &SurfaceWork::normal_mapped},
                            {"height_maps", &SurfaceWork::parallax},
                            {"highlights_or_point_lights", &SurfaceWork::positioned},
                            {"alpha_test", &SurfaceWork::alpha_tested},
                            {"stochastic_transparency", &SurfaceWork::stochastic}};
    std::array<uint64_t, 4> kernel_triangles{};
    Changes changes;
    int cuts = 0;
    std::string camera;
};

template <class T>
void addTextures(const std::vector<T>& textures, const char* use,
                 const std::vector<const char*>& uses, SceneInfo& out) {
    for (size_t i = 0; i < textures.size(); ++i) {
        const T& texture = textures[i];
        const uint64_t bytes = texture.texels.size() * sizeof(texture.texels[0]);
        const auto [width, height] =
            texture.levels.empty() ? std::pair(0u, 0u)
                                   : std::pair(texture.levels[0].width, texture.levels[0].height);
        out.textures.push_back({uses[i] != nullptr ? uses[i] : use, width, height, bytes});
        out.texture_bytes += bytes;
    }
}

/// Each texture with what the materials take it for.
void addTextures(const Scene& scene, SceneInfo& out) {
    std::vector<const char*> colours(scene.textures.size(), nullptr);
    std::vector<const char*> alphas(scene.alpha_textures.size(), nullptr);
    const auto note = [](std::vector<const char*>& uses, int32_t texture, const char* use) {
        if (texture != kNoTexture) {
            uses[size_t(texture)] = use;
        }
    };
    for (const Material& material : scene.materials) {
        note(colours, material.colour_texture, "colour");
        note(colours, material.normal_texture, "normal");
        note(alphas, material.alpha_texture, "alpha");
        note(alphas, material.height_texture, "height");
    }
    addTextures(scene.textures, "unused", colours, out);
    addTextures(scene.alpha_textures, "unused", alphas, out);
}

/// What the rasterizer says of the first frame.
void addWork(const Scene& scene, SceneInfo& out) {
    const std::vector<SurfaceWork> work = sceneWork(scene, {}, 0);
    out.surfaces = work.size();
    for (const SurfaceWork& surface : work) {
        for (Need& need : out.needs) {
            need.surfaces += surface.*need.flag ? 1 : 0;
        }
    }
    size_t surface = 0;
    for (const SceneObject& object : scene.objects) {
        for (const MeshPart& part : scene.meshes[object.mesh].parts) {
            out.kernel_triangles[size_t(work[surface++].kernel)] += part.triangle_count;
        }
    }
}

std::string cameraOf(const Scene& scene) {
    if (scene.camera_file) {
        return "file, " + std::to_string(scene.camera_file->frames.size()) + " frames of " +
               std::to_string(scene.camera_file->width) + "x" +
               std::to_string(scene.camera_file->height);
    }
    if (scene.automatic_camera) {
        return "automatic";
    }
    const Camera& c = scene.camera;
    const size_t keys = std::max(
        {c.eye.keys.size(), c.target.keys.size(), c.up.keys.size(), c.fov_y_deg.keys.size()});
    return keys > 1 ? "animated, " + std::to_string(keys) + " keys" : "fixed";
}

SceneInfo infoOf(const Scene& scene) {
    SceneInfo info;
    for (const Mesh& mesh : scene.meshes) {
        info.vertices += mesh.vertexCount();
    }
    addTextures(scene, info);
    addWork(scene, info);
    info.bounds = scene.bounds(0);
    info.changes = changesOf(scene, {});
    info.cuts = int(scene.cuts.size());
    info.camera = cameraOf(scene);
    return info;
}

std::vector<std::pair<const char*, bool>> changesList(const Changes& c) {
    return {{"objects", c.objects},
            {"materials", c.materials},
            {"lights", c.lights},
            {"camera", c.camera},
            {"cuts", c.cuts}};
}

bool isLit(const Scene& scene) {
    const auto& c = scene.lights.sun.colour;
    return c[0] > 0 || c[1] > 0 || c[2] > 0;
}

/// In the words of scene files.
std::string shadowOf(const SceneLights& lights) {
    const bool mapped = lights.sun_shadow == SunShadow::mapped;
    return lights.sun_shadow == SunShadow::none ? "none" : mapped ? "map" : "traced";
}
std::string ambientOf(const SceneLights& lights) {
    switch (lights.ambient_light) {
        case AmbientLight::screen_occlusion:
            return "screen occlusion";
        case AmbientLight::traced_occlusion:
            return "traced occlusion";
        case AmbientLight::bounce:
            return "bounce";
        default:
            return "plain";
    }
}

/// What is there, of sampled light only then.
std::string lightsText(const Scene& scene) {
    const SceneLights& lights = scene.lights;
    std::string text = isLit(scene) ? "sun, " : "";
    if (isLit(scene) && lights.sun_shadow != SunShadow::none) {
        text = "sun with " +
               std::string(lights.sun_shadow == SunShadow::mapped ? "mapped" : "traced") +
               " shadows, ";
    }
    text += std::to_string(lights.points.size()) + " points";
    const auto add = [&](size_t count, const char* what) {
        text += count == 0 ? "" : ", " + std::to_string(count) + " " + what;
    };
    add(lights.spheres.size(), "spheres");
    add(lights.rectangles.size(), "rectangles");
    text +=
        lights.ambient_light == AmbientLight::plain ? "" : ", ambient with " + ambientOf(lights);
    return text + (lights.sampled() ? " (sampled)" : "");
}

Json pointJson(const glm::dvec3& p) {
    return {p.x, p.y, p.z};
}

std::string infoJson(const std::string& name, const Scene& scene, const SceneInfo& info) {
    Json json;
    json["scene"] = name;
    json["triangles"] = scene.triangleCount();
    json["vertices"] = info.vertices;
    json["objects"] = scene.objects.size();
    json["meshes"] = scene.meshes.size();
    json["surfaces"] = info.surfaces;
    json["materials"] = scene.materials.size();
    json["textures"] = Json::array();
    for (const TextureInfo& t : info.textures) {
        json["textures"].push_back(
            {{"use", t.use}, {"width", t.width}, {"height", t.height}, {"bytes", t.bytes}});
    }
    json["texture_bytes"] = info.texture_bytes;
    json["bounds"] = nullptr;
    if (info.bounds.valid) {
        json["bounds"] = {{"min", pointJson(info.bounds.min)}, {"max", pointJson(info.bounds.max)}};
    }
    json["lights"] = {{"sun", isLit(scene)},
                      {"sun_shadow", shadowOf(scene.lights)},
                      {"ambient", ambientOf(scene.lights)},
                      {"points", scene.lights.points.size()},
                      {"spheres", scene.lights.spheres.size()},
                      {"rectangles", scene.lights.rectangles.size()},
                      {"sampled", scene.lights.sampled()}};
    json["camera"] = info.camera;
    json["views"] = Json::array();
    for (const NamedView& view : scene.views) {
        json["views"].push_back(view.name);
    }
    json["cuts"] = info.cuts;
    json["still"] = isStill(scene, {});
    for (const auto& [what, does] : changesList(info.changes)) {
        json["changes"][what] = does;
    }
    for (const Need& need : info.needs) {
        json["surfaces_with"][need.name] = need.surfaces;
    }
    for (size_t i = 0; i < kKernels.size(); ++i) {
        json["kernel_triangles"][kKernels[i]] = info.kernel_triangles[i];
    }
    return text(json);
}

std::string line(const char* name, const std::string& what) {
    return formatted("%-11s", name) + what + "\n";
}

/// "a 3, b 5", without those that are 0.
template <class Range, class NameOf, class CountOf>
std::string counted(const Range& range, NameOf&& nameOf, CountOf&& countOf) {
    std::string list;
    for (const auto& element : range) {
        if (countOf(element) > 0) {
            std::string name = nameOf(element);
            std::replace(name.begin(), name.end(), '_', ' ');
            list += (list.empty() ? "" : ", ") + name + " " + std::to_string(countOf(element));
        }
    }
    return list.empty() ? "none" : list;
}

std::string textureLines(const SceneInfo& info) {
    std::string lines = line("textures", std::to_string(info.textures.size()) +
                                             formatted(", %.2f MB", info.texture_bytes / 1e6));
    for (const TextureInfo& t : info.textures) {
        const std::string size = std::to_string(t.width) + "x" + std::to_string(t.height);
        lines += formatted("  %-11s%8.2f MB  %s\n", size.c_str(), t.bytes / 1e6, t.use.c_str());
    }
    return lines;
}

std::string changesLine(const Scene& scene, const SceneInfo& info) {
    std::string list;
    for (const auto& [what, does] : changesList(info.changes)) {
        list += does ? (list.empty() ? "" : ", ") + std::string(what) : "";
    }
    return line("changes", isStill(scene, {})
                               ? "nothing: one frame is a finished picture, and of many nothing is "
                                 "drawn once they are finished"
                               : list);
}

std::string infoLines(const std::string& name, const Scene& scene, const SceneInfo& info) {
    const auto count = [](size_t n) { return std::to_string(n); };
    std::string lines = line("scene", name);
    lines += line("triangles", count(scene.triangleCount()) + " in " + count(scene.objects.size()) +
                                   " objects, " + count(scene.meshes.size()) + " meshes of " +
                                   count(info.vertices) + " vertices");
    lines += line("materials",
                  count(scene.materials.size()) + " on " + count(info.surfaces) + " surfaces");
    lines += textureLines(info);
    if (info.bounds.valid) {
        const glm::dvec3& a = info.bounds.min;
        const glm::dvec3& b = info.bounds.max;
        lines += line("bounds", formatted("%g %g %g to %g %g %g", a.x, a.y, a.z, b.x, b.y, b.z));
    }
    lines += line("lights", lightsText(scene));
    lines += line("camera", info.camera);
    std::string views;
    for (const NamedView& view : scene.views) {
        views += (views.empty() ? "" : ", ") + shownPath(view.name);
    }
    lines += line("views", views.empty() ? "none" : views);
    lines += changesLine(scene, info);
    lines += line("surfaces", counted(
                                  info.needs, [](const Need& n) { return n.name; },
                                  [](const Need& n) { return n.surfaces; }));
    const std::array<size_t, 4> kernels{0, 1, 2, 3};
    lines += line("kernels", counted(
                                 kernels, [](size_t k) { return kKernels[k]; },
                                 [&](size_t k) { return info.kernel_triangles[k]; }) +
                                 " (triangles)");
    return lines;
}

}  // namespace

Outcome<void> info(const InfoOptions& options) {
    const auto cache = options.no_cache ? std::filesystem::path() : usersCacheFolder();
    const auto scene = openScene(options.scene, loadOptions(options.limits, cache));
    if (!scene) {
        return tl::make_unexpected(scene.error());
    }
    printWarnings(scene->warnings, options.quiet);
    const SceneInfo facts = infoOf(*scene);
    return print(options.json ? infoJson(options.scene, *scene, facts)
                              : infoLines(options.scene, *scene, facts));
}

}  // namespace still::command
