// What programs set on a loaded scene: which way is up, where the eye stands, how bright it is.

#include <catch2/catch.hpp>
#include <cmath>

#include "engine/camera.h"
#include "engine/det_math.h"
#include "engine/frame_loop.h"
#include "engine/load.h"
#include "engine/scene_work.h"
#include "engine/shapes.h"
#include "tests/support/data_path.h"

using namespace still;

namespace {

const std::string kTetrahedron =
    "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
/// The same with y and −z in each other's place: z is up.
const std::string kLying =
    "v 0 0 0\nv 1 0 0\nv 0 0 2\nv 0 -3 0\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

Scene sceneOf(const std::string& text) {
    auto scene = loadSceneText(text, "standard input", {.allow_outside = true});
    REQUIRE(scene.has_value());
    return std::move(*scene);
}

Image<Rgb8> pictureOf(const Scene& scene, const FrameSettings& settings) {
    Workers workers(1);
    FrameLoop loop(scene, settings, workers);
    const ImageView<const Rgb8> output = loop.render(0).output;
    Image<Rgb8> picture(output.width, output.height);
    for (int y = 0; y < output.height; ++y) {
        std::copy_n(output.row(y), output.width, picture.view().row(y));
    }
    return picture;
}

FrameSettings small() {
    FrameSettings settings;
    settings.width = 64;
    settings.height = 36;
    settings.anti_aliasing = AntiAliasing::none;
    return settings;
}

}  // namespace

TEST_CASE("load: text is an OBJ, or a scene file when it begins with a brace", "[unit]") {
    const TempFolder folder;
    const auto file = folder.write("t.obj", kTetrahedron);
    const auto loaded = loadScene(file);
    REQUIRE(loaded.has_value());
    const Scene typed = sceneOf(kTetrahedron);
    CHECK(typed.triangleCount() == 4);
    CHECK(typed.camera.eye.keys[0].value == loaded->camera.eye.keys[0].value);
    CHECK(typed.name == "standard input");
    const std::string names_it = " \n{\"obj\": \"" + file.string() + "\"}";
    const Scene described = sceneOf(names_it);
    CHECK(described.triangleCount() == 4);
    CHECK(described.automatic_light);
    CHECK_FALSE(loadSceneText(names_it, "standard input"));  // not in the present folder
    const auto broken = loadSceneText("{\"obj\": 5}", "standard input");
    REQUIRE_FALSE(broken.has_value());
    CHECK(isOneLineAbout(broken.error().message, "standard input"));
    const auto empty = loadSceneText("", "standard input");
    REQUIRE_FALSE(empty.has_value());
    CHECK(isOneLineAbout(empty.error().message, "standard input"));
}

TEST_CASE("up: a model that lies is lit and seen as one that stands", "[unit]") {
    const Image<Rgb8> standing = pictureOf(sceneOf(kTetrahedron), small());
    Scene lying = sceneOf(kLying);
    setUpAxis(lying, {0, 0, 1});
    const Image<Rgb8> raised = pictureOf(lying, small());
    int different = 0;
    for (int y = 0; y < 36; ++y) {
        for (int x = 0; x < 64; ++x) {
            const Rgb8 a = standing.at(x, y), b = raised.at(x, y);
            different += std::abs(a.r - b.r) > 1 || std::abs(a.g - b.g) > 1 ? 1 : 0;
        }
    }
    CHECK(different <= 4);  // edges may round differently
    CHECK(standing.at(32, 18).r > 0);
}

TEST_CASE("up: every axis may be up, and +y changes nothing", "[unit]") {
    const Scene plain = sceneOf(kTetrahedron);
    for (const glm::dvec3& up : {glm::dvec3(1, 0, 0), glm::dvec3(-1, 0, 0), glm::dvec3(0, 5, 0),
                                 glm::dvec3(0, -1, 0), glm::dvec3(0, 0, -1), glm::dvec3(1, 2, 3)}) {
        Scene scene = plain;
        setUpAxis(scene, up);
        const FrameState state = frameStateAt(scene, {}, 0, 64, 36);
        const glm::dvec3 target = scene.camera.target.keys[0].value;
        const glm::dvec4 above = state.camera.view_projection * glm::dvec4(target + up * 0.01, 1);
        CHECK(above.x == Approx(0).margin(1e-9));
        CHECK(above.y > 0);
        const auto& sun = scene.lights.sun.direction;
        CHECK(sun[0] * up.x + sun[1] * up.y + sun[2] * up.z < 0);
    }
    Scene same = plain;
    setUpAxis(same, {0, 1, 0});
    CHECK(same.camera.eye.keys[0].value == plain.camera.eye.keys[0].value);
    CHECK(same.lights.sun.direction == plain.lights.sun.direction);
}

TEST_CASE("camera: circling goes around to the right, then up, and keeps the distance", "[unit]") {
    const CameraPose pose{.eye = {1, 2, 7}, .target = {1, 2, 3}};
    const CameraPose right = circled(pose, 90, 0);
    CHECK(right.eye.x == Approx(5));
    CHECK(right.eye.y == Approx(2));
    CHECK(right.eye.z == Approx(3));
    const CameraPose above = circled(pose, 0, 30);
    CHECK(above.eye.y == Approx(2 + 4 * 0.5));
    CHECK(above.eye.z == Approx(3 + 4 * std::sqrt(0.75)));
    const CameraPose top = circled(pose, 0, 90);  // over the top, where up cannot stay
    CHECK(top.eye.y == Approx(6));
    CHECK(top.up.z == Approx(-1));
}

TEST_CASE("exposure: a stop doubles light before the tone map, and 1 changes no byte", "[unit]") {
    const auto plain = std::make_unique<OutputTable>();
    const auto brighter = std::make_unique<OutputTable>(ToneMap::none, 2.0);
    const auto mapped = std::make_unique<OutputTable>(ToneMap::reinhard);
    const auto mapped_brighter = std::make_unique<OutputTable>(ToneMap::reinhard, 2.0);
    for (int v = 0; v < 32768; ++v) {
        REQUIRE((*brighter)[uint16_t(v)] == (*plain)[uint16_t(2 * v)]);
        REQUIRE((*mapped_brighter)[uint16_t(v)] == (*mapped)[uint16_t(2 * v)]);
    }
    const Scene scene = sceneOf(kTetrahedron);
    FrameSettings settings = small();
    const Image<Rgb8> before = pictureOf(scene, settings);
    settings.exposure = 0.5;
    CHECK(pictureOf(scene, settings).at(32, 18).r < before.at(32, 18).r);
}

TEST_CASE("background: every sRGB code comes back as it is", "[unit]") {
    const Scene scene = sceneOf(kTetrahedron);
    FrameSettings settings = small();
    settings.width = settings.height = 8;
    for (int code = 0; code < 256; ++code) {
        const float light = float(det::linearFromSrgb(code / 255.0));
        settings.background = {light, light, light};
        REQUIRE(int(pictureOf(scene, settings).at(0, 0).g) == code);
    }
}

TEST_CASE("scene work: surfaces say what their kernels do", "[unit]") {
    const TempFolder folder;
    folder.write("grey.ppm", "P6 2 2 255\nabcabcabcabc");
    folder.write("s.json", R"({"objects": [
        {"shape": "box"},
        {"shape": "box", "material": {"image": "grey.ppm"}},
        {"shape": "box", "material": {"specular": [1, 1, 1], "opacity": 0.5}},
        {"shape": "plane", "material": {"height": {"image": "grey.ppm", "scale": 0.1}}}]})");
    auto scene = loadScene(folder.path() / "s.json");
    REQUIRE(scene.has_value());
    const std::vector<SurfaceWork> work = sceneWork(*scene, {}, 0);
    REQUIRE(work.size() == 4);
    CHECK(work[0].kernel == 0);
    CHECK((work[1].textured && work[1].kernel == 1));
    CHECK((work[2].positioned && work[2].stochastic && work[2].kernel == 2));
    CHECK((work[3].parallax && work[3].kernel == 3));
    scene->lights.points.resize(1);  // lights every surface by its position
    CHECK(sceneWork(*scene, {}, 0)[0].kernel == 2);
}

TEST_CASE("timeline: what changes is told one by one", "[unit]") {
    Scene scene = sceneOf(kTetrahedron);
    CHECK(isStill(scene, {}));
    scene.objects[0].tracks.translation.keys = {{0, {0, 0, 0}}, {9, {1, 0, 0}}};
    CHECK(changesOf(scene, {}).objects);
    CHECK_FALSE(changesOf(scene, {}).camera);
    CHECK(changesOf(scene, {.orbit_deg = 9}).camera);
    scene.cuts = {3};
    CHECK(changesOf(scene, {}).cuts);
    CHECK_FALSE(changesOf(scene, {}).lights);
}
