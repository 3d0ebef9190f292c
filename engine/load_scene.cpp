#include "engine/internal/obj.h"
#include "engine/internal/obj_text.h"
#include "engine/internal/scene_file.h"
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

Result<Scene> sceneFromObj(const std::filesystem::path& file,
                           const std::filesystem::path& cache_folder) {
    Result<ObjModel> model = loadObj(file, cache_folder);
    if (!model) {
        return tl::make_unexpected(model.error());
    }
    Scene scene;
    scene.name = file.stem().string();
    scene.lights = defaultLights();
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

}  // namespace

Result<Scene> loadScene(const std::filesystem::path& file,
                        const std::filesystem::path& cache_folder) {
    const std::string extension = lowerExtension(file);
    if (extension != ".obj" && extension != ".json") {
        return fail(shownPath(file) + ": unknown kind of file, expected NAME.obj or NAME.json");
    }
    Result<Scene> scene =
        extension == ".obj" ? sceneFromObj(file, cache_folder) : loadSceneFile(file, cache_folder);
    if (scene && scene->automatic_camera) {
        frameScene(*scene, kPleasantDirection, kUsualAspect);
    }
    return scene;
}

}  // namespace still
