// The albedo plane, and colours without the light that is sampled.

#include <catch2/catch.hpp>

#include "tests/support/busy_scene.h"
#include "tests/support/plane_compare.h"

using namespace still;
using namespace still::test;

namespace {

GBuffer drawn(TestScene& scene, const FrameView& view, const RasterSettings& settings) {
    GBuffer out;
    const DrawList list = scene.list();
    draw(list, view, out, settings);
    return out;
}

/// Diffuse surfaces only.
TestScene matt(uint64_t seed) {
    TestScene scene = busyScene(seed);
    for (Material& material : scene.materials) {
        material.specular = material.emission = {0, 0, 0};
    }
    return scene;
}

}  // namespace

TEST_CASE("albedo: under white ambient light alone it is the colour", "[determinism]") {
    for (uint64_t seed = 0; seed < 4; ++seed) {
        const FrameView view = busyView(seed);
        TestScene scene = matt(seed);
        scene.lighting = {.ambient = {1, 1, 1}, .sun = {}, .points = {}};
        for (SimdTarget target : availableSimdTargets()) {
            const GBuffer out = drawn(scene, view, {.simd = target, .planes = kAllPlanes});
            int wrong = 0, lit = 0;
            for (int y = 0; y < out.height(); ++y) {
                for (int x = 0; x < out.width(); ++x) {
                    const bool surface = (out.id.at(x, y) & kSurfaceMask) != 0;
                    const auto expected = [&](uint16_t colour) { return surface ? colour : 0; };
                    wrong += out.albedo_red.at(x, y) != expected(out.red.at(x, y)) ||
                             out.albedo_green.at(x, y) != expected(out.green.at(x, y)) ||
                             out.albedo_blue.at(x, y) != expected(out.blue.at(x, y));
                    lit += surface && out.albedo_red.at(x, y) > 0;
                }
            }
            CAPTURE(seed, name(target));
            CHECK(wrong == 0);
            CHECK(lit > 100);
        }
    }
}

TEST_CASE("light: what is sampled is left out of the colour, and nothing else") {
    const bool sun = GENERATE(false, true);
    const bool ambient = GENERATE(false, true);
    for (uint64_t seed = 0; seed < 4; ++seed) {
        const FrameView view = busyView(seed);
        TestScene sampled = busyScene(seed), without = busyScene(seed);
        if (sun) {
            sampled.lighting.sampled.sun_shadow = SunShadow::traced;
            without.lighting.sun.colour = {};
        }
        if (ambient) {
            sampled.lighting.sampled.ambient = AmbientLight::bounce;
            without.lighting.ambient = {};
        }
        sampled.lighting.sampled.spheres.push_back({{0, 0, -3}, 0.5f, {5, 5, 5}});
        const GBuffer a = drawn(sampled, view, {.planes = kAllPlanes});
        const GBuffer b = drawn(without, view, {.planes = kAllPlanes});
        CAPTURE(seed, sun, ambient);
        CHECK(firstDifference(a, b) == "");
    }
}
