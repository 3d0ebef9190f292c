// Transforms, cameras and lights that are no numbers, or far too large ones: found by tests/fuzz.

#include <catch2/catch.hpp>
#include <limits>

#include "rasterizer/light_sampler.h"
#include "tests/support/busy_scene.h"
#include "tests/support/plane_compare.h"
#include "tests/support/test_scene.h"

using namespace still;
using namespace still::test;

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// Every SIMD target draws what the scalar kernels do.
void checkTargets(const DrawList& list, const FrameView& view) {
    GBuffer expected, got;
    draw(list, view, expected, {.simd = SimdTarget::scalar, .planes = kAllPlanes});
    for (const SimdTarget target : availableSimdTargets()) {
        draw(list, view, got, {.simd = target, .planes = kAllPlanes});
        INFO(name(target));
        CHECK(firstDifference(expected, got).empty());
    }
}

/// A floor under a lamp, drawn and lit with all that is sampled.
LightImages lit(TestScene& scene, const FrameView& view, SimdTarget target) {
    const DrawList list = scene.list();
    GBuffer gbuffer;
    draw(list, view, gbuffer, {.simd = target, .planes = kAllPlanes});
    Workers workers(1);
    LightSampler sampler;
    LightImages light;
    sampler.setUp(list, view, target, workers);
    sampler.sample(gbuffer, light, true, workers);
    return light;
}

}  // namespace

TEST_CASE("nowhere: an instance whose transform is no number is not drawn", "[unit][rasterizer]") {
    const FrameView view = busyView(3);
    for (const float wrong : {kInfinity, -kInfinity, kNaN}) {
        TestScene scene = busyScene(3);
        const DrawList list = scene.list();
        REQUIRE(!scene.instances.empty());
        const uint16_t first = scene.instances[0].first_surface;
        const size_t surfaces = scene.meshes[scene.instances[0].mesh].parts.size();
        for (const size_t at : {size_t{0}, size_t{7}}) {
            scene.instances[0].transform = kIdentity;
            scene.instances[0].transform[at] = wrong;
            scene.instances[0].identity = false;
            scene.instances[0].moved = true;
            checkTargets(list, view);
            GBuffer gbuffer;
            draw(list, view, gbuffer);
            for (int y = 0; y < view.height; ++y) {
                for (int x = 0; x < view.width; ++x) {
                    const int surface = gbuffer.id.at(x, y) & kSurfaceMask;
                    REQUIRE((surface < first || surface >= first + int(surfaces)));
                }
            }
        }
    }
}

TEST_CASE("nowhere: transforms before, cameras and eyes may be anything", "[unit][rasterizer]") {
    for (const double wrong : {1e30, 1e300, double(kInfinity), double(kNaN)}) {
        TestScene scene = busyScene(4);
        const DrawList list = scene.list();
        const FrameView view = busyView(4);
        scene.instances[0].transform_before[3] = float(wrong);
        scene.instances[0].moved = true;
        checkTargets(list, view);
        FrameView other = view;
        other.view_projection_before[0][0] = wrong;
        checkTargets(list, other);
        other.view_projection[1][1] = wrong;
        checkTargets(list, other);
        other = view;
        other.eye.z = float(wrong);
        checkTargets(list, other);
    }
}

TEST_CASE("nowhere: light of scenes with things that rays cannot reach", "[unit][rasterizer]") {
    const FrameView view{.width = 24, .height = 16};
    for (const float wrong : {1e30f, 3e38f, kInfinity, kNaN}) {
        TestScene scene;
        scene.addMesh();
        scene.addQuad({atPixel(view, 0, 0, 0.5), atPixel(view, 24, 0, 0.5),
                       atPixel(view, 24, 16, 0.5), atPixel(view, 0, 16, 0.5)});
        scene.lighting.sampled.ambient = AmbientLight::bounce;
        scene.lighting.sampled.sun_shadow = SunShadow::traced;
        scene.lighting.sun = {{0, 0, -1}, {1, 1, 1}};
        const LightImages alone = lit(scene, view, SimdTarget::scalar);
        scene.addMesh().transform = {wrong, 0, 0, 0, 0, wrong, 0, 0, 0, 0, 1, wrong};
        scene.instances.back().identity = false;
        scene.addQuad({atPixel(view, 0, 0, 0.9), atPixel(view, 24, 0, 0.9),
                       atPixel(view, 24, 16, 0.9), atPixel(view, 0, 16, 0.9)});
        for (const SimdTarget target : availableSimdTargets()) {
            const LightImages light = lit(scene, view, target);
            for (int y = 0; y < view.height; ++y) {
                for (int x = 0; x < view.width; ++x) {
                    REQUIRE(light.direct_red.at(x, y) == alone.direct_red.at(x, y));
                    REQUIRE(light.indirect_red.at(x, y) == alone.indirect_red.at(x, y));
                }
            }
        }
    }
}
