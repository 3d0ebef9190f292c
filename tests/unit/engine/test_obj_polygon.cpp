#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "engine/internal/obj_polygon.h"

using namespace still;

namespace {

using Corner = std::array<float, 3>;
using Triangles = std::vector<std::array<uint32_t, 3>>;

double area2(const Corner& a, const Corner& b, const Corner& c) {
    return (double(b[0]) - a[0]) * (double(c[1]) - a[1]) -
           (double(b[1]) - a[1]) * (double(c[0]) - a[0]);
}

double polygonArea2(const std::vector<Corner>& p) {
    double sum = 0;
    for (size_t i = 1; i + 1 < p.size(); ++i) {
        sum += area2(p[0], p[i], p[i + 1]);
    }
    return sum;
}

Triangles triangulate(const std::vector<Corner>& polygon) {
    Triangles triangles;
    triangulatePolygon(polygon, triangles);
    return triangles;
}

/// In the xy plane: no triangle is turned over and their areas add up to the polygon's, which is
/// only possible when they cover it exactly once.
void checkCoversOnce(const std::vector<Corner>& polygon) {
    const Triangles triangles = triangulate(polygon);
    CHECK(triangles.size() == polygon.size() - 2);
    const double whole = polygonArea2(polygon);
    double sum = 0;
    for (const auto& [a, b, c] : triangles) {
        const double area = area2(polygon[a], polygon[b], polygon[c]);
        CHECK(area * whole >= 0);
        sum += area;
    }
    CHECK(sum == Approx(whole));
}

std::vector<Corner> reversed(std::vector<Corner> polygon) {
    std::reverse(polygon.begin(), polygon.end());
    return polygon;
}

std::vector<Corner> rotated(std::vector<Corner> polygon, size_t by) {
    std::rotate(polygon.begin(), polygon.begin() + ptrdiff_t(by), polygon.end());
    return polygon;
}

}  // namespace

TEST_CASE("polygon: concave shapes are covered exactly once", "[unit][engine]") {
    const std::vector<std::vector<Corner>> shapes{
        {{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}},                        // dart
        {{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}},  // L
        {{0, 0, 0}, {5, 0, 0}, {5, 3, 0}, {4, 3, 0}, {4, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}},
        {{0, 0, 0}, {2, 0, 0}, {4, 0, 0}, {4, 2, 0}, {2, 2, 0}, {2, 4, 0}, {0, 4, 0}},  // collinear
        {{0, 0, 0},
         {6, 0, 0},
         {6, 6, 0},
         {0, 6, 0},
         {0, 0, 0},
         {2, 2, 0},
         {2, 4, 0},
         {4, 4, 0},
         {4, 2, 0},
         {2, 2, 0}},  // square with a hole, joined by a bridge
    };
    for (const std::vector<Corner>& shape : shapes) {
        for (size_t start = 0; start < shape.size(); ++start) {
            checkCoversOnce(rotated(shape, start));
            checkCoversOnce(reversed(rotated(shape, start)));
        }
    }
}

TEST_CASE("polygon: random star-shaped polygons are covered exactly once", "[unit][engine]") {
    std::mt19937 random(3);
    for (int round = 0; round < 300; ++round) {
        const int n = 3 + int(random() % 40);
        std::vector<Corner> polygon;
        for (int i = 0; i < n; ++i) {
            const double angle = 6.283185307 * i / n, radius = 1.0 + double(random() % 1000) / 100;
            polygon.push_back({float(radius * std::cos(angle)) + 100.0f,
                               float(radius * std::sin(angle)) - 50.0f, 0.0f});
        }
        checkCoversOnce(round % 2 == 0 ? polygon : reversed(polygon));
    }
}

TEST_CASE("polygon: the plane it lies in does not matter", "[unit][engine]") {
    const std::vector<Corner> flat{{0, 0, 0}, {3, 0, 0}, {3, 1, 0},
                                   {1, 1, 0}, {1, 3, 0}, {0, 3, 0}};
    const Triangles expected = triangulate(flat);
    std::vector<Corner> steep = flat, turned = flat;
    for (size_t i = 0; i < flat.size(); ++i) {
        steep[i] = {flat[i][0], flat[i][1], 0.5f * flat[i][0] + 0.25f * flat[i][1]};
        turned[i] = {flat[i][2], flat[i][0], flat[i][1]};
    }
    CHECK(triangulate(steep) == expected);
    CHECK(triangulate(turned) == expected);
}

TEST_CASE("polygon: quads are cut along the shorter diagonal", "[unit][engine]") {
    const Triangles triangles = triangulate({{-3, 0, 0}, {0, -1, 0}, {3, 0, 0}, {0, 1, 0}});
    for (const auto& t : triangles) {
        CHECK(std::count(t.begin(), t.end(), 1u) == 1);
        CHECK(std::count(t.begin(), t.end(), 3u) == 1);
    }
}

TEST_CASE("polygon: stars, points and lines give the right number of triangles", "[unit][engine]") {
    std::vector<Corner> star;
    for (int i = 0; i < 5; ++i) {
        star.push_back({float(std::cos(i * 2.513274)), float(std::sin(i * 2.513274)), 0});
    }
    CHECK(triangulate(star).size() == 3);
    CHECK(triangulate(std::vector<Corner>(7, Corner{1, 2, 3})).size() == 5);
    CHECK(triangulate({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {1.5f, 0, 0}}).size() == 3);
    CHECK(triangulate(std::vector<Corner>(20000, Corner{1, 2, 3})).size() == 19998);
}
