#include <glm/geometric.hpp>

#include "engine/internal/obj.h"
#include "engine/internal/obj_text.h"
#include "engine/internal/scene_file.h"
#include "engine/internal/scene_lights.h"
#include "engine/internal/tracks.h"
#include "engine/load.h"
#include "engine/timeline.h"

namespace still {
namespace {

/// Where an automatic camera stands: in front, to the right and above.
constexpr glm::dvec3 kPleasantDirection{0.5, 0.35, 1};
constexpr double kUsualAspect = 16.0 / 9;

std::string lowerExtension(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    for (char& c : extension) {
        c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
    }
    return extension;
}

Result<Scene> sceneFromModel(const std::filesystem::path& file, Result<ObjModel> model) {
    if (!model) {
        return tl::make_unexpected(model.error());
    }
    Scene scene;
    scene.name = file.stem().string();
    scene.lights = defaultLights();
    scene.automatic_light = true;
    scene.warnings = std::move(model->warnings);
    SceneObject object;
    object.name = scene.name;
    object.mesh = appendModel(scene, std::move(*model), scene.name);
    scene.objects.push_back(std::move(object));
    scene.automatic_camera = true;
    if (surfaceCount(scene) > kMaxSurfaces) {
        return fail(shownPath(file) + ": too many groups and materials, expected at most " +
                    std::to_string(kMaxSurfaces) + " surfaces");
    }
    return scene;
}

/// The last of the checks, and the automatic camera.
Result<Scene> framed(const std::filesystem::path& file, Result<Scene> scene) {
    if (scene && scene->triangleCount() > kMaxTriangles) {
        return fail(shownPath(file) + ": " + std::to_string(scene->triangleCount()) +
                    " triangles over all objects, expected at most " +
                    std::to_string(kMaxTriangles));
    }
    if (scene && scene->automatic_camera) {
        frameScene(*scene, kPleasantDirection, kUsualAspect);
    }
    return scene;
}

/// Turns +y to `up`, and keeps +x to the right where that can be.
glm::dmat3 turnedUp(const glm::dvec3& up) {
    const double sign = up.x < 0 ? 1 : -1;
    const bool sideways = up.x > 0.9 || up.x < -0.9;
    const glm::dvec3 right = sideways ? glm::dvec3(0, sign, 0) : glm::dvec3(1, 0, 0);
    const glm::dvec3 towards_viewer = unit(glm::cross(right, up));
    return {glm::cross(up, towards_viewer), up, towards_viewer};
}

}  // namespace

Result<Scene> loadScene(const std::filesystem::path& file, const LoadOptions& options) {
    const std::string extension = lowerExtension(file);
    if (extension != ".obj" && extension != ".json") {
        return fail(shownPath(file) + ": unknown kind of file, expected NAME.obj or NAME.json");
    }
    return framed(file, extension == ".obj" ? sceneFromModel(file, loadObj(file, options))
                                            : loadSceneFile(file, options));
}

Result<Scene> loadSceneText(std::string text, const std::string& name, const LoadOptions& options) {
    const size_t first = text.find_first_not_of(" \t\r\n");
    if (first != std::string::npos && text[first] == '{') {
        return framed(name, parseSceneFile(text, name, options));
    }
    return framed(name, sceneFromModel(name, parseObjModel(std::move(text), name, options)));
}

void setUpAxis(Scene& scene, glm::dvec3 up) {
    up = unit(up);
    const glm::dmat3 turn = turnedUp(up);
    if (scene.automatic_light) {
        const auto& from = scene.lights.sun.direction;
        const glm::dvec3 d = turn * glm::dvec3(from[0], from[1], from[2]);
        scene.lights.sun.direction = {float(d.x), float(d.y), float(d.z)};
    }
    for (NamedView& view : scene.views) {
        view.pose.up = up;
    }
    scene.camera.up.keys = {{0, up}};
    if (scene.automatic_camera) {
        frameScene(scene, turn * kPleasantDirection, kUsualAspect, up);
    }
}

}  // namespace still
