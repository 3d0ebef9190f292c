// Parallel projection from the pose to the resolved picture.

#include <catch2/catch.hpp>
#include <cmath>

#include "engine/camera.h"
#include "engine/frame_loop.h"
#include "engine/load.h"
#include "engine/shapes.h"
#include "engine/timeline.h"

using namespace still;

namespace {

constexpr int kWidth = 128, kHeight = 96;

/// Boxes one behind the other before a wall, seen along −z; a pixel is 1/16 wide.
Scene rowOfBoxes() {
    Scene scene;
    scene.meshes = {shapes::box(1, 1, 1), shapes::box(40, 40, 0.5f)};
    scene.mesh_names = {"box", "wall"};
    scene.materials.resize(2);
    scene.materials[0].diffuse = {0.9f, 0.3f, 0.1f};
    scene.materials[1].diffuse = {0.2f, 0.4f, 0.5f};
    scene.meshes[1].parts[0].material = 1;
    for (int i = 0; i < 4; ++i) {
        SceneObject object;
        object.tracks.translation.keys = {{0, {-2.3 + 1.4 * i, -0.8 + 0.5 * i, -2.0 * i}}};
        object.tracks.rotation_axis = {0, 0, 1};
        object.tracks.rotation_deg.keys = {{0, 17.0 * i}};
        scene.objects.push_back(object);
    }
    scene.objects.emplace_back().mesh = 1;
    scene.objects.back().tracks.translation.keys = {{0, {0, 0, -9}}};
    scene.lights.sun = {{0.0f, -0.6f, -0.8f}, {0.7f, 0.7f, 0.7f}};
    Camera& camera = scene.camera;
    camera.orthographic = true;
    camera.fov_y_deg.keys = {{0, 90}};  // half the height is the distance to the target, 3
    camera.eye.keys = {{0, {0, 0, 3}}};
    camera.target.keys = {{0, {0, 0, 0}}};
    camera.near = -1;
    camera.far = 15;
    return scene;
}

FrameSettings settingsOf(AntiAliasing anti_aliasing) {
    FrameSettings settings;
    settings.width = kWidth;
    settings.height = kHeight;
    settings.anti_aliasing = anti_aliasing;
    settings.fresh_gbuffer = true;
    settings.planes = {.normal = true, .motion = true};
    return settings;
}

/// The camera slides to the left by `pixels` a frame.
void pan(Scene& scene, double pixels) {
    const double step = pixels * 2 * 3 / kHeight;
    scene.camera.eye.keys = {{0, {0, 0, 3}}, {100, {-100 * step, 0, 3}}};
    scene.camera.target.keys = {{0, {0, 0, 0}}, {100, {-100 * step, 0, 0}}};
}

double meanSquare(const FrameResult& frame, const Image<Rgb8>& expected) {
    double sum = 0;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const double d = frame.output.at(x, y).r - expected.at(x, y).r;
            sum += d * d;
        }
    }
    return sum / (kWidth * kHeight);
}

Image<Rgb8> copyOf(ImageView<const Rgb8> view) {
    Image<Rgb8> copy(view.width, view.height);
    for (int y = 0; y < view.height; ++y) {
        std::copy_n(view.row(y), view.width, copy.view().row(y));
    }
    return copy;
}

}  // namespace

TEST_CASE("orthographic: size does not depend on depth and is the perspective one at the target",
          "[unit][orthographic]") {
    Scene scene = rowOfBoxes();
    scene.camera.fov_y_deg.keys = {{0, 50}};
    const auto project = [&](const glm::dvec3& p) {
        const FrameState state = frameStateAt(scene, {}, 0, kWidth, kHeight);
        const glm::dvec4 clip = state.camera.view_projection * glm::dvec4(p, 1);
        return glm::dvec3(clip) / clip.w;
    };
    const glm::dvec3 near = project({0.4, 0.3, 2}), middle = project({0.4, 0.3, 0}),
                     far = project({0.4, 0.3, -8});
    CHECK(near.x == Approx(middle.x));
    CHECK(far.y == Approx(middle.y));
    scene.camera.orthographic = false;
    scene.camera.near = 0.1;
    CHECK(project({0.4, 0.3, 0}).x == Approx(middle.x));
    CHECK(project({0.4, 0.3, 0}).y == Approx(middle.y));
}

TEST_CASE("orthographic: what lies between near and far has depths from 1 down to 0.5",
          "[unit][orthographic]") {
    const Scene scene = rowOfBoxes();
    const FrameState state = frameStateAt(scene, {}, 0, kWidth, kHeight);
    const auto depthOf = [&](double z) {
        const glm::dvec4 clip = state.camera.view_projection * glm::dvec4(0, 0, z, 1);
        return (clip.w - clip.z) / (2 * clip.w);
    };
    CHECK(depthOf(3 + 1) == Approx(1));
    CHECK(depthOf(3 - 15) == Approx(0.5));
    CHECK(depthOf(3 - 7) == Approx(0.75));
}

TEST_CASE("orthographic: framing fills the picture, whichever way is up", "[unit][orthographic]") {
    for (const glm::dvec3& up : {glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1), glm::dvec3(-1, 0, 0)}) {
        for (const bool orthographic : {false, true}) {
            Scene scene = rowOfBoxes();
            scene.objects.pop_back();
            scene.camera = {};
            scene.camera.orthographic = orthographic;
            frameScene(scene, {0.5, 0.35, 1}, double(kWidth) / kHeight, up);
            const FrameState state = frameStateAt(scene, {}, 0, kWidth, kHeight);
            double most = 0;
            for (const Instance& instance : state.instances) {
                const Mesh& mesh = scene.meshes[instance.mesh];
                for (uint32_t i = 0; i < mesh.vertexCount(); ++i) {
                    glm::dvec4 p(0, 0, 0, 1);
                    for (int r = 0; r < 3; ++r) {
                        const float* m = &instance.transform[size_t(4 * r)];
                        p[r] = m[0] * mesh.x[i] + m[1] * mesh.y[i] + m[2] * mesh.z[i] + m[3];
                    }
                    const glm::dvec4 clip = state.camera.view_projection * p;
                    most = std::max({most, std::abs(clip.x / clip.w), std::abs(clip.y / clip.w)});
                    CHECK(clip.z >= -clip.w);
                    CHECK(clip.z <= (orthographic ? 1e-9 : clip.w));
                }
            }
            CHECK(most == Approx(0.9).epsilon(1e-5));
            const glm::dvec4 above = state.camera.view_projection *
                                     glm::dvec4(scene.camera.target.keys[0].value + up, 1);
            CHECK(above.x == Approx(0).margin(1e-9));
            CHECK(above.y > 0);
        }
    }
}

TEST_CASE("orthographic: under a pan near and far move by the same, and exactly that much",
          "[unit][orthographic]") {
    Scene scene = rowOfBoxes();
    pan(scene, 3);
    Workers workers(1);
    FrameLoop loop(scene, settingsOf(AntiAliasing::none), workers);
    const Image<Rgb8> before = copyOf(loop.render(4).output);
    const FrameResult now = loop.render(5);
    int wrong_motion = 0, wrong_colour = 0;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 3; x < kWidth; ++x) {
            const Motion motion = now.gbuffer->motion.at(x, y);
            wrong_motion += motion.x_fx8 != -3 * 256 || motion.y_fx8 != 0 ? 1 : 0;
            wrong_colour += now.output.at(x, y) != before.at(x - 3, y) ? 1 : 0;
        }
    }
    CHECK(wrong_motion == 0);
    CHECK(wrong_colour == 0);
}

TEST_CASE("orthographic: a still picture is the mean of its samples, at depth after depth",
          "[unit][orthographic]") {
    const Scene scene = rowOfBoxes();
    Workers workers(1);
    FrameSettings finished = settingsOf(AntiAliasing::taa);
    finished.subframes = 64;
    FrameLoop taa(scene, finished, workers);
    FrameSettings reference = settingsOf(AntiAliasing::ssaa);
    reference.ssaa_samples = 256;
    FrameLoop ssaa(scene, reference, workers);
    const Image<Rgb8> expected = copyOf(ssaa.render(0).output);
    CHECK(meanSquare(taa.render(0), expected) < 1.5);
}

TEST_CASE("orthographic: history is followed under a moving camera as it is in perspective",
          "[unit][orthographic]") {
    // What TAA leaves of the raw picture's error, for both projections of the same scene.
    double left[2] = {};
    for (const bool orthographic : {false, true}) {
        Scene scene = rowOfBoxes();
        scene.camera.orthographic = orthographic;
        scene.camera.near = orthographic ? -1 : 0.1;
        scene.camera.far = orthographic ? 30 : 100;
        CameraChoice orbit;
        orbit.orbit_deg = 40;
        orbit.orbit_frames = 32;
        double error[3] = {};
        Image<Rgb8> expected;
        for (const AntiAliasing mode :
             {AntiAliasing::ssaa, AntiAliasing::none, AntiAliasing::taa}) {
            Workers workers(1);
            FrameSettings settings = settingsOf(mode);
            settings.camera = orbit;
            FrameLoop loop(scene, settings, workers);
            const FrameResult frame = loop.render(20);
            if (mode == AntiAliasing::ssaa) {
                expected = copyOf(frame.output);
            }
            error[mode == AntiAliasing::taa] = meanSquare(frame, expected);
        }
        left[orthographic] = error[1] / error[0];
    }
    INFO("perspective " << left[0] << ", orthographic " << left[1]);
    CHECK(left[0] < 0.5);
    CHECK(left[1] < 0.5);
    CHECK(left[1] < left[0] * 1.3);
}

TEST_CASE("orthographic: a camera file of a pose gives the same frame", "[unit][orthographic]") {
    const Scene scene = rowOfBoxes();
    const CameraPose pose{.eye = {0, 0, 3}, .fov_y_deg = 90, .orthographic = true};
    const double aspect = double(kWidth) / kHeight;
    CameraFile file{.width = kWidth, .height = kHeight};
    file.frames = {cameraFrame(pose, scene.camera.near, scene.camera.far, aspect)};
    const CameraState posed = frameStateAt(scene, {}, 0, kWidth, kHeight).camera;
    const CameraState filed = frameStateAt(scene, {.file = &file}, 0, kWidth, kHeight).camera;
    CHECK(posed.view_projection == filed.view_projection);
    CHECK(posed.eye == filed.eye);
    CHECK(posed.eye.z > 10000);
}

TEST_CASE("orthographic: a flat wall shines evenly, because it is seen from one direction",
          "[unit][orthographic]") {
    Scene scene = rowOfBoxes();
    scene.objects.erase(scene.objects.begin(), scene.objects.begin() + 4);
    scene.materials[1].specular = {0.8f, 0.8f, 0.8f};
    scene.materials[1].shininess = 60;
    scene.lights.sun = {{0, 0, -1}, {0.5f, 0.5f, 0.5f}};
    Workers workers(1);
    FrameLoop loop(scene, settingsOf(AntiAliasing::none), workers);
    const FrameResult frame = loop.render(0);
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            REQUIRE(frame.output.at(x, y) == frame.output.at(kWidth / 2, kHeight / 2));
        }
    }
    scene.materials[1].specular = {0, 0, 0};
    FrameLoop dull(scene, settingsOf(AntiAliasing::none), workers);
    CHECK(dull.render(0).output.at(9, 9).r < frame.output.at(9, 9).r);
}
