// Frames that are smaller than the picture.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>

#include "engine/frame_loop.h"
#include "engine/hash.h"
#include "engine/shapes.h"
#include "postfx/metrics.h"
#include "postfx/spatial_upscale.h"

using namespace still;

namespace {

constexpr int kWidth = 163, kHeight = 91;

/// A ball that rolls over a floor until frame 20.
Scene ballScene(bool rolls) {
    Scene scene;
    scene.meshes = {shapes::plane(4, 4, 4, 4, 1), shapes::torus(0.35f, 24, 10)};
    scene.mesh_names = {"floor", "ring"};
    scene.materials.resize(2);
    scene.materials[1].diffuse = {0.9f, 0.2f, 0.1f};
    scene.meshes[1].parts[0].material = 1;
    scene.objects.resize(2);
    scene.objects[1].mesh = 1;
    scene.objects[1].tracks.translation.keys = {{0, {0, 1, 0}}};
    if (rolls) {
        scene.objects[1].tracks.translation.keys.push_back({20, {1, 1, 0}});
    }
    scene.camera.eye.keys = {{0, {1, 2, 5}}};
    scene.camera.target.keys = {{0, {0, 0.5, 0}}};
    scene.lights.sun = {{0.0f, -0.6f, -0.8f}, {0.7f, 0.7f, 0.7f}};
    scene.background = {0.1f, 0.2f, 0.4f};
    return scene;
}

FrameSettings settingsOf(const char* preset) {
    FrameSettings settings;
    settings.width = kWidth;
    settings.height = kHeight;
    settings.policy = findPreset(preset)->policy;
    return settings;
}

std::vector<uint64_t> hashesOf(FrameLoop& loop, const std::vector<int>& frames) {
    std::vector<uint64_t> hashes;
    for (const int frame : frames) {
        hashes.push_back(hashPlane(loop.render(frame).output));
    }
    return hashes;
}

}  // namespace

TEST_CASE("frame_upscale: frames are smaller, the picture is not", "[unit][frame_loop]") {
    const Scene scene = ballScene(true);
    Workers workers(1, Schedule::serial);
    for (const char* preset : {"quality", "performance", "ultra", "bicubic", "edge"}) {
        CAPTURE(preset);
        FrameLoop loop(scene, settingsOf(preset), workers);
        for (const int frame : {0, 3}) {
            const FrameResult result = loop.render(frame);
            const int ratio_fx8 = findPreset(preset)->policy.ratio_fx8;
            CHECK((result.output.width == kWidth && result.output.height == kHeight));
            CHECK((result.linear.red.width == kWidth && result.linear.red.height == kHeight));
            CHECK(result.gbuffer->width() == renderedSize(kWidth, ratio_fx8));
            CHECK(result.gbuffer->height() == renderedSize(kHeight, ratio_fx8));
        }
        CHECK(loop.tileWork().size() == 3 * 2);
        CHECK_FALSE(loop.story(5, 5).has_value());
    }
}

TEST_CASE(
    "frame_upscale: bicubic and edge enlarge the picture that is anti-aliased at the smaller "
    "size",
    "[unit][frame_loop]") {
    const Scene scene = ballScene(true);
    Workers workers(1, Schedule::serial);
    Image<uint16_t> red(162, 90), green(162, 90), blue(162, 90);
    for (const char* preset : {"bicubic", "edge"}) {
        FrameSettings large = settingsOf(preset), small = settingsOf("still");
        large.width = 162;
        large.height = 90;
        small.width = 108;  // at 1.5 the same aspect
        small.height = 60;
        small.policy.mip_bias_fx8 = mipBias_fx8(large.policy);
        FrameLoop large_loop(scene, large, workers), small_loop(scene, small, workers);
        const EnlargeFilter filter = large.policy.upscaler == UpscaleMethod::edge
                                         ? EnlargeFilter::edge
                                         : EnlargeFilter::bicubic;
        for (int frame = 0; frame < 4; ++frame) {
            SpatialUpscaler().run(small_loop.render(frame).linear, filter,
                                  {red.view(), green.view(), blue.view()}, SimdTarget::scalar,
                                  workers);
            const FrameResult result = large_loop.render(frame);
            CHECK(hashPlane(result.linear.red) == hashPlane(std::as_const(red).view()));
            CHECK(hashPlane(result.linear.blue) == hashPlane(std::as_const(blue).view()));
        }
    }
}

TEST_CASE("frame_upscale: a still picture ends, as the mean of a whole sequence",
          "[unit][frame_loop]") {
    const Scene scene = ballScene(false);
    Workers workers(2);
    FrameSettings settings = settingsOf("performance");
    FrameSettings reference = settings;
    reference.anti_aliasing = AntiAliasing::ssaa;
    reference.ssaa_samples = 256;
    FrameLoop loop(scene, settings, workers), truth(scene, reference, workers);
    for (int frame = 0; frame < 256; ++frame) {
        CHECK_FALSE(loop.render(frame).converged);
    }
    const FrameResult done = loop.render(256);
    CHECK(done.converged);
    CHECK(loop.counters().tiles == 0);
    CHECK(psnrDb(pixelError(done.output, truth.render(0).output)) > 50);
    // The same in one frame of many samples.
    settings.subframes = 256;
    FrameLoop at_once(scene, settings, workers);
    CHECK(hashPlane(at_once.render(0).output) == hashPlane(done.output));
}

TEST_CASE("frame_upscale: the ratio may change without a cut, and frames are replayed with theirs",
          "[unit][frame_loop]") {
    const Scene scene = ballScene(true);
    Workers workers(1, Schedule::serial), threads(3);
    FrameLoop loop(scene, settingsOf("quality"), workers);
    const auto begun = hashesOf(loop, {0, 1, 2, 3, 4, 5});
    loop.setRatio(600);
    CHECK(loop.render(6).gbuffer->width() == renderedSize(kWidth, 600));
    loop.setRatio(kNativeRatio_fx8);
    CHECK(loop.render(7).gbuffer->width() == kWidth);
    const auto after = hashesOf(loop, {8, 9});
    // History goes on: the picture is not that of a loop that begins here.
    CHECK(int(loop.render(10).sample_count.at(80, 45)) > 2);
    // Any order, any threads.
    CHECK(hashesOf(loop, {9}) == std::vector{after[1]});
    CHECK(hashesOf(loop, {0, 1, 2, 3, 4, 5}) == begun);
    CHECK(hashesOf(loop, {8, 9}) == after);
    FrameSettings settings = settingsOf("quality");
    settings.simd = SimdTarget::scalar;
    FrameLoop other(scene, settings, threads);
    CHECK(hashesOf(other, {5}) == std::vector{begun[5]});
    other.setRatio(600);
    other.render(6);
    other.setRatio(kNativeRatio_fx8);
    other.render(7);
    CHECK(hashesOf(other, {9}) == std::vector{after[1]});
    // What was planned for later frames goes when an earlier one gets a ratio of its own.
    other.setRatio(512);
    CHECK(other.render(4).gbuffer->width() == renderedSize(kWidth, 512));
    CHECK(other.render(9).gbuffer->width() == renderedSize(kWidth, 512));
    CHECK(other.render(3).gbuffer->width() == renderedSize(kWidth, 384));
}
