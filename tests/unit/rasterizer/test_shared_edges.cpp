// Triangles that share edges leave no gap and hit no sample twice.

#include <catch2/catch.hpp>
#include <cmath>
#include <glm/vec2.hpp>

#include "tests/support/test_scene.h"

using namespace still;
using namespace still::test;

namespace {

struct Net {
    std::vector<glm::dvec2> points_px;
    std::vector<std::array<uint32_t, 3>> triangles;
};

/// Onto the rasterizer's grid, so that snapping does not turn a triangle of the net over.
glm::dvec2 onGrid(double x_px, double y_px) {
    return {std::round(x_px * 256) / 256, std::round(y_px * 256) / 256};
}

/// Twice the area of p q r.
double area2(const Net& net, uint32_t p, uint32_t q, uint32_t r) {
    const glm::dvec2 e = net.points_px[q] - net.points_px[p];
    const glm::dvec2 f = net.points_px[r] - net.points_px[p];
    return e.x * f.y - e.y * f.x;
}

/// Cuts a quad, which may have a dent, along a diagonal that lies inside.
void addQuad(Net& net, const std::array<uint32_t, 4>& q, Random& random) {
    const auto [a, b, c, d] = q;
    const bool first_fits = area2(net, a, c, b) * area2(net, a, c, d) < 0;
    const bool second_fits = area2(net, b, d, a) * area2(net, b, d, c) < 0;
    if (first_fits && (!second_fits || random.integer(0, 1) == 0)) {
        net.triangles.push_back({a, b, c});
        net.triangles.push_back({a, c, d});
    } else {
        net.triangles.push_back({b, c, d});
        net.triangles.push_back({b, d, a});
    }
}

/// A grid with shaken inner points and random diagonals that reaches `margin_px` beyond the
/// picture.
Net shakenGrid(const FrameView& view, int cells, double margin_px, Random& random) {
    Net net;
    for (int row = 0; row <= cells; ++row) {
        for (int column = 0; column <= cells; ++column) {
            const double step_x = (view.width + 2 * margin_px) / cells;
            const double step_y = (view.height + 2 * margin_px) / cells;
            const bool inner = row > 0 && row < cells && column > 0 && column < cells;
            const double shake = inner ? 0.49 : 0.0;
            const double x_px = (column + random.real(-shake, shake)) * step_x - margin_px;
            const double y_px = (row + random.real(-shake, shake)) * step_y - margin_px;
            net.points_px.push_back(onGrid(x_px, y_px));
        }
    }
    for (int row = 0; row < cells; ++row) {
        for (int column = 0; column < cells; ++column) {
            const auto a = uint32_t(row * (cells + 1) + column);
            addQuad(net, {a, a + 1, a + uint32_t(cells) + 2, a + uint32_t(cells) + 1}, random);
        }
    }
    return net;
}

/// Spokes from a point inside to points all around, far outside.
Net fan(const FrameView& view, int spokes, double radius_px, Random& random) {
    Net net;
    net.points_px.push_back(
        onGrid(random.real(0.2, 0.8) * view.width, random.real(0.2, 0.8) * view.height));
    for (int k = 0; k < spokes; ++k) {
        const double angle = 6.283185307179586 * (k + random.real(0, 0.9)) / spokes;
        net.points_px.push_back(onGrid(net.points_px[0].x + radius_px * std::cos(angle),
                                       net.points_px[0].y + radius_px * std::sin(angle)));
        net.triangles.push_back({0, uint32_t(k) + 1, uint32_t((k + 1) % spokes) + 1});
    }
    return net;
}

void addTriangle(TestScene& scene, const FrameView& view, const Net& net, size_t t) {
    std::array<TestVertex, 3> v;
    for (size_t k = 0; k < 3; ++k) {
        const glm::dvec2 p = net.points_px[net.triangles[t][k]];
        v[k] = atPixel(view, p.x, p.y, 0.5);
    }
    // Winding must not matter.
    t % 3 == 0 ? scene.addTriangle(v[0], v[2], v[1]) : scene.addTriangle(v[0], v[1], v[2]);
}

/// Draws each triangle of the net alone and counts the samples that were not covered once.
int badSamples(const FrameView& view, const Net& net) {
    std::vector<int> hits(size_t(view.width) * size_t(view.height), 0);
    GBuffer out;
    for (size_t t = 0; t < net.triangles.size(); ++t) {
        TestScene scene;
        addTriangle(scene, view, net, t);
        draw(scene.list(), view, out);
        for (int y = 0; y < view.height; ++y) {
            for (int x = 0; x < view.width; ++x) {
                hits[size_t(y) * size_t(view.width) + size_t(x)] += out.id.at(x, y) != 0 ? 1 : 0;
            }
        }
    }
    int bad = 0;
    for (int hit : hits) {
        bad += hit != 1 ? 1 : 0;
    }
    return bad;
}

/// Draws the whole net twice, in both orders. All depths are equal and the first one stays, so a
/// sample that is hit twice shows another triangle, and a gap shows none.
int badSamplesInOnePicture(const FrameView& view, const Net& net) {
    const size_t count = net.triangles.size();
    TestScene ascending, descending;
    for (size_t t = 0; t < count; ++t) {
        addTriangle(ascending, view, net, t);
        addTriangle(descending, view, net, count - 1 - t);
    }
    GBuffer a, b;
    draw(ascending.list(), view, a);
    draw(descending.list(), view, b);
    int bad = 0;
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) {
            const bool same = a.id.at(x, y) + size_t(b.id.at(x, y)) == count + 1;
            bad += a.id.at(x, y) == 0 || !same ? 1 : 0;
        }
    }
    return bad;
}

FrameView viewOf(int width, int height, Random& random) {
    FrameView view;
    view.width = width;
    view.height = height;
    view.jitter_x_fx8 = random.integer(-128, 127);
    view.jitter_y_fx8 = random.integer(-128, 127);
    return view;
}

}  // namespace

TEST_CASE("shared edges: each sample of a random net is covered by one triangle", "[coverage]") {
    for (uint64_t seed = 0; seed < 6; ++seed) {
        Random random(seed);
        const FrameView view = viewOf(random.integer(20, 90), random.integer(20, 90), random);
        CAPTURE(seed, view.width, view.height);
        CHECK(badSamples(view, shakenGrid(view, 6, 3, random)) == 0);
    }
}

TEST_CASE("shared edges: a net of points on samples covers each sample once", "[coverage]") {
    for (uint64_t seed = 0; seed < 4; ++seed) {
        Random random(seed + 50);
        const FrameView view = viewOf(64, 48, random);
        Net net = shakenGrid(view, 5, 8, random);
        for (glm::dvec2& p : net.points_px) {
            p = {std::floor(p.x) + 0.5 + view.jitter_x_fx8 / 256.0,
                 std::floor(p.y) + 0.5 + view.jitter_y_fx8 / 256.0};
        }
        CAPTURE(seed);
        CHECK(badSamples(view, net) == 0);
    }
}

TEST_CASE("shared edges: fans of thin spokes cover each sample once", "[coverage]") {
    const int spokes = GENERATE(3, 7, 90, 400);
    const double radius_px = GENERATE(300.0, 14000.0);
    Random random{uint64_t(spokes)};
    const FrameView view = viewOf(63, 65, random);
    CAPTURE(spokes, radius_px);
    CHECK(badSamples(view, fan(view, spokes, radius_px, random)) == 0);
}

TEST_CASE("shared edges: dense nets leave neither gaps nor double hits", "[coverage]") {
    const int cells = GENERATE(40, 110);
    Random random{uint64_t(cells)};
    const FrameView view = viewOf(300, 200, random);
    CHECK(badSamplesInOnePicture(view, shakenGrid(view, cells, 2, random)) == 0);
    CHECK(badSamplesInOnePicture(view, fan(view, cells * 100, 600, random)) == 0);
}

TEST_CASE("shared edges: nets as large as the guard band leave no gap", "[coverage]") {
    Random random(9);
    const FrameView view = viewOf(500, 300, random);
    for (int round = 0; round < 10; ++round) {
        CHECK(badSamplesInOnePicture(view, shakenGrid(view, 9, 12000, random)) == 0);
        CHECK(badSamplesInOnePicture(view, fan(view, 3000, 16000, random)) == 0);
    }
}

TEST_CASE("shared edges: a clipped triangle and its whole neighbour meet exactly", "[coverage]") {
    FrameView view;
    view.width = view.height = 256;
    view.view_projection = view.view_projection_before = perspective(1, 1, 0.1, 100);
    Random random(11);
    int bad = 0;
    for (int round = 0; round < 300; ++round) {
        // An upright edge halfway between two steps of the grid, where any two ways of rounding
        // differ, and the samples of one column on one of these steps.
        const int column = random.integer(2, 253);
        view.jitter_x_fx8 = random.integer(-127, 127);
        const int sample_fx8 = column * 256 + 128 + view.jitter_x_fx8;
        const double edge_px = (sample_fx8 + (round % 2 == 0 ? 0.5 : -0.5)) / 256.0;
        const auto corner = [&](double x_px, double y_px, double w) {
            return TestVertex{float((x_px / 128 - 1) * w), float((1 - y_px / 128) * w), float(-w)};
        };
        const auto some_w = [&] { return random.real(0.5, 20); };
        const TestVertex top = corner(edge_px, -5, some_w());
        const TestVertex bottom = corner(edge_px, 261, some_w());
        GBuffer left, right;
        TestScene whole, clipped;
        whole.addTriangle(top, bottom, corner(edge_px - 40, 128, some_w()));
        clipped.addTriangle(top, bottom, corner(edge_px + 40000, 128, some_w()));
        draw(whole.list(), view, left);
        draw(clipped.list(), view, right);
        for (int y = 0; y < 256; ++y) {
            for (int x = column - 1; x <= column + 1; ++x) {
                bad += (left.id.at(x, y) != 0) + (right.id.at(x, y) != 0) == 1 ? 0 : 1;
            }
        }
    }
    CHECK(bad == 0);
}
