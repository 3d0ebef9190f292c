#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include "engine/det_math.h"
#include "engine/load.h"
#include "engine/timeline.h"

using namespace still;
namespace fs = std::filesystem;

namespace {

const fs::path kData = fs::path(STILL_SOURCE_DIR) / "tests" / "data";

/// A scene file with the given text, beside a copy of quad.obj; removed with the object.
class ScratchScene {
  public:
    explicit ScratchScene(const std::string& text) {
        folder_ =
            fs::temp_directory_path() / ("still_scene_" + std::to_string(std::random_device{}()));
        fs::create_directories(folder_);
        fs::copy_file(kData / "quad.obj", folder_ / "quad.obj");
        fs::copy_file(kData / "quad.mtl", folder_ / "quad.mtl");
        std::ofstream(folder_ / "scene.json", std::ios::binary) << text;
    }
    ~ScratchScene() { fs::remove_all(folder_); }
    ScratchScene(const ScratchScene&) = delete;
    ScratchScene& operator=(const ScratchScene&) = delete;

    fs::path file() const { return folder_ / "scene.json"; }

  private:
    fs::path folder_;
};

/// The message without the folder: "scene.json…". Empty when the text loads.
std::string errorOf(const std::string& text) {
    const ScratchScene scratch(text);
    const auto scene = loadScene(scratch.file());
    if (scene) {
        return "";
    }
    const std::string folder = scratch.file().parent_path().string() + "/";
    std::string message = scene.error().message;
    for (size_t at; (at = message.find(folder)) != std::string::npos;) {
        message.erase(at, folder.size());
    }
    CHECK(message.find('\n') == std::string::npos);
    return message;
}

fs::path sharedData() {
    const char* given = std::getenv("STILL_DATA");
    return given != nullptr ? fs::path(given)
                            : fs::path(STILL_SOURCE_DIR) / ".." / "shared" / "data";
}

}  // namespace

TEST_CASE("scene_file: the documented example has every value it says", "[unit][scene_file]") {
    const auto loaded = loadScene(kData / "example.scene.json");
    REQUIRE((loaded ? "" : loaded.error().message) == std::string());
    const Scene& scene = *loaded;
    CHECK(scene.name == "example");
    CHECK(scene.warnings.empty());
    CHECK_FALSE(scene.automatic_camera);
    REQUIRE(scene.objects.size() == 3);

    const SceneObject& sign = scene.objects[0];
    CHECK(sign.name == "sign");
    CHECK(scene.meshes[sign.mesh].triangleCount() == 2);
    REQUIRE(sign.tracks.translation.keys.size() == 1);
    CHECK(sign.tracks.translation.keys[0].value == glm::dvec3(0, 1, -2));
    const Material& grey = scene.materials[scene.meshes[sign.mesh].parts[0].material];
    CHECK(grey.diffuse[0] == 0.5f);

    const SceneObject& floor = scene.objects[1];
    const Material& matt = scene.materials[scene.meshes[floor.mesh].parts[0].material];
    CHECK(matt.diffuse[1] == float(det::pow((0.5 + 0.055) / 1.055, 2.4)));
    CHECK(matt.specular[2] == 0.04f);
    CHECK(matt.shininess == 20.0f);
    CHECK(matt.alpha_mode == AlphaMode::opaque);
    CHECK(floor.tracks.scale.keys[0].value == glm::dvec3(8, 1, 8));

    const SceneObject& ring = scene.objects[2];
    const Material& glow = scene.materials[scene.meshes[ring.mesh].parts[0].material];
    CHECK(glow.diffuse == std::array{0.8f, 0.3f, 0.1f});
    CHECK(glow.emission == std::array{0.1f, 0.0f, 0.0f});
    CHECK(glow.opacity == 0.5f);
    CHECK(glow.alpha_mode == AlphaMode::stochastic);
    REQUIRE(ring.tracks.translation.keys.size() == 2);
    CHECK(ring.tracks.translation.keys[1].frame == 20);
    CHECK(ring.tracks.translation.keys[1].value == glm::dvec3(2, 1, 0));
    CHECK(ring.tracks.rotation_axis == glm::dvec3(0, 0, 1));
    CHECK(ring.tracks.rotation_deg.keys[1].frame == 40);
    CHECK(ring.tracks.rotation_deg.keys[1].value == 360);
    CHECK(ring.tracks.scale.keys[0].value == glm::dvec3(1));
    CHECK(ring.tracks.scale.keys[1].value == glm::dvec3(1, 2, 1));
}

TEST_CASE("scene_file: the documented example's camera, lights and cuts", "[unit][scene_file]") {
    const auto loaded = loadScene(kData / "example.scene.json");
    REQUIRE(loaded);
    const Camera& camera = loaded->camera;
    REQUIRE(camera.eye.keys.size() == 3);
    CHECK(camera.eye.keys[2].value == glm::dvec3(-6, 3, 4));
    CHECK(camera.target.keys[0].value == glm::dvec3(0, 1, 0));
    CHECK(camera.up.keys[0].value == glm::dvec3(0, 1, 0));
    CHECK(camera.fov_y_deg.keys[1].value == 50);
    CHECK(camera.near == 0.05);
    CHECK(camera.far == 100);

    REQUIRE(loaded->views.size() == 2);
    CHECK(loaded->views[0].name == "top");
    CHECK(loaded->views[0].pose.up == glm::dvec3(0, 0, -1));
    CHECK(loaded->views[0].pose.fov_y_deg == 60);
    CHECK(loaded->views[1].pose.eye == glm::dvec3(9, 1, 0));
    CHECK(loaded->views[1].pose.up == glm::dvec3(0, 1, 0));
    CHECK(loaded->views[1].pose.fov_y_deg == 45);

    const SceneLights& lights = loaded->lights;
    CHECK(lights.ambient == std::array{0.2f, 0.25f, 0.3f});
    CHECK(lights.sun.direction == std::array{0.0f, -0.6f, -0.8f});
    CHECK(lights.sun.colour == std::array{1.0f, 0.9f, 0.8f});
    CHECK(lights.sun_intensity.keys[1].value == 0.5);
    REQUIRE(lights.points.size() == 2);
    CHECK(lights.points[0].position == std::array{2.0f, 3.0f, 1.0f});
    CHECK(lights.points[0].colour == std::array{1.0f, 1.0f, 0.0f});
    CHECK(lights.point_intensity[0].keys[0].value == 4);
    CHECK(lights.points[1].colour == std::array{1.0f, 1.0f, 1.0f});
    CHECK(lights.point_intensity[1].keys[1].value == 6);
    CHECK(loaded->background[0] == 0.0f);
    CHECK(loaded->background[1] == 1.0f);
    CHECK(loaded->cuts == std::vector<int>{30});
}

TEST_CASE("scene_file: the documented example's sampled light", "[unit][scene_file]") {
    const auto loaded = loadScene(kData / "example.scene.json");
    REQUIRE(loaded);
    const SceneLights& lights = loaded->lights;
    CHECK(lights.sun_shadow == SunShadow::traced);
    CHECK(lights.sun_angle_deg == 2);
    CHECK(lights.ambient_light == AmbientLight::traced_occlusion);
    CHECK(lights.occlusion_distance == 0.5);
    REQUIRE(lights.spheres.size() == 1);
    CHECK(lights.spheres[0].position.keys[1].value == glm::dvec3(1, 4, 0));
    CHECK(lights.spheres[0].radius == 0.25);
    CHECK(lights.spheres[0].colour == std::array{1.0f, 0.5f, 0.25f});
    CHECK(lights.spheres[0].intensity.keys[2].value == 0);
    REQUIRE(lights.rectangles.size() == 1);
    CHECK(lights.rectangles[0].centre.keys[0].value == glm::dvec3(0, 6, 0));
    CHECK(lights.rectangles[0].edge_u == glm::dvec3(2, 0, 0));
    CHECK(lights.rectangles[0].edge_v == glm::dvec3(0, 0, 1));
    CHECK(lights.rectangles[0].intensity.keys[0].value == 12);
}

TEST_CASE("scene_file: without the keys of sampled light there is none", "[unit][scene_file]") {
    const auto sampled = [](const std::string& lights) {
        const auto scene =
            loadSceneText(R"({"objects": [{"shape": "box"}], "lights": )" + lights + "}", "a");
        REQUIRE(scene);
        return scene->lights.sampled();
    };
    CHECK_FALSE(
        sampled(R"({"ambient": {"bounce": false}, "directional": {"direction": [0,1,0]}})"));
    CHECK_FALSE(sampled(R"({"spheres": [], "rectangles": []})"));
    CHECK(sampled(R"({"ambient": {"bounce": true}})"));
    CHECK(sampled(R"({"spheres": [{"position": [0, 1, 0], "radius": 1}]})"));
}

TEST_CASE("scene_file: one light is enough and makes white surfaces 1", "[unit][scene_file]") {
    const ScratchScene scratch(R"({"obj": "quad.obj", "light": {"direction": [0, -2, 0]}})");
    const auto scene = loadScene(scratch.file());
    REQUIRE(scene);
    CHECK(scene->lights.sun.direction == std::array{0.0f, -1.0f, 0.0f});
    CHECK(scene->lights.sun.colour[0] + scene->lights.ambient[0] == 1.0f);
    CHECK(scene->automatic_camera);
    CHECK(scene->camera.eye.keys.size() == 1);
}

TEST_CASE("scene_file: objects that name the same file share its mesh", "[unit][scene_file]") {
    const ScratchScene scratch(
        R"({"objects": [{"obj": "quad.obj"}, {"obj": "quad.obj", "scale": 2}]})");
    const auto scene = loadScene(scratch.file());
    REQUIRE(scene);
    CHECK(scene->meshes.size() == 1);
    CHECK(scene->objects[1].mesh == 0);
    CHECK(scene->triangleCount() == 4);
    CHECK(scene->objects[1].name == "object 2");
}

TEST_CASE("scene_file: a scene knows its files, and those of its models", "[unit][scene_file]") {
    const ScratchScene scratch(
        R"({"objects":[{"obj":"quad.obj"},{"shape":"sphere"}],"camera":{"file":"cameras.json"}})");
    fs::copy_file(kData / "cameras.json", scratch.file().parent_path() / "cameras.json");
    const auto scene = loadScene(scratch.file());
    REQUIRE(scene);
    for (const char* name : {"scene.json", "cameras.json", "quad.obj", "quad.mtl"}) {
        INFO(name);
        const std::string file = (scratch.file().parent_path() / name).string();
        CHECK(std::count(scene->files.begin(), scene->files.end(), file) > 0);
    }
}

TEST_CASE("scene_file: an unknown key is named in a warning", "[unit][scene_file]") {
    const ScratchScene scratch(
        R"({"obj": "quad.obj", "notes": "x", "bbox_min": 1,
            "camera": {"eye": [0,0,1], "target": [0,0,0], "fov": 3}})");
    const auto scene = loadScene(scratch.file());
    REQUIRE(scene);
    REQUIRE(scene->warnings.size() == 1);
    CHECK(scene->warnings[0].find("scene.json: /camera/fov: unknown key") != std::string::npos);
    CHECK(scene->warnings[0].find("fov_y_deg") != std::string::npos);
}

TEST_CASE("scene_file: clip planes that are not given enclose the scene", "[unit][scene_file]") {
    const ScratchScene scratch(
        R"({"obj": "quad.obj", "camera": {"eye": [0,0,3], "target": [0,0,0]}})");
    const auto scene = loadScene(scratch.file());
    REQUIRE(scene);
    CHECK(scene->camera.far > 3.1);
    CHECK(scene->camera.near > 0);
    CHECK(scene->camera.near < 2.9);
}

TEST_CASE("scene_file: broken text is refused with line and column", "[unit][scene_file]") {
    CHECK(errorOf("{\"obj\": \"quad.obj\",\n \"cuts\": [1 2]}")
              .find("scene.json:2:13: syntax error") == 0);
    CHECK(errorOf("").find("scene.json:1:1: ") == 0);
    CHECK(errorOf("{\"obj\": NaN}").find("scene.json:1:9: ") == 0);
    CHECK(errorOf("{\"obj\": 1e999}") == "scene.json:1:13: number overflow parsing '1e999'");
    CHECK(errorOf("{\"obj\": \"\xff\"}").find("scene.json:1:") == 0);
    CHECK(errorOf(std::string(100000, '[')).find("nested too deeply") != std::string::npos);
    CHECK(errorOf(R"({"obj": "quad.obj", "obj": "quad.obj"})").find("stands twice") !=
          std::string::npos);
}

TEST_CASE("scene_file: wrong values are refused with their path", "[unit][scene_file]") {
    const auto with = [](const std::string& more) {
        return errorOf(R"({"obj": "quad.obj", )" + more + "}");
    };
    CHECK(errorOf("[]") == "scene.json: /: expected an object, found an array of 0");
    CHECK(errorOf("{}") == "scene.json: /: expected \"obj\" or \"objects\"");
    CHECK(errorOf(R"({"obj": 3})") == "scene.json: /obj: expected a text, found 3");
    CHECK(errorOf(R"({"obj": "none.obj"})").find("scene.json: /obj: none.obj: ") == 0);
    CHECK(errorOf(R"({"objects": []})") ==
          "scene.json: /objects: expected an array of at least 1, found an array of 0");
    CHECK(errorOf(R"({"objects": [{"shape": "blob"}]})").find("scene.json: /objects/0/shape: ") ==
          0);
    CHECK(errorOf(R"({"objects": [{}]})") ==
          "scene.json: /objects/0: expected either \"obj\" or \"shape\"");
    CHECK(with(R"("background": [1, 2])") ==
          "scene.json: /background: expected an array of 3, found an array of 2");
    CHECK(with(R"("background": [1, 2, 1e30])") ==
          "scene.json: /background/2: expected a number from 0 to 1e+06, found 1e+30");
    CHECK(with(R"("camera": {"eye": [0, 0, 1]})") ==
          "scene.json: /camera: expected the key \"target\"");
    CHECK(with(R"("camera": {"eye": [0,0,1], "target": [0,0,0], "fov_y_deg": 180})")
              .find("scene.json: /camera/fov_y_deg: ") == 0);
    CHECK(with(R"("camera": {"eye": [0,0,1], "target": [0,0,0], "near": 2, "far": 1})") ==
          "scene.json: /camera/far: expected a number larger than near, found 1");
    CHECK(with(R"("camera": {"eye": {"keys": []}, "target": [0,0,0]})")
              .find("scene.json: /camera/eye/keys: ") == 0);
    CHECK(with(R"("cuts": [5, 5])") ==
          "scene.json: /cuts/1: expected a frame after the cut before, found 5");
    CHECK(with(R"("cuts": [1.5])").find("scene.json: /cuts/0: expected a whole number") == 0);
    CHECK(with(R"("light": {"direction": [0, 0, 0]})") ==
          "scene.json: /light/direction: expected a direction, found a vector of length 0");
    CHECK(with(R"("light": {"type": "spot", "direction": [0, 1, 0]})") ==
          "scene.json: /light/type: expected \"directional\", found \"spot\"");
    CHECK(with(R"("light": {"direction": [0, 1, 0]}, "lights": {})").find("scene.json: /light: ") ==
          0);
    CHECK(with(R"("lights": {"points": [{"position": [1, 2, "3"]}]})") ==
          "scene.json: /lights/points/0/position/2: expected a number from -1e+09 to 1e+09, "
          "found \"3\"");
    CHECK(with(R"("views": {})").find("scene.json: /views: ") == 0);
}

TEST_CASE("scene_file: wrong sampled light is refused with its path", "[unit][scene_file]") {
    const auto with = [](const std::string& lights) {
        return errorOf(R"({"objects": [{"shape": "box"}], "lights": {)" + lights + "}}");
    };
    CHECK(with(R"("directional": {"direction": [0,1,0], "shadow": {"type": "soft"}})") ==
          "scene.json: /lights/directional/shadow/type: expected \"traced\" or \"map\", found \"soft\"");
    CHECK(with(R"("directional": {"direction": [0,1,0],
                                  "shadow": {"type": "traced", "angle_deg": 91}})")
              .find("scene.json: /lights/directional/shadow/angle_deg: ") == 0);
    CHECK(with(R"("ambient": {"occlusion": {"type": "traced"}})") ==
          "scene.json: /lights/ambient/occlusion: expected the key \"distance\"");
    CHECK(with(R"("ambient": {"occlusion": {"type": "traced", "distance": 1}, "bounce": true})")
              .find("scene.json: /lights/ambient/bounce: ") == 0);
    CHECK(with(R"("spheres": [{"position": [0, 0, 0], "radius": 0}])")
              .find("scene.json: /lights/spheres/0/radius: ") == 0);
    const std::string rectangle = R"("rectangles": [{"centre": [0, 1, 0], "edge_u": [1, 0, 0], )";
    CHECK(with(rectangle + R"("edge_v": [0, 0, 0]}])") ==
          "scene.json: /lights/rectangles/0/edge_v: expected an edge with a length");
    CHECK(with(rectangle + R"("edge_v": [1, 0, 1]}])") ==
          "scene.json: /lights/rectangles/0/edge_v: expected an edge perpendicular to edge_u");
}

TEST_CASE("scene_file: wrong transforms are refused with their path", "[unit][scene_file]") {
    const auto with = [](const std::string& more) {
        return errorOf(R"({"objects": [{"shape": "box", )" + more + "}]}");
    };
    CHECK(with(R"("scale": 0)") == "scene.json: /objects/0/scale: expected a scale without zeros");
    CHECK(with(R"("scale": {"keys": [{"frame": 0, "value": -1}, {"frame": 1, "value": 1}]})")
              .find("scene.json: /objects/0/scale: ") == 0);
    CHECK(with(R"("translation": {"keys": [{"frame": 4, "value": [0,0,0]},
                                           {"frame": 4, "value": [0,0,1]}]})") ==
          "scene.json: /objects/0/translation/keys/1/frame: expected a frame after that of the "
          "key before, found 4");
    CHECK(with(R"("rotation": {"axis": [0,0,0], "degrees": 3})")
              .find("scene.json: /objects/0/rotation/axis: ") == 0);
    CHECK(with(R"("rotation": 3)") ==
          "scene.json: /objects/0/rotation: expected an object, found 3");
    CHECK(with(R"("material": {"opacity": 2})")
              .find("scene.json: /objects/0/material/opacity: expected a number from 0 to 1") == 0);
}

TEST_CASE("scene_file: a missing file and an unknown kind are refused", "[unit][scene_file]") {
    CHECK(loadScene(kData / "none.json").error().message.find("none.json: no such file") !=
          std::string::npos);
    CHECK(loadScene(kData / "none.stl").error().message.find("expected NAME.obj or NAME.json") !=
          std::string::npos);
    CHECK_FALSE(loadScene(kData / "none.obj"));
    CHECK_FALSE(loadScene(kData));
}

TEST_CASE("scene_file: an OBJ file alone is a scene", "[unit][scene_file]") {
    const auto scene = loadScene(kData / "quad.obj");
    REQUIRE(scene);
    CHECK(scene->name == "quad");
    CHECK(scene->automatic_camera);
    CHECK(scene->views.empty());
    CHECK(scene->triangleCount() == 2);
    CHECK(surfaceCount(*scene) == 1);
}

TEST_CASE("scene_file: every shared scene loads as it is", "[unit][scene_file][slow]") {
    if (!fs::is_directory(sharedData())) {
        WARN("skipped: no shared data, set STILL_DATA");
        return;
    }
    int count = 0;
    for (const auto& entry : fs::recursive_directory_iterator(sharedData())) {
        const std::string name = entry.path().filename().string();
        // Sponza's textures take long to decode; the program's own tests render it.
        if (name.find("scene.json") == std::string::npos ||
            entry.path().parent_path().filename() == "sponza") {
            continue;
        }
        const auto scene = loadScene(entry.path());
        INFO(entry.path().string());
        REQUIRE((scene ? "" : scene.error().message) == std::string());
        CHECK(scene->triangleCount() > 0);
        CHECK(scene->views.size() >= 1);
        for (const std::string& warning : scene->warnings) {
            CHECK(warning.find("unknown key") == std::string::npos);
        }
        ++count;
    }
    CHECK(count >= 9);
}

TEST_CASE("scene_file: the camera may be a file of matrices", "[unit][scene_file]") {
    const ScratchScene scratch(R"({"obj": "quad.obj", "camera": {"file": "cameras.json"}})");
    fs::copy_file(kData / "cameras.json", scratch.file().parent_path() / "cameras.json");
    const auto scene = loadScene(scratch.file());
    REQUIRE(scene);
    REQUIRE(cameraFileOf(*scene, {}) == &*scene->camera_file);
    CHECK(scene->camera_file->width == 320);
    CHECK(frameStateAt(*scene, {}, 1, 320, 200).camera.eye == glm::dvec3(1, 2, 6));
    // A view, an orbit and another file go before it.
    CHECK(cameraFileOf(*scene, {.orbit_deg = 10}) == nullptr);
    const CameraFile other{.width = 1, .height = 1, .frames = {{}}, .warnings = {}};
    CHECK(cameraFileOf(*scene, {.file = &other}) == &other);
    CHECK(frameStateAt(*scene, {.orbit_deg = 10}, 0, 320, 200).camera.eye != glm::dvec3(1, 2, 5));
    CHECK(errorOf(R"({"obj": "quad.obj", "camera": {"file": "none.json"}})").find("/camera/file") !=
          std::string::npos);
}
