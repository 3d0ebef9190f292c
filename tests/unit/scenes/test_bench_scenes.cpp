#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>

#include "demos/scenes/bench_scenes.h"
#include "demos/scenes/builtin.h"
#include "engine/frame_loop.h"
#include "engine/hash.h"
#include "engine/timeline.h"

using namespace still;

namespace {

constexpr int kWidth = 1920, kHeight = 1080;

Scene built(const std::string& name) {
    Result<Scene> scene = builtinScene(name);
    REQUIRE(scene.has_value());
    return std::move(*scene);
}

struct Pixel {
    double x, y;
};

/// Where a point is on a picture of kWidth × kHeight.
Pixel onScreen(const glm::dmat4& view_projection, const glm::dvec3& p) {
    const glm::dvec4 c = view_projection * glm::dvec4(p, 1);
    return {(c.x / c.w + 1) / 2 * kWidth, (1 - c.y / c.w) / 2 * kHeight};
}

/// The area of all triangles on the screen, over that of the screen. They must not cross the near
/// plane.
double coverage(const Scene& scene) {
    const FrameState state = frameStateAt(scene, {}, 0, kWidth, kHeight);
    double sum = 0;
    for (const Instance& instance : state.instances) {
        const Affine& m = instance.transform;
        const Mesh& mesh = scene.meshes[instance.mesh];
        std::vector<Pixel> places;
        for (uint32_t i = 0; i < mesh.vertexCount(); ++i) {
            const double p[3] = {mesh.x[i], mesh.y[i], mesh.z[i]};
            glm::dvec3 world;
            for (int k = 0; k < 3; ++k) {
                const float* row = &m[size_t(4 * k)];
                world[k] = row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3];
            }
            places.push_back(onScreen(state.camera.view_projection, world));
        }
        for (size_t i = 0; i < mesh.indices.size(); i += 3) {
            const Pixel a = places[mesh.indices[i]], b = places[mesh.indices[i + 1]],
                        c = places[mesh.indices[i + 2]];
            sum += std::abs((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y)) / 2;
        }
    }
    return sum / (kWidth * kHeight);
}

bool anyMoves(const FrameState& state) {
    return std::any_of(state.instances.begin(), state.instances.end(),
                       [](const Instance& instance) { return instance.moved; });
}

}  // namespace

TEST_CASE("bench scenes: a frozen scene is still", "[scenes][unit]") {
    Scene scene;
    scene.camera.eye.keys = {{0, {0, 0, 5}}, {9, {1, 0, 5}}};
    scene.lights.sun_intensity.keys = {{0, 1.0}, {3, 0.5}};
    scene.cuts = {4};
    REQUIRE_FALSE(isStill(scene, {}));
    const Scene still = frozen(scene);
    CHECK(isStill(still, {}));
    CHECK(still.camera.eye.keys.size() == 1);
}

TEST_CASE("bench scenes: triangles and what they cover are as announced", "[scenes][unit]") {
    const Scene tiny = built("bench-tiny"), mid = built("bench-mid");
    CHECK(tiny.triangleCount() == 1000000);
    CHECK(coverage(tiny) * kWidth * kHeight / double(tiny.triangleCount()) ==
          Approx(2.0).epsilon(0.1));
    CHECK(mid.triangleCount() == Approx(70000).epsilon(0.02));
    CHECK(coverage(mid) == Approx(1.5).epsilon(0.05));
    for (const char* name : {"bench-fill-front", "bench-fill-back"}) {
        const Scene fill = built(name);
        CHECK(fill.triangleCount() == 8);
        CHECK(coverage(fill) == Approx(4 * 1.3 * 1.3).epsilon(0.001));
    }
}

TEST_CASE("bench scenes: every scene has every motion and nothing else moves", "[scenes][unit]") {
    for (const std::string& name : benchSceneNames()) {
        INFO(name);
        const Scene scene = built(name);
        const auto still = benchScene(scene, BenchMotion::still, kHeight);
        const auto pan = benchScene(scene, BenchMotion::pan, kHeight);
        const auto objects = benchScene(scene, BenchMotion::objects, kHeight);
        REQUIRE((still && pan && objects));
        CHECK(isStill(*still, {}));
        for (int frame : {1, 7, kPanTurn, kPanTurn + 1, 3 * kPanTurn + 5}) {
            const FrameState panning = frameStateAt(*pan, {}, frame, kWidth, kHeight);
            CHECK_FALSE(anyMoves(panning));
            const glm::dvec3 target = scene.camera.target.keys[0].value;
            const Pixel now = onScreen(panning.camera.view_projection, target),
                        before = onScreen(panning.camera_before.view_projection, target);
            CHECK(std::abs(now.x - before.x) == Approx(kPanPx).epsilon(0.02));
            const FrameState moving = frameStateAt(*objects, {}, frame, kWidth, kHeight);
            CHECK(anyMoves(moving));
            CHECK(moving.camera.view_projection == moving.camera_before.view_projection);
        }
    }
}

TEST_CASE("bench scenes: a framed model turns before the camera, and has no moving objects",
          "[scenes][unit]") {
    Scene scene = frozen(built("cubes"));
    scene.automatic_camera = true;
    CHECK_FALSE(benchScene(scene, BenchMotion::objects, kHeight).has_value());
    const auto pan = benchScene(scene, BenchMotion::pan, kHeight);
    REQUIRE(pan.has_value());
    const glm::dvec3 target = scene.camera.target.keys[0].value;
    const double distance = glm::length(scene.camera.eye.keys[0].value - target);
    CHECK(pan->camera.target.keys.size() == 1);
    for (int frame : {1, 20, 40, 100}) {
        const FrameState state = frameStateAt(*pan, {}, frame, kWidth, kHeight);
        CHECK(glm::length(state.camera.eye - target) == Approx(distance).epsilon(1e-4));
        CHECK(state.camera.view_projection != state.camera_before.view_projection);
    }
}

TEST_CASE("bench scenes: the order of the layers cannot be seen", "[scenes][unit]") {
    Workers workers(1, Schedule::serial);
    std::vector<uint64_t> hashes;
    for (const char* name : {"bench-fill-front", "bench-fill-back"}) {
        const Scene scene = built(name);
        FrameSettings settings;
        settings.width = 160;
        settings.height = 90;
        settings.anti_aliasing = AntiAliasing::none;
        FrameLoop loop(scene, settings, workers);
        const FrameResult result = loop.render(3);
        hashes.push_back(hashFrame(result.output, *result.gbuffer).output);
    }
    CHECK(hashes[0] == hashes[1]);
}
