// The cheap variants of sampled light, held against the traced ones.

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>

#include "engine/frame_loop.h"
#include "engine/hash.h"
#include "tests/support/box_on_floor.h"

using namespace still;

namespace {

constexpr int kWidth = 160, kHeight = 120;

/// A box half a metre over a floor, and a sun.
Scene boxInTheSun(SunShadow shadow, double angle_deg) {
    Scene scene = boxOnFloor(1000, 1001);
    scene.objects[1].tracks.translation.keys = {{0, {0, 1, 0}}};
    scene.objects[1].tracks.rotation_deg.keys = {{0, 30}};
    scene.camera.eye.keys = {{0, {0.8, 2.2, 3.2}}};
    scene.lights.ambient = {0, 0, 0};
    scene.lights.sun.direction = {0.6f, -0.8f, 0.0f};
    scene.lights.sun_shadow = shadow;
    scene.lights.sun_angle_deg = angle_deg;
    return scene;
}

Scene boxUnderSky(AmbientLight ambient) {
    Scene scene = boxOnFloor(1000, 1001);
    scene.objects[1].tracks.translation.keys = {{0, {0, 0.5, 0}}};
    scene.camera.eye.keys = {{0, {0.8, 1.6, 2.4}}};
    scene.lights.ambient = {1, 1, 1};
    scene.lights.sun.colour = {};
    scene.lights.ambient_light = ambient;
    scene.lights.occlusion_distance = 1;
    return scene;
}

Image<uint16_t> greenOf(const Scene& scene, int samples, SimdTarget simd = bestSimdTarget()) {
    Workers workers(2);
    FrameSettings settings;
    settings.width = kWidth;
    settings.height = kHeight;
    settings.anti_aliasing = AntiAliasing::ssaa;
    settings.ssaa_samples = samples;
    settings.simd = simd;
    FrameLoop loop(scene, settings, workers);
    const FrameResult frame = loop.render(0);
    Image<uint16_t> green(kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            green.at(x, y) = frame.linear.green.at(x, y);
        }
    }
    return green;
}

struct Difference {
    double mean = 0;   ///< of the magnitudes, 1 = a picture of white against black
    double share = 0;  ///< of pixels that differ by more than a tenth
};
Difference difference(const Image<uint16_t>& a, const Image<uint16_t>& b) {
    Difference d;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const double off = std::abs(int(a.at(x, y)) - int(b.at(x, y))) / 4096.0;
            d.mean += off / (kWidth * kHeight);
            d.share += (off > 0.1 ? 1.0 : 0.0) / (kWidth * kHeight);
        }
    }
    return d;
}

}  // namespace

TEST_CASE("light variants: a shadow map's shadows are those of rays, sharp and soft",
          "[unit][light_variants]") {
    const double angle_deg = GENERATE(0.0, 2.0, 20.0);
    const Scene bright = boxInTheSun(SunShadow::none, angle_deg);
    const Image<uint16_t> traced = greenOf(boxInTheSun(SunShadow::traced, angle_deg), 64);
    const Image<uint16_t> mapped = greenOf(boxInTheSun(SunShadow::mapped, angle_deg), 64);
    const Difference d = difference(traced, mapped);
    CAPTURE(angle_deg, d.mean, d.share);
    CHECK(d.mean < 0.006);
    CHECK(d.share < 0.02);
    CHECK(difference(traced, greenOf(bright, 16)).share > 0.03);  // there is a shadow
}

TEST_CASE("light variants: a shadow map follows what moves, and the sun",
          "[unit][light_variants]") {
    Scene scene = boxInTheSun(SunShadow::mapped, 1);
    scene.objects[1].tracks.translation.keys = {{0, {0, 1, 0}}, {3, {1, 1.5, 0}}};
    Workers workers(2);
    FrameSettings settings;
    settings.width = kWidth;
    settings.height = kHeight;
    FrameLoop loop(scene, settings, workers);
    for (int frame : {0, 3, 1}) {
        FrameLoop alone(scene, settings, workers);
        CAPTURE(frame);
        CHECK(hashPlane(loop.render(frame).output) == hashPlane(alone.render(frame).output));
    }
}

TEST_CASE("light variants: occlusion on the screen is much like that of rays",
          "[unit][light_variants]") {
    const Image<uint16_t> open = greenOf(boxUnderSky(AmbientLight::plain), 16);
    const Image<uint16_t> traced = greenOf(boxUnderSky(AmbientLight::traced_occlusion), 64);
    const Image<uint16_t> screen = greenOf(boxUnderSky(AmbientLight::screen_occlusion), 64);
    const Difference plain = difference(traced, open), d = difference(traced, screen);
    CAPTURE(plain.mean, d.mean);
    CHECK(d.mean < 0.6 * plain.mean);
    REQUIRE(plain.mean > 0.01);
}

TEST_CASE("light variants: all SIMD targets give the same bytes", "[determinism][light_variants]") {
    Scene scene = boxInTheSun(SunShadow::mapped, 3);
    scene.lights.ambient = {0.5f, 0.5f, 0.5f};
    scene.lights.ambient_light = AmbientLight::screen_occlusion;
    const Image<uint16_t> truth = greenOf(scene, 2, SimdTarget::scalar);
    const uint64_t expected = hashPlane(truth.view());
    for (SimdTarget simd : availableSimdTargets()) {
        const Image<uint16_t> green = greenOf(scene, 2, simd);
        CAPTURE(name(simd));
        CHECK(hashPlane(green.view()) == expected);
    }
}
