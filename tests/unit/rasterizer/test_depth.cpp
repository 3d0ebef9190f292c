// Depth order and depth precision.

#include <bit>
#include <catch2/catch.hpp>
#include <cmath>

#include "rasterizer/fixed.h"
#include "tests/support/random_triangles.h"

using namespace still;
using namespace still::test;

namespace {

constexpr double kNear = 0.05;
constexpr double kFar = kNear * 1e5;

FrameView farView() {
    FrameView view;
    view.width = 160;
    view.height = 96;
    view.view_projection = perspective(1.5, 160.0 / 96, kNear, kFar);
    view.view_projection_before = view.view_projection;
    return view;
}

/// A plane through (0, 0, −distance) that fills the picture, tilted by `slope` in x and y.
void addWall(TestScene& scene, double distance, double slope) {
    const auto corner = [&](double x, double y) {
        const double d = distance * (1 + slope * (x + 0.5 * y));
        return TestVertex{float(x * 2 * d), float(y * 2 * d), float(-d)};
    };
    scene.addQuad({corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)});
}

int pixelsOf(const GBuffer& out, uint16_t surface) {
    int count = 0;
    for (int y = 0; y < out.height(); ++y) {
        for (int x = 0; x < out.width(); ++x) {
            count += out.id.at(x, y) == surface ? 1 : 0;
        }
    }
    return count;
}

}  // namespace

TEST_CASE("depth: planes 1/1000 apart do not fight from near to far", "[depth]") {
    const double slope = GENERATE(0.0, 0.2);
    const FrameView view = farView();
    for (double distance = kNear * 1.5; distance < kFar / 1.5; distance *= 1.7) {
        for (bool front_first : {false, true}) {
            TestScene scene;
            addWall(scene, front_first ? distance : distance * 1.001, slope);
            addWall(scene, front_first ? distance * 1.001 : distance, slope);
            GBuffer out;
            draw(scene.list(), view, out);
            CAPTURE(distance, slope, front_first);
            CHECK(pixelsOf(out, front_first ? 1 : 2) == view.width * view.height);
        }
    }
}

TEST_CASE("depth: 1 at the near plane, about near / distance beyond, 0 where nothing is",
          "[depth]") {
    const FrameView view = farView();
    for (double distance : {0.06, 1.0, 50.0, 4000.0}) {
        TestScene scene;
        addWall(scene, distance, 0);
        GBuffer out;
        draw(scene.list(), view, out);
        const double expected = kNear / distance * (kFar - distance) / (kFar - kNear);
        CHECK(double(std::bit_cast<float>(out.depth.at(80, 50))) == Approx(expected).epsilon(1e-5));
    }
    TestScene empty;
    GBuffer out;
    draw(empty.list(), view, out);
    CHECK(out.depth.at(80, 50) == 0);
    CHECK(out.id.at(80, 50) == 0);
}

TEST_CASE("depth: beyond the far plane nothing is seen", "[depth]") {
    const FrameView view = farView();
    TestScene scene;
    addWall(scene, kFar * 1.01, 0);
    GBuffer out;
    draw(scene.list(), view, out);
    CHECK(pixelsOf(out, 0) == view.width * view.height);
}

TEST_CASE("depth: the first of equal triangles stays", "[depth]") {
    Random random(1);
    const FrameView view = flatView(100, 60, random);
    TestScene scene;
    for (int k = 0; k < 5; ++k) {
        scene.addTriangle(atPixel(view, -10, -10, 0.3), atPixel(view, 300, -10, 0.4),
                          atPixel(view, -10, 300, 0.7));
    }
    GBuffer out;
    draw(scene.list(), view, out);
    CHECK(pixelsOf(out, 1) > 4000);
    CHECK(pixelsOf(out, 1) + pixelsOf(out, 0) == view.width * view.height);
}

TEST_CASE("depth: order of submission does not matter where depths differ", "[depth]") {
    Random random(2);
    const FrameView view = flatView(150, 90, random);
    TestScene forwards, backwards;
    std::vector<std::array<TestVertex, 3>> triangles;
    for (int k = 0; k < 200; ++k) {
        const double depth = (k + 1) / 256.0;
        std::array<TestVertex, 3> t;
        for (TestVertex& v : t) {
            v = atPixel(view, random.real(-50, 200), random.real(-50, 140), depth);
        }
        triangles.push_back(t);
    }
    for (size_t k = 0; k < triangles.size(); ++k) {
        const auto& a = triangles[k];
        const auto& b = triangles[triangles.size() - 1 - k];
        forwards.addTriangle(a[0], a[1], a[2]);
        backwards.addTriangle(b[0], b[1], b[2]);
    }
    GBuffer a, b;
    draw(forwards.list(), view, a);
    draw(backwards.list(), view, b);
    int wrong = 0;
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) {
            const size_t seen_a = a.id.at(x, y), seen_b = b.id.at(x, y);
            wrong += seen_a == 0 ? seen_b != 0 : seen_a + seen_b != triangles.size() + 1;
        }
    }
    CHECK(wrong == 0);
}
