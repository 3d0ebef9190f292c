// The same bytes whichever way a frame is rasterized.

#include <catch2/catch.hpp>

#include "tests/support/busy_scene.h"
#include "tests/support/plane_compare.h"

using namespace still;
using namespace still::test;

namespace {

void drawWith(TestScene& scene, const FrameView& view, const RasterSettings& settings,
              Workers& workers, GBuffer& out) {
    const DrawList list = scene.list();
    Rasterizer rasterizer;
    rasterizer.transformAndBin(list, view, settings, workers);
    rasterizer.rasterize(out, workers);
}

GBuffer truth(TestScene& scene, const FrameView& view, PlaneSet planes = kAllPlanes) {
    GBuffer out;
    Workers serial(1, Schedule::serial);
    drawWith(scene, view, {.simd = SimdTarget::scalar, .planes = planes}, serial, out);
    return out;
}

}  // namespace

TEST_CASE("equality: every SIMD target gives the bytes of the scalar kernels", "[determinism]") {
    for (uint64_t seed = 0; seed < 6; ++seed) {
        const FrameView view = busyView(seed);
        TestScene scene = busyScene(seed);
        const GBuffer expected = truth(scene, view);
        for (SimdTarget target : availableSimdTargets()) {
            Workers serial(1, Schedule::serial);
            GBuffer out;
            drawWith(scene, view, {.simd = target, .planes = kAllPlanes}, serial, out);
            CAPTURE(seed, name(target));
            CHECK(firstDifference(expected, out) == "");
        }
    }
}

TEST_CASE("equality: forward shading gives the bytes of deferred shading", "[determinism]") {
    for (uint64_t seed = 0; seed < 6; ++seed) {
        const FrameView view = busyView(seed);
        TestScene scene = busyScene(seed);
        const GBuffer expected = truth(scene, view);
        for (SimdTarget target : availableSimdTargets()) {
            Workers serial(1, Schedule::serial);
            GBuffer out;
            drawWith(scene, view,
                     {.simd = target, .shading = Shading::forward, .planes = kAllPlanes}, serial,
                     out);
            CAPTURE(seed, name(target));
            CHECK(firstDifference(expected, out) == "");
        }
    }
}

TEST_CASE("equality: threads and schedules do not show", "[determinism]") {
    const Schedule schedule = GENERATE(Schedule::pooled, Schedule::serial, Schedule::shuffled);
    const int threads = GENERATE(1, 2, 3, 8);
    for (uint64_t seed = 0; seed < 3; ++seed) {
        const FrameView view = busyView(seed);
        TestScene scene = busyScene(seed);
        Workers workers(threads, schedule, seed);
        GBuffer out;
        drawWith(scene, view, {.planes = kAllPlanes}, workers, out);
        CAPTURE(seed, int(schedule), threads);
        CHECK(firstDifference(truth(scene, view), out) == "");
    }
}

TEST_CASE("equality: planes that are not wanted do not change the others", "[determinism]") {
    const FrameView view = busyView(1);
    TestScene scene = busyScene(1);
    const GBuffer expected = truth(scene, view);
    const bool normal = GENERATE(false, true);
    const bool motion = GENERATE(false, true);
    const bool albedo = GENERATE(false, true);
    const GBuffer out = truth(scene, view, {.normal = normal, .motion = motion, .albedo = albedo});
    CHECK(out.normal.empty() == !normal);
    CHECK(out.motion.empty() == !motion);
    CHECK(out.albedo_red.empty() == !albedo);
    CHECK(firstDifference(expected, out) == "");
}

TEST_CASE("equality: windings known beforehand give the bytes of those found out",
          "[determinism]") {
    for (uint64_t seed = 0; seed < 6; ++seed) {
        const FrameView view = busyView(seed);
        TestScene scene = busyScene(seed);
        const GBuffer expected = truth(scene, view);
        std::vector<WindingBits> windings;
        for (const Mesh& mesh : scene.meshes) {
            windings.push_back(windingBits(mesh));
        }
        DrawList list = scene.list();
        list.windings = windings;
        for (SimdTarget target : availableSimdTargets()) {
            GBuffer out;
            draw(list, view, out, {.simd = target, .planes = kAllPlanes});
            CAPTURE(seed, name(target));
            CHECK(firstDifference(expected, out) == "");
        }
    }
}

TEST_CASE("equality: what a rasterizer and a G-buffer drew before does not show", "[determinism]") {
    Workers workers(2);
    Rasterizer rasterizer;
    GBuffer out;
    for (uint64_t seed : {0, 3, 1, 2, 0}) {
        const FrameView view = busyView(seed);
        TestScene scene = busyScene(seed);
        const DrawList list = scene.list();
        rasterizer.transformAndBin(list, view, {.planes = kAllPlanes}, workers);
        rasterizer.rasterize(out, workers);
        CAPTURE(seed);
        CHECK(firstDifference(truth(scene, view), out) == "");
    }
}

TEST_CASE("equality: a rasterizer may be moved, and even between its two steps", "[determinism]") {
    Workers workers(2);
    Rasterizer rasterizer;
    for (uint64_t seed : {4, 5}) {
        const FrameView view = busyView(seed);
        TestScene scene = busyScene(seed);
        const DrawList list = scene.list();
        rasterizer.transformAndBin(list, view, {.planes = kAllPlanes}, workers);
        Rasterizer elsewhere(std::move(rasterizer));
        GBuffer out;
        elsewhere.rasterize(out, workers);
        rasterizer = std::move(elsewhere);
        CAPTURE(seed);
        CHECK(firstDifference(truth(scene, view), out) == "");
    }
}

TEST_CASE("equality: a camera that stops leaves no motion behind", "[determinism]") {
    Workers workers(1);
    Rasterizer rasterizer;
    GBuffer out;
    FrameView view = busyView(2);
    TestScene scene = busyScene(2);
    for (int frame = 0; frame < 3; ++frame) {
        const DrawList list = scene.list();
        rasterizer.transformAndBin(list, view, {.planes = kAllPlanes}, workers);
        rasterizer.rasterize(out, workers);
        CAPTURE(frame);
        CHECK(firstDifference(truth(scene, view), out) == "");
        view.view_projection_before = view.view_projection;
        if (frame == 1) {
            for (Instance& instance : scene.instances) {
                instance.transform_before = instance.transform;
            }
        }
    }
}
