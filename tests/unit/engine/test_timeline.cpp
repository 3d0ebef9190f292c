#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>

#include "engine/shapes.h"
#include "engine/timeline.h"

using namespace still;

namespace {

/// A still box (one part) and a second object of the same mesh, camera at (0, 0, 5).
Scene twoBoxes() {
    Scene scene;
    scene.meshes.push_back(shapes::box(1, 1, 1));
    scene.mesh_names = {"box"};
    scene.materials.resize(1);
    scene.objects.resize(2);
    scene.camera.eye.keys = {{0, {0, 0, 5}}};
    scene.lights.sun.colour = {0.5f, 0.5f, 0.5f};
    return scene;
}

FrameState stateAt(const Scene& scene, int frame, const CameraChoice& choice = {}) {
    return frameStateAt(scene, choice, frame, 200, 100);
}

/// Position in the picture, x right and y up in −1 … 1, z in −1 … 1.
glm::dvec3 project(const CameraState& camera, const glm::dvec3& p) {
    const glm::dvec4 clip = camera.view_projection * glm::dvec4(p, 1);
    return glm::dvec3(clip) / clip.w;
}

std::array<float, 3> apply(const Affine& m, std::array<float, 3> p) {
    std::array<float, 3> q{};
    for (size_t row = 0; row < 3; ++row) {
        q[row] = m[row * 4] * p[0] + m[row * 4 + 1] * p[1] + m[row * 4 + 2] * p[2] + m[row * 4 + 3];
    }
    return q;
}

}  // namespace

TEST_CASE("timeline: a still scene has identity instances that never move", "[unit][timeline]") {
    const Scene scene = twoBoxes();
    for (int frame : {0, 1, 77}) {
        const FrameState state = stateAt(scene, frame);
        REQUIRE(state.instances.size() == 2);
        for (const Instance& instance : state.instances) {
            CHECK(instance.identity);
            CHECK_FALSE(instance.moved);
            CHECK(instance.transform == kIdentity);
        }
        CHECK(state.camera.view_projection == state.camera_before.view_projection);
        CHECK(state.cut == (frame == 0));
        CHECK_FALSE(state.lighting_changed);
    }
    CHECK(isStill(scene, {}));
}

TEST_CASE("timeline: surfaces are numbered from 1 without gaps", "[unit][timeline]") {
    Scene scene = twoBoxes();
    scene.meshes[0].parts = {{0, 4, 0}, {4, 8, 0}};
    const FrameState state = stateAt(scene, 0);
    CHECK(state.instances[0].object == 1);
    CHECK(state.instances[0].first_surface == 1);
    CHECK(state.instances[1].object == 2);
    CHECK(state.instances[1].first_surface == 3);
    CHECK(surfaceCount(scene) == 4);
}

TEST_CASE("timeline: tracks hold at their ends and are linear between", "[unit][timeline]") {
    Scene scene = twoBoxes();
    scene.objects[1].tracks.translation.keys = {{10, {0, 0, 0}}, {20, {5, 0, 0}}, {30, {5, 8, 0}}};
    const auto placeAt = [&](int frame) {
        return apply(stateAt(scene, frame).instances[1].transform, {0, 0, 0});
    };
    CHECK(placeAt(0) == std::array{0.0f, 0.0f, 0.0f});
    CHECK(placeAt(15) == std::array{2.5f, 0.0f, 0.0f});
    CHECK(placeAt(20) == std::array{5.0f, 0.0f, 0.0f});
    CHECK(placeAt(28) == std::array{5.0f, 6.4f, 0.0f});
    CHECK(placeAt(31) == std::array{5.0f, 8.0f, 0.0f});
    CHECK_FALSE(stateAt(scene, 10).instances[1].moved);
    CHECK(stateAt(scene, 11).instances[1].moved);
    CHECK(stateAt(scene, 30).instances[1].moved);
    CHECK_FALSE(stateAt(scene, 31).instances[1].moved);
    CHECK_FALSE(stateAt(scene, 15).instances[0].moved);
    CHECK_FALSE(isStill(scene, {}));
    for (int frame = 1; frame < 40; ++frame) {
        CHECK(stateAt(scene, frame).instances[1].transform_before ==
              stateAt(scene, frame - 1).instances[1].transform);
    }
}

TEST_CASE("timeline: an object is scaled, then rotated, then moved", "[unit][timeline]") {
    Scene scene = twoBoxes();
    ObjectTracks& tracks = scene.objects[1].tracks;
    tracks.translation.keys = {{0, {10, 0, 0}}};
    tracks.rotation_axis = {0, 0, 1};
    tracks.rotation_deg.keys = {{0, 0}, {4, 360}};
    tracks.scale.keys = {{0, {2, 3, 4}}};
    const Affine quarter = stateAt(scene, 1).instances[1].transform;
    CHECK(apply(quarter, {1, 0, 0}) == std::array{10.0f, 2.0f, 0.0f});
    CHECK(apply(quarter, {0, 1, 0}) == std::array{7.0f, 0.0f, 0.0f});
    CHECK(apply(quarter, {0, 0, 1}) == std::array{10.0f, 0.0f, 4.0f});
    const Affine full = stateAt(scene, 4).instances[1].transform;
    CHECK(full == stateAt(scene, 0).instances[1].transform);
}

TEST_CASE("timeline: base stands before the animation", "[unit][timeline]") {
    Scene scene = twoBoxes();
    scene.objects[0].base[3] = {1, 0, 0, 1};
    scene.objects[0].tracks.scale.keys = {{0, {2, 2, 2}}};
    CHECK(apply(stateAt(scene, 0).instances[0].transform, {0, 0, 0}) ==
          std::array{2.0f, 0.0f, 0.0f});
}

TEST_CASE("timeline: a cut has no past", "[unit][timeline]") {
    Scene scene = twoBoxes();
    scene.camera.eye.keys = {{0, {0, 0, 5}}, {9, {9, 0, 5}}, {10, {0, 9, 5}}};
    scene.objects[0].tracks.translation.keys = {{0, {0, 0, 0}}, {20, {1, 0, 0}}};
    scene.lights.sun_intensity.keys = {{0, 0}, {20, 1}};
    scene.cuts = {10, 15};
    const FrameState before = stateAt(scene, 9), cut = stateAt(scene, 10),
                     after = stateAt(scene, 11);
    CHECK_FALSE(before.cut);
    CHECK(before.instances[0].moved);
    CHECK(before.lighting_changed);
    CHECK(cut.cut);
    CHECK(cut.camera_before.view_projection == cut.camera.view_projection);
    CHECK_FALSE(cut.instances[0].moved);
    CHECK(cut.instances[0].transform_before == cut.instances[0].transform);
    CHECK_FALSE(cut.lighting_changed);
    CHECK(after.instances[0].transform_before == cut.instances[0].transform);
    CHECK(after.instances[0].moved);
    CHECK(lastCut(scene, {}, 9) == 0);
    CHECK(lastCut(scene, {}, 14) == 10);
    CHECK(lastCut(scene, {}, 15) == 15);
    CHECK(lastCut(scene, {}, 999) == 15);
}

TEST_CASE("timeline: intensities multiply the lights' colours", "[unit][timeline]") {
    Scene scene = twoBoxes();
    scene.lights.ambient = {0.5f, 0.25f, 1.0f};
    scene.lights.ambient_intensity.keys = {{0, 2}};
    scene.lights.points = {{{0, 1, 0}, {1, 1, 1}}, {{0, 2, 0}, {1, 0, 0}}};
    scene.lights.point_intensity = {{}, {{{0, 0}, {10, 5}}}};
    const Lighting lighting = stateAt(scene, 4).lighting;
    CHECK(lighting.ambient == std::array{1.0f, 0.5f, 2.0f});
    CHECK(lighting.points[0].colour == std::array{1.0f, 1.0f, 1.0f});
    CHECK(lighting.points[1].colour == std::array{2.0f, 0.0f, 0.0f});
    CHECK(stateAt(scene, 10).lighting_changed);
    CHECK_FALSE(stateAt(scene, 11).lighting_changed);
    CHECK_FALSE(isStill(scene, {}));
}

TEST_CASE("timeline: sampled light changes apart from the light of colours", "[unit][timeline]") {
    Scene scene = twoBoxes();
    SceneLights& lights = scene.lights;
    lights.sun.colour = {1, 1, 1};
    lights.sun_intensity.keys = {{0, 1}, {5, 1}, {6, 2}};
    lights.spheres = {{.position = {{{0, {0, 3, 0}}, {2, {2, 3, 0}}}}, .radius = 0.5}};
    lights.rectangles = {{.centre = {{{0, {0, 3, 0}}}}, .intensity = {{{10, 1}, {11, 0}}}}};
    const SphereLight moving = stateAt(scene, 1).lighting.sampled.spheres[0];
    CHECK(moving.position == std::array{1.0f, 3.0f, 0.0f});
    CHECK(moving.radius == 0.5f);
    CHECK_FALSE(isStill(scene, {}));
    const auto changes = [&](int frame) {
        const FrameState state = stateAt(scene, frame);
        return std::pair(state.lighting_changed, state.sampled_light_changed);
    };
    CHECK(changes(1) == std::pair(false, true));  // the ball of light moves
    CHECK(changes(4) == std::pair(false, false));
    CHECK(changes(6) == std::pair(true, false));   // the sun, which is not sampled
    CHECK(changes(11) == std::pair(false, true));  // the rectangle goes out
    lights.sun_shadow = SunShadow::traced;
    CHECK(changes(6) == std::pair(false, true));
}

TEST_CASE("timeline: the camera looks along −z with OpenGL clip space", "[unit][timeline]") {
    Scene scene = twoBoxes();
    scene.camera.fov_y_deg.keys = {{0, 90}};
    scene.camera.near = 1;
    scene.camera.far = 100;
    const CameraState camera = stateAt(scene, 0).camera;
    CHECK(camera.eye == glm::dvec3(0, 0, 5));
    CHECK(project(camera, {0, 0, 4}).z == Approx(-1));
    CHECK(project(camera, {0, 0, -95}).z == Approx(1));
    const glm::dvec3 corner = project(camera, {2, 1, 4});  // aspect 2, 45° up
    CHECK(corner.x == Approx(1));
    CHECK(corner.y == Approx(1));
}

TEST_CASE("timeline: a camera that looks along its up vector still works", "[unit][timeline]") {
    Scene scene = twoBoxes();
    scene.camera.eye.keys = {{0, {0, 5, 0}}};
    const CameraState camera = stateAt(scene, 0).camera;
    const glm::dvec3 centre = project(camera, {0, 0, 0});
    CHECK(centre.x == Approx(0).margin(1e-12));
    CHECK(centre.y == Approx(0).margin(1e-12));
    scene.camera.target.keys = {{0, {0, 5, 0}}};
    CHECK(std::isfinite(project(stateAt(scene, 0).camera, {0, 5, -3}).x));
}

TEST_CASE("timeline: an orbit circles the target and comes back", "[unit][timeline]") {
    Scene scene = twoBoxes();
    scene.camera.target.keys = {{0, {1, 0, 0}}};
    const CameraChoice orbit{.orbit_deg = 360, .orbit_frames = 8};
    const glm::dvec3 start = stateAt(scene, 0, orbit).camera.eye;
    CHECK(start == glm::dvec3(0, 0, 5));
    const glm::dvec3 quarter = stateAt(scene, 2, orbit).camera.eye;
    CHECK(quarter.x == Approx(6));
    CHECK(quarter.y == Approx(0));
    CHECK(quarter.z == Approx(1));
    CHECK(stateAt(scene, 8, orbit).camera.eye == start);
    CHECK(stateAt(scene, 3, orbit).camera_before.eye == stateAt(scene, 2, orbit).camera.eye);
    CHECK_FALSE(isStill(scene, orbit));
}

TEST_CASE("timeline: a named view replaces an animated camera", "[unit][timeline]") {
    Scene scene = twoBoxes();
    scene.camera.eye.keys = {{0, {0, 0, 5}}, {9, {9, 0, 5}}};
    scene.views = {{"side", {.eye = {7, 0, 0}, .target = {0, 0, 0}}}};
    const CameraChoice view{.view = 0};
    CHECK(stateAt(scene, 5, view).camera.eye == glm::dvec3(7, 0, 0));
    CHECK(isStill(scene, view));
    CHECK_FALSE(isStill(scene, {}));
}

TEST_CASE("timeline: a camera file gives matrices, eye and jitter", "[unit][timeline]") {
    const Scene scene = twoBoxes();
    const CameraState own = stateAt(scene, 0).camera;
    CameraFile file{.width = 2, .height = 1, .frames = {}, .warnings = {}};
    CameraFileFrame entry;
    entry.view[3] = {1, -2, -5, 1};
    entry.view[0] = {0, 0, -1, 0};  // turned by a quarter
    entry.view[2] = {1, 0, 0, 0};
    entry.projection[2] = {0, 0, -1, -1};
    file.frames = {entry, entry};
    file.frames[1].jitter_fx8 = {3, -4};
    const CameraChoice choice{.file = &file};
    const FrameState first = stateAt(scene, 0, choice), late = stateAt(scene, 9, choice);
    CHECK(first.camera.view_projection == entry.projection * entry.view);
    const glm::dvec4 seen = entry.view * glm::dvec4(first.camera.eye, 1);
    CHECK(glm::length(glm::dvec3(seen)) < 1e-12);
    CHECK_FALSE(first.jitter_fx8);
    CHECK(late.jitter_fx8 == std::array{3, -4});
    CHECK_FALSE(isStill(scene, choice));
    file.frames.pop_back();
    CHECK(isStill(scene, choice));
    CHECK(own.eye != first.camera.eye);
}

namespace {

Scene movingScene() {
    Scene scene = twoBoxes();
    scene.objects[0].tracks.translation.keys = {{0, {0, 0, 0}}, {10, {5, 0, 0}}};
    return scene;
}

CameraFileFrame showing(int scene_frame, bool cut = false) {
    return {.scene_frame = scene_frame, .cut = cut};
}

}  // namespace

TEST_CASE("timeline: a camera file's frames show the instants that they name", "[unit][timeline]") {
    const Scene scene = movingScene();
    const CameraFile file{.frames = {showing(4), showing(5), showing(5), showing(9)}};
    const CameraChoice choice{.file = &file};
    const auto at = [&](int frame) { return frameStateAt(scene, choice, frame, 16, 9); };
    const auto plain = [&](int frame) { return frameStateAt(scene, {}, frame, 16, 9); };

    CHECK(at(0).cut);
    CHECK(at(0).instances[0].transform == plain(4).instances[0].transform);
    CHECK(at(1).instances[0].transform == plain(5).instances[0].transform);
    CHECK(at(1).instances[0].transform_before == plain(4).instances[0].transform);
    CHECK_FALSE(at(2).instances[0].moved);
    CHECK(at(3).instances[0].transform_before == plain(5).instances[0].transform);
    CHECK(at(3).instances[0].transform == plain(9).instances[0].transform);
    CHECK_FALSE(at(7).instances[0].moved);  // beyond its end the last entry goes on
}

TEST_CASE("timeline: a camera file cuts where it says so and where it goes over a scene's cut",
          "[unit][timeline]") {
    Scene scene = movingScene();
    scene.cuts = {6};
    const CameraFile file{
        .frames = {showing(4), showing(5, true), showing(6), showing(6), showing(3)}};
    const CameraChoice choice{.file = &file};
    const auto cut = [&](int frame) { return frameStateAt(scene, choice, frame, 16, 9).cut; };
    CHECK(cut(1));
    CHECK(cut(2));
    CHECK_FALSE(cut(3));
    CHECK(cut(4));
    CHECK(lastCut(scene, choice, 1) == 1);
    CHECK(lastCut(scene, choice, 3) == 2);
    CHECK(lastCut(scene, choice, 9) == 4);
}

TEST_CASE("timeline: a moving scene is still in a camera file that shows one instant of it",
          "[unit][timeline]") {
    const Scene scene = movingScene();
    CameraFile file{.frames = {showing(4, true)}};
    CHECK(isStill(scene, {.file = &file}));
    file.frames.push_back(showing(5));
    CHECK_FALSE(isStill(scene, {.file = &file}));
    file.frames = {{}};
    CHECK_FALSE(isStill(scene, {.file = &file}));
}
