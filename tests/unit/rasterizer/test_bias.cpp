// RasterSettings beyond the planes: the bias of mip levels, and motion of the camera alone.

#include <catch2/catch.hpp>

#include "tests/support/busy_scene.h"
#include "tests/support/plane_compare.h"

using namespace still;
using namespace still::test;

namespace {

GBuffer drawn(TestScene& scene, const FrameView& view, const RasterSettings& settings) {
    GBuffer out;
    draw(scene.list(), view, out, settings);
    return out;
}

/// A screen whose texture takes level 3 of 8; level k is the code 100·k.
TestScene levelThree(const FrameView& view) {
    TestScene scene;
    std::vector<std::array<uint32_t, 3>> colours;
    for (uint32_t level = 0; level <= 8; ++level) {
        colours.push_back({100 * level, 100 * level, 100 * level});
    }
    scene.textures = {levelTexture(256, colours, Wrap::repeat)};
    scene.materials[0].diffuse = {1, 1, 1};
    scene.materials[0].colour_texture = 0;
    std::array<TestVertex, 4> c{atPixel(view, 0, view.height, 0.5),
                                atPixel(view, view.width, view.height, 0.5),
                                atPixel(view, view.width, 0, 0.5), atPixel(view, 0, 0, 0.5)};
    const float repeats = float(view.width) * 8.0f / 256.0f;
    const float u[4] = {0, repeats, repeats, 0}, v[4] = {0, 0, repeats, repeats};
    for (size_t k = 0; k < 4; ++k) {
        c[k].attributes.u = u[k];
        c[k].attributes.v = v[k];
    }
    scene.addQuad(c);
    return scene;
}

}  // namespace

TEST_CASE("bias: a whole step takes the next mip level, within the chain", "[texture]") {
    FrameView view;
    view.width = view.height = 128;
    TestScene scene = levelThree(view);
    for (int steps = -5; steps <= 7; ++steps) {
        const GBuffer out = drawn(scene, view, {.planes = kAllPlanes, .mip_bias_fx8 = 256 * steps});
        const int level = std::clamp(3 + steps, 0, 8);
        const double linear = (level / 10.23) * (level / 10.23);
        CAPTURE(steps);
        CHECK(out.red.at(60, 70) == Approx(linear * 4096).margin(1));
    }
}

TEST_CASE("bias: SIMD targets and forward shading give the scalar bytes", "[determinism]") {
    const int bias_fx8 = GENERATE(-300, -128, 77, 512);
    for (uint64_t seed = 0; seed < 3; ++seed) {
        const FrameView view = busyView(seed);
        TestScene scene = busyScene(seed);
        RasterSettings settings{.simd = SimdTarget::scalar,
                                .planes = kAllPlanes,
                                .mip_bias_fx8 = bias_fx8,
                                .camera_motion_only = seed % 2 == 0};
        const GBuffer expected = drawn(scene, view, settings);
        CHECK(firstDifference(expected, drawn(scene, view, {.planes = kAllPlanes})) != "");
        for (SimdTarget target : availableSimdTargets()) {
            CAPTURE(seed, bias_fx8, name(target));
            settings.simd = target;
            settings.shading = Shading::deferred;
            CHECK(firstDifference(expected, drawn(scene, view, settings)) == "");
            settings.shading = Shading::forward;
            CHECK(firstDifference(expected, drawn(scene, view, settings)) == "");
        }
    }
}

TEST_CASE("camera motion: moved objects follow the camera, all else is the same", "[motion]") {
    for (uint64_t seed = 0; seed < 3; ++seed) {
        const FrameView view = busyView(seed);
        TestScene scene = busyScene(seed);
        const GBuffer full = drawn(scene, view, {.planes = kAllPlanes});
        const GBuffer camera =
            drawn(scene, view, {.planes = kAllPlanes, .camera_motion_only = true});
        TestScene resting = scene;
        for (Instance& instance : resting.instances) {
            instance.transform_before = instance.transform;
        }
        const GBuffer expected = drawn(resting, view, {.planes = kAllPlanes});
        int wrong = 0, differing = 0;
        for (int y = 0; y < view.height; ++y) {
            for (int x = 0; x < view.width; ++x) {
                wrong += camera.motion.at(x, y) == expected.motion.at(x, y) ? 0 : 1;
                wrong += camera.depth_before.at(x, y) == expected.depth_before.at(x, y) ? 0 : 1;
                wrong += camera.id.at(x, y) == full.id.at(x, y) ? 0 : 1;
                wrong += camera.red.at(x, y) == full.red.at(x, y) ? 0 : 1;
                differing += camera.motion.at(x, y) == full.motion.at(x, y) ? 0 : 1;
            }
        }
        CAPTURE(seed);
        CHECK(wrong == 0);
        CHECK(differing > 0);
    }
}
