// What the frame loop makes of FrameSettings::policy and of the spatial filter.

#include <catch2/catch.hpp>

#include "engine/frame_loop.h"
#include "engine/hash.h"
#include "engine/jitter.h"
#include "engine/shapes.h"
#include "postfx/sharpen.h"
#include "postfx/spatial.h"

using namespace still;

namespace {

constexpr int kWidth = 83, kHeight = 61;

/// A turning ring over a floor, seen by a gliding camera.
Scene ringScene() {
    Scene scene;
    scene.meshes = {shapes::plane(4, 4, 4, 4, 1), shapes::torus(0.35f, 24, 10)};
    scene.mesh_names = {"floor", "ring"};
    scene.materials.resize(2);
    scene.materials[1].diffuse = {0.9f, 0.2f, 0.1f};
    scene.meshes[1].parts[0].material = 1;
    scene.objects.resize(2);
    scene.objects[1].mesh = 1;
    scene.objects[1].tracks.translation.keys = {{0, {0, 1, 0}}};
    scene.objects[1].tracks.rotation_axis = {1, 0, 0};
    scene.objects[1].tracks.rotation_deg.keys = {{0, 0}, {30, 360}};
    scene.camera.eye.keys = {{0, {1, 2, 5}}, {30, {2, 3, 6}}};
    scene.camera.target.keys = {{0, {0, 0.5, 0}}};
    scene.lights.sun = {{0.0f, -0.6f, -0.8f}, {0.7f, 0.7f, 0.7f}};
    scene.background = {0.1f, 0.2f, 0.4f};
    return scene;
}

FrameSettings settingsOf(const TaaPolicy& policy) {
    FrameSettings settings;
    settings.width = kWidth;
    settings.height = kHeight;
    settings.policy = policy;
    return settings;
}

uint64_t lastHash(const Scene& scene, const FrameSettings& settings, const std::vector<int>& order,
                  Workers& workers) {
    FrameLoop loop(scene, settings, workers);
    uint64_t hash = 0;
    for (const int frame : order) {
        hash = hashPlane(loop.render(frame).output);
    }
    return hash;
}

uint64_t lastHash(const Scene& scene, const FrameSettings& settings,
                  const std::vector<int>& order) {
    Workers workers(1, Schedule::serial);
    return lastHash(scene, settings, order, workers);
}

}  // namespace

TEST_CASE("frame_loop: a policy's bytes depend neither on order, threads nor SIMD",
          "[unit][frame_loop]") {
    const Scene scene = ringScene();
    for (const TaaPreset& preset : taaPresets()) {
        CAPTURE(preset.name);
        FrameSettings settings = settingsOf(preset.policy);
        const uint64_t expected = lastHash(scene, settings, {0, 1, 2, 3});
        CHECK(lastHash(scene, settings, {3}) == expected);
        CHECK(lastHash(scene, settings, {4, 1, 3}) == expected);
        Workers threads(3), shuffled(1, Schedule::shuffled, 5);
        CHECK(lastHash(scene, settings, {3}, threads) == expected);
        CHECK(lastHash(scene, settings, {3}, shuffled) == expected);
        settings.simd = SimdTarget::scalar;
        CHECK(lastHash(scene, settings, {3}) == expected);
    }
}

TEST_CASE("frame_loop: pattern, scale and scrambling of samples show", "[unit][frame_loop]") {
    const Scene scene = ringScene();
    TaaPolicy policy;
    policy.jitter = JitterPattern::halton8;
    const auto after = [&](int frame) { return lastHash(scene, settingsOf(policy), {frame}); };
    const uint64_t plain = after(9);
    policy.jitter_scale_fx8 = 128;
    CHECK(after(9) != plain);
    policy.jitter_scale_fx8 = 256;
    const uint64_t first_cycle = after(7);
    policy.scramble = true;
    CHECK(after(7) == first_cycle);
    CHECK(after(9) != plain);
}

TEST_CASE("frame_loop: planes are made for policies that read them", "[unit][frame_loop]") {
    const Scene scene = ringScene();
    Workers workers(1, Schedule::serial);
    for (const auto& [name, normal] : {std::pair{"still", true},
                                       {"basic", false},
                                       {"filament", false},
                                       {"ema-consistent", true}}) {
        FrameSettings settings = settingsOf(findPreset(name)->policy);
        FrameLoop loop(scene, settings, workers);
        const PlaneSet planes = loop.render(0).gbuffer->planes;
        CAPTURE(name);
        CHECK(planes == PlaneSet{.normal = normal, .motion = true});
        settings.planes.normal = true;
        FrameLoop asked(scene, settings, workers);
        CHECK(asked.render(0).gbuffer->planes == PlaneSet{.normal = true, .motion = true});
    }
}

TEST_CASE("frame_loop: a policy may see the motion of the camera alone", "[unit][frame_loop]") {
    const Scene scene = ringScene();
    Workers workers(1, Schedule::serial);
    TaaPolicy policy = findPreset("basic")->policy;
    FrameLoop surfaces(scene, settingsOf(policy), workers);
    const GBuffer& full = *surfaces.render(1).gbuffer;
    policy.motion = MotionSource::camera;
    FrameLoop camera(scene, settingsOf(policy), workers);
    const GBuffer& alone = *camera.render(1).gbuffer;
    int ring = 0, wrong = 0;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const bool moved = (full.id.at(x, y) & kMovedBit) != 0;
            ring += moved && !(full.motion.at(x, y) == alone.motion.at(x, y)) ? 1 : 0;
            wrong += !moved && !(full.motion.at(x, y) == alone.motion.at(x, y)) ? 1 : 0;
            wrong += full.id.at(x, y) == alone.id.at(x, y) ? 0 : 1;
        }
    }
    CHECK(ring > 50);
    CHECK(wrong == 0);
}

TEST_CASE("frame_loop: confidence exists with every policy, and only there", "[unit][frame_loop]") {
    const Scene scene = ringScene();
    Workers workers(1, Schedule::serial);
    for (const TaaPreset& preset : taaPresets()) {
        FrameLoop loop(scene, settingsOf(preset.policy), workers);
        const FrameResult first = loop.render(0);
        CAPTURE(preset.name);
        const TaaPolicy& policy = preset.policy;
        const int ratio_fx8 = upscalesInTime(policy) ? kNativeRatio_fx8 : policy.ratio_fx8;
        REQUIRE(first.confidence.width == renderedSize(kWidth, ratio_fx8));
        REQUIRE(first.confidence.height == renderedSize(kHeight, ratio_fx8));
        const int x = 40 * 256 / ratio_fx8, y = 50 * 256 / ratio_fx8;
        const int begun = first.confidence.at(x, y);
        const FrameResult later = loop.render(12);
        CHECK(later.confidence.at(x, y) >= begun + (policy.ratio_fx8 == kMaxRatio_fx8 ? 0 : 1));
        CHECK(later.confidence.at(x, y) <= later.confidence_full);
        CHECK(later.sample_count.empty() == (preset.policy.method == Method::recursive));
    }
    FrameSettings settings = settingsOf({});
    settings.anti_aliasing = AntiAliasing::fxaa;
    FrameLoop loop(scene, settings, workers);
    CHECK(loop.render(0).confidence.empty());
}

TEST_CASE("frame_loop: fxaa is the spatial filter of the sample in the centre",
          "[unit][frame_loop]") {
    const Scene scene = ringScene();
    Workers workers(1, Schedule::serial);
    FrameSettings settings = settingsOf({});
    settings.anti_aliasing = AntiAliasing::none;
    FrameLoop raw(scene, settings, workers);
    const GBuffer& gbuffer = *raw.render(2).gbuffer;
    Image<uint16_t> red(kWidth, kHeight), green(kWidth, kHeight), blue(kWidth, kHeight);
    SpatialFilter filter;
    filter.run(spatialInput(gbuffer, 0, 0), {.edges = SpatialEdges::colour},
               {red.view(), green.view(), blue.view()}, workers);
    settings.anti_aliasing = AntiAliasing::fxaa;
    FrameLoop loop(scene, settings, workers);
    const FrameResult result = loop.render(2);
    CHECK(hashPlane(result.linear.red) == hashPlane(std::as_const(red).view()));
    CHECK(hashPlane(result.linear.blue) == hashPlane(std::as_const(blue).view()));
    CHECK(hashPlane(result.linear.red) != hashPlane(std::as_const(gbuffer.red).view()));
    CHECK(result.gbuffer->planes == PlaneSet{});
}

TEST_CASE("frame_loop: sharpening follows the resolve and leaves history alone",
          "[unit][frame_loop]") {
    const Scene scene = ringScene();
    Workers workers(1, Schedule::serial);
    for (const char* name : {"still", "basic"}) {
        TaaPolicy policy = findPreset(name)->policy;
        FrameLoop plain(scene, settingsOf(policy), workers);
        policy.sharpness_q15 = 20000;
        FrameLoop sharp(scene, settingsOf(policy), workers);
        sharp.render(1);  // so that frame 3 builds on a history whose frames were sharpened
        const FrameResult before = plain.render(3), after = sharp.render(3);
        Image<uint8_t> confidence(kWidth, kHeight);
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                confidence.at(x, y) =
                    uint8_t(before.confidence.at(x, y) * 255 / before.confidence_full);
            }
        }
        Image<uint16_t> red(kWidth, kHeight), green(kWidth, kHeight), blue(kWidth, kHeight);
        sharpen(before.linear, std::as_const(confidence).view(), 20000,
                {red.view(), green.view(), blue.view()}, bestSimdTarget(), workers);
        CAPTURE(name);
        CHECK(hashPlane(after.linear.red) == hashPlane(std::as_const(red).view()));
        CHECK(hashPlane(after.linear.green) == hashPlane(std::as_const(green).view()));
        CHECK(hashPlane(after.linear.red) != hashPlane(before.linear.red));
    }
}

TEST_CASE("frame_loop: first_sample begins the sequence elsewhere", "[unit][frame_loop]") {
    const Scene scene = ringScene();
    Workers workers(1);
    FrameSettings settings = settingsOf(TaaPolicy{});
    settings.subframes = 3;
    FrameLoop from_zero(scene, settings, workers);
    const uint64_t third = hashPlane(from_zero.render(0).gbuffer->red.view());
    settings.subframes = 1;
    CHECK(hashPlane(FrameLoop(scene, settings, workers).render(0).gbuffer->red.view()) != third);
    settings.first_sample = 2;
    CHECK(hashPlane(FrameLoop(scene, settings, workers).render(0).gbuffer->red.view()) == third);
}
