// Which triangle is seen at which pixel, against the oracle.

#include <catch2/catch.hpp>

#include "tests/support/oracle_rasterizer.h"
#include "tests/support/random_triangles.h"

using namespace still;
using namespace still::test;

namespace {

/// Corners made by clipping are snapped too, so an edge between them may lie this far off.
constexpr double kClippedEdgePx = 1.0 / 128;
/// Depth bound: two float roundings per vertex and those of the plane.
constexpr double kDepthBound = 1e-6;

struct Comparison {
    int pixels = 0, covered = 0, near_clipped_edges = 0, depth_ties = 0;
    std::string first_error;
};

bool clippedHere(const oracle::Frame& frame, int triangle, int x, int y) {
    return triangle >= 0 && frame.triangles()[size_t(triangle)].clipped &&
           frame.nearCreatedEdge(frame.triangles()[size_t(triangle)], x, y, kClippedEdgePx);
}

/// Every triangle is a surface of its own, numbered from 1.
void comparePixel(const oracle::Frame& frame, const GBuffer& fast, int x, int y, Comparison& c) {
    const oracle::Pixel truth = frame.visible(x, y);
    const int seen = int(fast.id.at(x, y) & kSurfaceMask) - 1;
    ++c.pixels;
    c.covered += seen >= 0 ? 1 : 0;
    if (seen == truth.triangle) {
        return;
    }
    if (clippedHere(frame, truth.triangle, x, y) || clippedHere(frame, seen, x, y)) {
        ++c.near_clipped_edges;
        return;
    }
    if (seen >= 0 && frame.covers(frame.triangles()[size_t(seen)], x, y) &&
        truth.depth - frame.depthAt(frame.triangles()[size_t(seen)], x, y) < kDepthBound) {
        ++c.depth_ties;
        return;
    }
    if (c.first_error.empty()) {
        c.first_error = "pixel (" + std::to_string(x) + ", " + std::to_string(y) + "): oracle " +
                        std::to_string(truth.triangle) + ", fast " + std::to_string(seen);
    }
}

void compare(TestScene& scene, const FrameView& view, Comparison& c) {
    const DrawList list = scene.list();
    const oracle::Frame frame(list, view);
    GBuffer fast;
    draw(list, view, fast);
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) {
            comparePixel(frame, fast, x, y, c);
        }
    }
}

}  // namespace

TEST_CASE("coverage: triangles in the plane agree with the oracle at every sample", "[coverage]") {
    const FlatKind kind = GENERATE(from_range(kFlatKinds));
    Random random(100 + uint64_t(kind));
    Comparison c;
    for (int round = 0; round < 40 && c.first_error.empty(); ++round) {
        const FrameView view = flatView(random.integer(1, 150), random.integer(1, 90), random);
        TestScene scene;
        const int count = kind == FlatKind::sub_pixel ? 300 : 12;
        for (int k = 0; k < count; ++k) {
            addFlat(scene, view, kind, random);
        }
        compare(scene, view, c);
    }
    CAPTURE(int(kind), c.pixels, c.near_clipped_edges, c.depth_ties);
    CHECK(c.first_error == "");
    CHECK(c.covered > 0);
    CHECK(c.near_clipped_edges < c.pixels / 500);
    CHECK(c.depth_ties < 20);
}

TEST_CASE("coverage: triangles in perspective agree with the oracle", "[coverage]") {
    const DeepKind kind = GENERATE(from_range(kDeepKinds));
    Random random(200 + uint64_t(kind));
    Comparison c;
    for (int round = 0; round < 60 && c.first_error.empty(); ++round) {
        const FrameView view = deepView(random.integer(1, 150), random.integer(1, 90), random);
        TestScene scene;
        for (int k = 0; k < 12; ++k) {
            addDeep(scene, kind, random);
        }
        compare(scene, view, c);
    }
    CAPTURE(int(kind), c.pixels, c.near_clipped_edges, c.depth_ties);
    CHECK(c.first_error == "");
    CHECK((c.covered > 0) == (kind != DeepKind::behind));
    CHECK(c.near_clipped_edges < c.pixels / 200);
    CHECK(c.depth_ties < 20);
}

TEST_CASE("coverage: all kinds mixed in one picture agree with the oracle", "[coverage]") {
    Random random(300);
    Comparison c;
    for (int round = 0; round < 20 && c.first_error.empty(); ++round) {
        const FrameView view = flatView(200, 130, random);
        TestScene scene;
        for (int k = 0; k < 60; ++k) {
            addFlat(scene, view, kFlatKinds[size_t(k) % kFlatKinds.size()], random);
        }
        compare(scene, view, c);
    }
    CAPTURE(c.pixels, c.near_clipped_edges, c.depth_ties);
    CHECK(c.first_error == "");
}

TEST_CASE("coverage: instances with their own transforms agree with the oracle", "[coverage]") {
    Random random(400);
    Comparison c;
    for (int round = 0; round < 20 && c.first_error.empty(); ++round) {
        const FrameView view = deepView(97, 66, random);
        TestScene scene;
        for (int object = 0; object < 4; ++object) {
            scene.addMesh().transform =
                toAffine(rigid(random.real(0, 1), random.real(-1, 1), 0, random.real(-9, -3)));
            for (int k = 0; k < 4; ++k) {
                addDeep(scene, DeepKind::near, random);
            }
        }
        compare(scene, view, c);
    }
    CHECK(c.first_error == "");
    CHECK(c.covered > 0);
}
