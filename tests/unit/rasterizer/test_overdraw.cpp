// How many triangles hold each sample.

#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/support/busy_scene.h"
#include "tests/support/oracle_rasterizer.h"
#include "tests/support/random_triangles.h"

using namespace still;
using namespace still::test;

namespace {

/// Every triangle against every pixel.
int countAt(const oracle::Frame& frame, int x, int y) {
    int count = 0;
    for (const oracle::Triangle& triangle : frame.triangles()) {
        count += !triangle.polygon.empty() && frame.covers(triangle, x, y) ? 1 : 0;
    }
    return count;
}

Image<uint16_t> overdrawOf(TestScene& scene, const FrameView& view,
                           SimdTarget simd = bestSimdTarget()) {
    Workers workers(1, Schedule::serial);
    Rasterizer rasterizer;
    const DrawList list = scene.list();
    rasterizer.transformAndBin(list, view, {.simd = simd, .planes = {}}, workers);
    GBuffer gbuffer;
    rasterizer.rasterize(gbuffer, workers);
    Image<uint16_t> out(view.width, view.height);
    rasterizer.overdraw(out.view(), workers);
    return out;
}

}  // namespace

TEST_CASE("overdraw: counts the triangles that the oracle finds at each sample", "[overdraw]") {
    int covered = 0, most = 0;
    for (const FlatKind kind : kFlatKinds) {
        Random random(500 + uint64_t(kind));
        for (int round = 0; round < 6; ++round) {
            const FrameView view = flatView(random.integer(1, 150), random.integer(1, 90), random);
            TestScene scene;
            for (int k = 0; k < (kind == FlatKind::sub_pixel ? 200 : 12); ++k) {
                addFlat(scene, view, kind, random);
            }
            const DrawList list = scene.list();
            const oracle::Frame frame(list, view);
            const Image<uint16_t> counts = overdrawOf(scene, view);
            for (int y = 0; y < view.height; ++y) {
                for (int x = 0; x < view.width; ++x) {
                    const int wanted = countAt(frame, x, y);
                    INFO("kind " << int(kind) << " round " << round << " pixel " << x << ", " << y);
                    // Edges made by clipping are snapped to 1/256 pixel.
                    if (std::any_of(frame.triangles().begin(), frame.triangles().end(),
                                    [&](const oracle::Triangle& t) {
                                        return t.clipped &&
                                               frame.nearCreatedEdge(t, x, y, 1.0 / 128);
                                    })) {
                        continue;
                    }
                    REQUIRE(int(counts.at(x, y)) == wanted);
                    covered += wanted > 0 ? 1 : 0;
                    most = std::max(most, wanted);
                }
            }
        }
    }
    CHECK(covered > 1000);
    CHECK(most >= 8);
}

TEST_CASE("overdraw: every SIMD target counts the same, and a surface has at least one",
          "[overdraw]") {
    for (uint64_t seed = 1; seed <= 4; ++seed) {
        TestScene scene = busyScene(seed);
        const FrameView view = busyView(seed);
        const Image<uint16_t> wanted = overdrawOf(scene, view, SimdTarget::scalar);
        GBuffer gbuffer;
        draw(scene.list(), view, gbuffer);
        for (const SimdTarget target : availableSimdTargets()) {
            const Image<uint16_t> counts = overdrawOf(scene, view, target);
            for (int y = 0; y < view.height; ++y) {
                for (int x = 0; x < view.width; ++x) {
                    INFO(name(target) << " seed " << seed << " pixel " << x << ", " << y);
                    REQUIRE(counts.at(x, y) == wanted.at(x, y));
                    const bool surface = (gbuffer.id.at(x, y) & kSurfaceMask) != 0;
                    REQUIRE((!surface || counts.at(x, y) > 0));
                }
            }
        }
    }
}
