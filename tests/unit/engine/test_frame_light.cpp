// Sampled light in frames: traced, denoised, remodulated, and what it costs where there is none.

#include <catch2/catch.hpp>
#include <cmath>

#include "engine/frame_loop.h"
#include "engine/hash.h"
#include "tests/support/box_on_floor.h"

using namespace still;

namespace {

constexpr int kWidth = 97, kHeight = 70;

FrameSettings settingsOf(AntiAliasing anti_aliasing) {
    FrameSettings settings;
    settings.width = kWidth;
    settings.height = kHeight;
    settings.anti_aliasing = anti_aliasing;
    return settings;
}

/// The box moves in frames 2 … 5 under a ball of light, which goes out in frame 7.
Scene lampScene() {
    Scene scene = boxOnFloor(2, 5);
    scene.lights.sun.colour = {};
    scene.lights.spheres = {{.position = {{{0, {0.5, 3, 1}}}},
                             .radius = 0.4,
                             .colour = {6, 5, 4},
                             .intensity = {{{6, 1}, {7, 0}}}}};
    return scene;
}

/// The same at rest.
Scene stillScene() {
    Scene scene = lampScene();
    scene.objects[1].tracks = {};
    scene.lights.spheres[0].intensity = {};
    return scene;
}

uint64_t hashOf(const FrameResult& frame) {
    return hashPlane(frame.output);
}

uint64_t frameAlone(const Scene& scene, const FrameSettings& settings, int frame) {
    Workers workers(1, Schedule::serial);
    FrameLoop loop(scene, settings, workers);
    return hashOf(loop.render(frame));
}

/// The mean of the result's red, linear.
double meanRed(const FrameResult& frame) {
    double sum = 0;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            sum += frame.linear.red.at(x, y);
        }
    }
    return sum / (kWidth * kHeight * 4096.0);
}

}  // namespace

TEST_CASE("frame_light: a frame is the same whichever were rendered before it",
          "[unit][frame_light]") {
    const AntiAliasing mode =
        GENERATE(AntiAliasing::none, AntiAliasing::fxaa, AntiAliasing::taa, AntiAliasing::ssaa);
    const Denoise denoise = GENERATE(Denoise::off, Denoise::svgf);
    const Scene scene = lampScene();
    FrameSettings settings = settingsOf(mode);
    settings.denoise = denoise;
    settings.ssaa_samples = 2;
    Workers workers(2);
    FrameLoop loop(scene, settings, workers);
    for (int frame : {0, 1, 2, 3, 8, 4, 4}) {
        CAPTURE(int(mode), int(denoise), frame);
        CHECK(hashOf(loop.render(frame)) == frameAlone(scene, settings, frame));
    }
}

TEST_CASE("frame_light: without the denoiser a sample of light goes into the colours as it is",
          "[unit][frame_light]") {
    const Scene scene = lampScene();
    FrameSettings settings = settingsOf(AntiAliasing::none);
    settings.denoise = Denoise::off;
    Workers workers(1, Schedule::serial);
    FrameLoop loop(scene, settings, workers);
    const FrameResult frame = loop.render(0);
    Scene dark = scene;
    dark.lights.spheres[0].colour = {};
    FrameLoop dark_loop(dark, settings, workers);
    const FrameResult rest = dark_loop.render(0);
    REQUIRE(frame.denoised.direct.red.empty());
    int wrong = 0, lit = 0;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const int light = frame.light.direct.red.at(x, y) + frame.light.indirect.red.at(x, y);
            const int added = (light * frame.gbuffer->albedo_red.at(x, y) + 2048) / 4096;
            const int expected = rest.linear.red.at(x, y) + added;
            wrong += std::abs(int(frame.linear.red.at(x, y)) - expected) > 1;
            lit += light > 0;
        }
    }
    CHECK(wrong == 0);
    CHECK(lit > 500);
}

TEST_CASE("frame_light: the denoiser keeps the light that there is", "[unit][frame_light]") {
    const Scene scene = lampScene();
    Workers workers(2);
    FrameSettings settings = settingsOf(AntiAliasing::ssaa);
    settings.ssaa_samples = 256;
    FrameLoop reference(scene, settings, workers);
    const double expected = meanRed(reference.render(0));
    FrameLoop loop(scene, settingsOf(AntiAliasing::taa), workers);
    CHECK(meanRed(loop.render(1)) == Approx(expected).epsilon(0.05));
    REQUIRE(expected > 0.05);
}

TEST_CASE("frame_light: light that goes out leaves the picture", "[unit][frame_light]") {
    const Scene scene = lampScene();
    Scene dark = scene;
    dark.lights.spheres[0].intensity.keys = {{0, 0}};
    Workers workers(2);
    FrameLoop loop(scene, settingsOf(AntiAliasing::taa), workers);
    FrameLoop dark_loop(dark, settingsOf(AntiAliasing::taa), workers);
    const double lit = meanRed(loop.render(6));
    const double unlit = meanRed(dark_loop.render(9));
    REQUIRE(lit > 1.5 * unlit);
    CHECK(meanRed(loop.render(9)) - unlit < 0.02 * (lit - unlit));
}

TEST_CASE("frame_light: a finished picture rests, whether its samples are asked for or not",
          "[unit][frame_light]") {
    const Scene scene = stillScene();
    FrameSettings settings = settingsOf(AntiAliasing::taa);
    constexpr int kFinished = 190;
    const uint64_t finished = frameAlone(scene, settings, kFinished);
    settings.fresh_gbuffer = GENERATE(false, true);
    int stages = 0;
    settings.clock_ms = [&stages] { return double(++stages); };
    Workers workers(2);
    FrameLoop loop(scene, settings, workers);
    CHECK(hashOf(loop.render(kFinished)) == finished);
    stages = 0;
    CHECK(hashOf(loop.render(kFinished + 1)) == finished);
    CHECK(stages == 0);
}

TEST_CASE("frame_light: sub-frames make the picture that as many frames make",
          "[unit][frame_light]") {
    const Scene scene = stillScene();
    FrameSettings settings = settingsOf(AntiAliasing::taa);
    for (int samples : {4, 16, 80}) {
        settings.subframes = 1;
        const uint64_t frames = frameAlone(scene, settings, samples - 1);
        settings.subframes = samples;
        CAPTURE(samples);
        CHECK(frameAlone(scene, settings, 0) == frames);
    }
}

TEST_CASE("frame_light: scenes without sampled light have none of its planes and times",
          "[unit][frame_light]") {
    const Scene scene = boxOnFloor(1, 3);
    FrameSettings settings = settingsOf(AntiAliasing::taa);
    double now_ms = 0;
    settings.clock_ms = [&now_ms] { return now_ms += 1; };
    Workers workers(1, Schedule::serial);
    FrameLoop loop(scene, settings, workers);
    const FrameResult frame = loop.render(2);
    CHECK(frame.light.direct.red.empty());
    CHECK(frame.denoised.direct.red.empty());
    CHECK_FALSE(frame.gbuffer->planes.albedo);
    CHECK(frame.times.light_ms == 0);
    CHECK(frame.times.denoise_ms == 0);
}
