// Which triangle wins, whatever its size and whichever path its size chooses.

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/plane_compare.h"
#include "tests/support/random_triangles.h"

using namespace still;
using namespace still::test;

namespace {

FrameView squareView(int size) {
    FrameView view;
    view.width = view.height = size;
    return view;
}

/// Two opaque materials and one of each kind that tests its samples.
void addMaterials(TestScene& scene) {
    scene.materials.assign(4, Material{});
    scene.materials[1].diffuse = {0.1f, 0.2f, 0.9f};
    scene.materials[2].alpha_mode = AlphaMode::test;
    scene.materials[3].alpha_mode = AlphaMode::stochastic;
    scene.materials[3].opacity = 0.6f;
}

/// Parts of many triangles each, so that those of a part are set up together.
void addTriangles(TestScene& scene, const FrameView& view, double size_px, Random& random) {
    for (uint32_t part = 0; part < 8; ++part) {
        for (int i = 0; i < 40; ++i) {
            const double x = random.real(0, view.width), y = random.real(0, view.height);
            const auto corner = [&] {
                TestVertex v = atPixel(view, x + random.real(-size_px, size_px),
                                       y + random.real(-size_px, size_px), random.real(0.2, 0.8));
                v.attributes = {float(random.real(-0.3, 0.3)), 0, 1, 0, 0};
                return v;
            };
            scene.addTriangle(corner(), corner(), corner(), part % 4);
            std::vector<MeshPart>& parts = scene.meshes.back().parts;
            if (i > 0) {
                parts.pop_back();
                ++parts.back().triangle_count;
            }
        }
    }
}

}  // namespace

TEST_CASE("visibility: triangles of any size look the same with every SIMD target", "[depth]") {
    const double size_px = GENERATE(0.4, 1.0, 2.0, 3.0, 5.0, 9.0, 14.0, 24.0, 40.0, 90.0);
    Random random(uint64_t(size_px * 10));
    for (int round = 0; round < 4; ++round) {
        FrameView view = squareView(random.integer(60, 140));
        view.jitter_x_fx8 = random.integer(-128, 127);
        view.jitter_y_fx8 = random.integer(-128, 127);
        TestScene scene;
        scene.addMesh();
        addMaterials(scene);
        addTriangles(scene, view, size_px, random);
        const DrawList list = scene.list();
        GBuffer expected;
        draw(list, view, expected, {.simd = SimdTarget::scalar, .planes = kAllPlanes});
        for (SimdTarget target : availableSimdTargets()) {
            for (Shading shading : {Shading::deferred, Shading::forward}) {
                GBuffer out;
                draw(list, view, out, {.simd = target, .shading = shading, .planes = kAllPlanes});
                CAPTURE(size_px, round, name(target), int(shading));
                CHECK(firstDifference(expected, out) == "");
            }
        }
    }
}

TEST_CASE("visibility: at equal depth the first one submitted is seen, alpha-tested or not",
          "[depth]") {
    const FrameView view = squareView(70);
    for (uint32_t first = 0; first < 3; ++first) {
        for (uint32_t second = 0; second < 3; ++second) {
            for (double size_px : {3.0, 12.0, 70.0}) {
                TestScene scene;
                scene.addMesh();
                addMaterials(scene);
                for (uint32_t material : {first, second}) {
                    scene.addTriangle(atPixel(view, 0, 0, 0.5), atPixel(view, size_px, 0, 0.5),
                                      atPixel(view, 0, size_px, 0.5), material);
                }
                for (SimdTarget target : availableSimdTargets()) {
                    GBuffer out;
                    draw(scene.list(), view, out, {.simd = target, .planes = kAllPlanes});
                    CAPTURE(first, second, size_px, name(target));
                    CHECK(out.id.at(0, 0) == 1);
                    CHECK(out.id.at(int(size_px) / 4, int(size_px) / 4) == 1);
                }
            }
        }
    }
}

TEST_CASE("visibility: a triangle that is seen only beyond the picture is not shaded", "[depth]") {
    // 1 … 63 pixels in the last tile; the left triangle covers them, the right one what is beyond.
    for (int width : {65, 71, 72, 73, 90, 127}) {
        FrameView view = squareView(64);
        view.width = width;
        TestScene scene;
        scene.addMesh();
        const double edge = width;
        scene.addTriangle(atPixel(view, 0, 0, 0.5), atPixel(view, edge + 40, 0, 0.5),
                          atPixel(view, 0, 200, 0.5));
        scene.addTriangle(atPixel(view, edge - 0.3, -9, 0.7), atPixel(view, edge + 40, -9, 0.7),
                          atPixel(view, edge - 0.3, 90, 0.7));
        GBuffer expected;
        draw(scene.list(), view, expected, {.simd = SimdTarget::scalar, .planes = kAllPlanes});
        for (SimdTarget target : availableSimdTargets()) {
            GBuffer out;
            draw(scene.list(), view, out, {.simd = target, .planes = kAllPlanes});
            CAPTURE(width, name(target));
            CHECK(firstDifference(expected, out) == "");
            CHECK(out.id.at(width - 1, 10) == 1);
        }
    }
}
