#include "engine/internal/scene_file.h"

#include <algorithm>
#include <map>

#include "engine/internal/file_access.h"
#include "engine/internal/json.h"
#include "engine/internal/json_tracks.h"
#include "engine/internal/obj.h"
#include "engine/internal/obj_text.h"
#include "engine/internal/scene_lights.h"
#include "engine/internal/scene_materials.h"
#include "engine/internal/tracks.h"
#include "engine/load.h"
#include "engine/shapes.h"
#include "engine/timeline.h"

namespace still {
namespace {

constexpr size_t kMaxObjects = 65535;
constexpr size_t kMaxViews = 10000;
constexpr double kMinFovDeg = 0.1, kMaxFovDeg = 170;

/// Reads one scene file: the tree's checks, then the files that it names.
class SceneFileReader {
  public:
    SceneFileReader(const std::filesystem::path& file, const LoadOptions& options,
                    const JsonValue& tree)
        : folder_(file.parent_path()),
          options_(options),
          access_(options, file),
          report_{.file = shownPath(file), .error = {}, .warnings = {}},
          root_(tree, report_) {
        scene_.name = file.stem().string();
        scene_.lights = defaultLights();
        if (options_.folder.empty()) {
            options_.folder = folder_.empty() ? "." : folder_;  // of what its models name as well
        }
    }

    Result<Scene> read();
    /// See loadLights().
    Result<void> readLightsFor(Scene& scene);

  private:
    void readObjects();
    void readObject(const JsonCursor& cursor, size_t number);
    void addObject(SceneObject object, uint32_t mesh);
    const ObjMaterials& objOf(const JsonCursor& obj);
    uint32_t shapeOf(const JsonCursor& shape);
    void readCamera(const JsonCursor& cursor);
    void readCameraFile(const JsonCursor& file);
    void readViews(const JsonCursor& cursor);
    void readLight();
    void readCuts(const JsonCursor& cursor);
    void chooseClipPlanes();

    std::filesystem::path folder_;
    LoadOptions options_;
    FileAccess access_;
    JsonReport report_;
    JsonCursor root_;
    Scene scene_;
    SceneMaterials materials_{folder_, access_, options_.max_memory_bytes, scene_};
    std::map<std::filesystem::path, ObjMaterials> obj_of_file_;
};

ObjectTracks readTransform(const JsonCursor& cursor) {
    ObjectTracks tracks;
    if (const auto translation = cursor.find("translation")) {
        tracks.translation = readPointTrack(*translation);
    }
    if (const auto rotation = cursor.find("rotation")) {
        rotation->expectKeys({"axis", "degrees"});
        tracks.rotation_axis = readDirection(rotation->require("axis"));
        tracks.rotation_deg =
            readNumberTrack(rotation->require("degrees"), -kMaxCoordinate, kMaxCoordinate);
    }
    if (const auto scale = cursor.find("scale")) {
        tracks.scale = readScaleTrack(*scale);
    }
    return tracks;
}

/// The OBJ's mesh and materials, loaded once; those of mesh 0 after an error.
const ObjMaterials& SceneFileReader::objOf(const JsonCursor& obj) {
    const std::string name = obj.text();
    const auto [known, added] = obj_of_file_.try_emplace(folder_ / name);
    if (!added || report_.error) {
        return known->second;
    }
    const std::filesystem::path& file = known->first;
    Result<ObjModel> model = access_.find(folder_, name).and_then([&](const auto& found) {
        return loadObj(found, options_);
    });
    if (!model) {
        obj.refuse(model.error().message);
        return known->second;
    }
    known->second.first_material = uint32_t(scene_.materials.size());
    known->second.names = std::move(model->material_names);
    const std::vector<std::string> warnings = std::move(model->warnings);
    scene_.warnings.insert(scene_.warnings.end(), warnings.begin(), warnings.end());
    known->second.mesh = appendModel(scene_, std::move(*model), file.stem().string());
    return known->second;
}

uint32_t SceneFileReader::shapeOf(const JsonCursor& shape) {
    const std::string name = shape.text();
    Result<Mesh> mesh = shapes::named(name);
    if (!mesh) {
        shape.refuse(mesh.error().message);
        return 0;
    }
    mesh->parts[0].material = uint32_t(scene_.materials.size());
    scene_.materials.emplace_back();
    scene_.meshes.push_back(std::move(*mesh));
    scene_.mesh_names.push_back(name);
    return uint32_t(scene_.meshes.size() - 1);
}

void SceneFileReader::addObject(SceneObject object, uint32_t mesh) {
    object.mesh = mesh;
    if (!report_.error) {
        scene_.objects.push_back(std::move(object));
    }
}

void SceneFileReader::readObject(const JsonCursor& cursor, size_t number) {
    cursor.expectKeys(
        {"name", "obj", "materials", "shape", "material", "translation", "rotation", "scale"},
        {"notes", "comment"});
    const auto obj = cursor.find("obj");
    const auto shape = cursor.find("shape");
    const auto material = cursor.find("material");
    const auto materials = cursor.find("materials");
    if (obj.has_value() == shape.has_value()) {
        cursor.refuse("expected either \"obj\" or \"shape\"");
        return;
    }
    if (obj && material) {
        material->refuse("expected \"materials\", since an OBJ brings its own");
    }
    if (shape && materials) {
        materials->refuse("expected \"material\", since a shape has one");
    }
    SceneObject object;
    const auto name = cursor.find("name");
    object.name = name ? name->text() : "object " + std::to_string(number);
    object.tracks = readTransform(cursor);
    const ObjMaterials found = obj ? objOf(*obj) : ObjMaterials{.mesh = shapeOf(*shape)};
    if (report_.error) {
        return;
    }
    if (materials) {
        materials_.readOfObj(*materials, found);
    } else if (material) {
        materials_.readOfShape(*material, found.mesh);
    }
    addObject(std::move(object), found.mesh);
}

void SceneFileReader::readObjects() {
    const auto obj = root_.find("obj");
    const auto objects = root_.find("objects");
    if (!obj && !objects) {
        root_.refuse("expected \"obj\" or \"objects\"");
        return;
    }
    if (obj) {
        SceneObject object;
        object.name = scene_.name;
        addObject(std::move(object), objOf(*obj).mesh);
    }
    if (objects) {
        for (const JsonCursor& cursor : objects->items(1, kMaxObjects - 1)) {
            readObject(cursor, scene_.objects.size() + 1);
        }
    }
}

void SceneFileReader::readCameraFile(const JsonCursor& file) {
    const std::string name = file.text();
    Result<CameraFile> cameras = access_.find(folder_, name).and_then([&](const auto& path) {
        scene_.files.push_back(path.string());
        return loadCameraFile(path);
    });
    if (!cameras) {
        file.refuse(cameras.error().message);
        return;
    }
    report_.warnings.insert(report_.warnings.end(), cameras->warnings.begin(),
                            cameras->warnings.end());
    scene_.camera_file = std::move(*cameras);
    scene_.automatic_camera = true;  // for views and orbits
}

void SceneFileReader::readCamera(const JsonCursor& cursor) {
    if (const auto file = cursor.find("file")) {
        cursor.expectKeys({"file"}, {"notes", "comment"});
        readCameraFile(*file);
        return;
    }
    cursor.expectKeys({"eye", "target", "up", "fov_y_deg", "near", "far"}, {"notes", "comment"});
    Camera& camera = scene_.camera;
    if (const auto fov = cursor.find("fov_y_deg")) {
        camera.fov_y_deg = readNumberTrack(*fov, kMinFovDeg, kMaxFovDeg);
    }
    if (const auto up = cursor.find("up")) {
        camera.up = readTrack(*up, readDirection);
    }
    camera.eye = readPointTrack(cursor.require("eye"));
    camera.target = readPointTrack(cursor.require("target"));
    camera.near = camera.far = 0;
    if (const auto near = cursor.find("near")) {
        camera.near = near->number(1e-9, kMaxCoordinate);
    }
    if (const auto far = cursor.find("far")) {
        camera.far = far->number(1e-9, 1e3 * kMaxCoordinate);
        if (camera.far <= camera.near) {
            far->expected("a number larger than near");
        }
    }
}

/// Missing near and far: far is twice the way to the farthest corner of frame 0's bounds from any
/// key of the eye, near a ten-thousandth of it.
void SceneFileReader::chooseClipPlanes() {
    Camera& camera = scene_.camera;
    if (camera.far == 0) {
        const Bounds box = scene_.bounds(0);
        for (const auto& key : camera.eye.keys) {
            for (int corner = 0; corner < 8; ++corner) {
                const glm::dvec3 p((corner & 1) != 0 ? box.max.x : box.min.x,
                                   (corner & 2) != 0 ? box.max.y : box.min.y,
                                   (corner & 4) != 0 ? box.max.z : box.min.z);
                camera.far = std::max(camera.far, 2 * lengthOf(p - key.value));
            }
        }
        camera.far = std::max({camera.far, 2 * camera.near, 1e-6});
    }
    if (camera.near == 0) {
        camera.near = camera.far * 1e-4;
    }
}

void SceneFileReader::readViews(const JsonCursor& cursor) {
    for (const JsonCursor& at : cursor.items(0, kMaxViews)) {
        at.expectKeys({"name", "eye", "target", "up", "fov_y_deg"}, {"notes", "comment"});
        NamedView view;
        view.name = at.require("name").text();
        view.pose.eye = readPoint(at.require("eye"));
        view.pose.target = readPoint(at.require("target"));
        if (const auto up = at.find("up")) {
            view.pose.up = readDirection(*up);
        }
        if (const auto fov = at.find("fov_y_deg")) {
            view.pose.fov_y_deg = fov->number(kMinFovDeg, kMaxFovDeg);
        }
        scene_.views.push_back(std::move(view));
    }
}

void SceneFileReader::readCuts(const JsonCursor& cursor) {
    for (const JsonCursor& at : cursor.items(0, SIZE_MAX)) {
        const int frame = at.integer(0, kMaxFrame);
        if (!scene_.cuts.empty() && frame <= scene_.cuts.back()) {
            at.expected("a frame after the cut before");
        }
        scene_.cuts.push_back(frame);
    }
}

/// What is lit, and by what.
void SceneFileReader::readLight() {
    const auto light = root_.find("light");
    const auto lights = root_.find("lights");
    scene_.automatic_light = !light && !lights;
    if (light && lights) {
        light->refuse("expected either \"light\" or \"lights\"");
    } else if (light) {
        scene_.lights = readSingleLight(*light);
    } else if (lights) {
        scene_.lights = readLights(*lights);
    }
    if (const auto background = root_.find("background")) {
        scene_.background = readColour(*background);
    }
}

Result<void> SceneFileReader::readLightsFor(Scene& scene) {
    if (!root_.is(JsonValue::Type::object) || (!root_.find("light") && !root_.find("lights"))) {
        root_.refuse("expected an object with \"light\" or \"lights\"");
    }
    scene_.background = scene.background;
    readLight();
    if (report_.error) {
        return tl::make_unexpected(*report_.error);
    }
    scene.lights = std::move(scene_.lights);
    scene.background = scene_.background;
    scene.automatic_light = false;
    scene.warnings.insert(scene.warnings.end(), report_.warnings.begin(), report_.warnings.end());
    return {};
}

Result<Scene> SceneFileReader::read() {
    root_.expectKeys(
        {"name", "obj", "objects", "camera", "views", "light", "lights", "background", "cuts"},
        {"up", "unit_scale_m", "triangles", "bbox_min", "bbox_max", "alpha_test", "notes",
         "comment"});
    if (const auto name = root_.find("name")) {
        scene_.name = name->text();
    }
    const auto camera = root_.find("camera");
    scene_.automatic_camera = !camera.has_value();
    if (camera) {
        readCamera(*camera);
    }
    if (const auto views = root_.find("views")) {
        readViews(*views);
    }
    readLight();
    if (const auto cuts = root_.find("cuts")) {
        readCuts(*cuts);
    }
    readObjects();  // last: the files it names are slow to load
    if (!report_.error && surfaceCount(scene_) > kMaxSurfaces) {
        root_.refuse("expected at most " + std::to_string(kMaxSurfaces) + " surfaces, found " +
                     std::to_string(surfaceCount(scene_)));
    }
    if (report_.error) {
        return tl::make_unexpected(*report_.error);
    }
    if (!scene_.automatic_camera) {
        chooseClipPlanes();
    }
    scene_.warnings.insert(scene_.warnings.begin(), report_.warnings.begin(),
                           report_.warnings.end());
    return std::move(scene_);
}

}  // namespace

Result<Scene> loadSceneFile(const std::filesystem::path& file, const LoadOptions& options) {
    const Result<JsonValue> tree = readJson(file, options.max_memory_bytes);
    if (!tree) {
        return tl::make_unexpected(tree.error());
    }
    return SceneFileReader(file, options, *tree).read().map([&](Scene scene) {
        scene.files.push_back(file.string());
        return scene;
    });
}

Result<void> loadLights(const std::filesystem::path& file, Scene& scene) {
    const Result<JsonValue> tree = readJson(file);
    if (!tree) {
        return tl::make_unexpected(tree.error());
    }
    return SceneFileReader(file, {}, *tree).readLightsFor(scene).map([&] {
        scene.files.push_back(file.string());
    });
}

Result<Scene> parseSceneFile(const std::string& text, const std::filesystem::path& name,
                             const LoadOptions& options) {
    return parseJson(text, name, options.max_memory_bytes).and_then([&](const JsonValue& tree) {
        return SceneFileReader(name, options, tree).read();
    });
}

}  // namespace still
