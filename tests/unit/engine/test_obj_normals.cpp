#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "engine/internal/normals.h"

using namespace still;

namespace {

double dot(const Vector3f& a, const Vector3f& b) {
    return double(a[0]) * b[0] + double(a[1]) * b[1] + double(a[2]) * b[2];
}

std::vector<Vector3f> generate(const std::vector<Vector3f>& positions,
                               const std::vector<uint32_t>& triangles) {
    std::vector<Vector3f> normals(triangles.size());
    generateNormals(positions, triangles, normals);
    return normals;
}

const std::vector<Vector3f> kCube{{-1, -1, -1}, {1, -1, -1}, {-1, 1, -1}, {1, 1, -1},
                                  {-1, -1, 1},  {1, -1, 1},  {-1, 1, 1},  {1, 1, 1}};
const std::vector<uint32_t> kCubeTriangles{0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                           2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};

/// Two quads along x that meet at x = 0 in an angle of `degrees`.
std::vector<Vector3f> fold(double degrees) {
    const double a = degrees * 3.14159265358979 / 180;
    const float x = float(std::cos(a)), y = float(std::sin(a));
    return {{-1, 0, 0}, {0, 0, 0}, {0, 0, 1}, {-1, 0, 1}, {x, y, 0}, {x, y, 1}};
}
const std::vector<uint32_t> kFoldTriangles{0, 2, 1, 0, 3, 2, 1, 5, 4, 1, 2, 5};

}  // namespace

TEST_CASE("normals: a cube keeps its edges", "[unit][engine]") {
    const std::vector<Vector3f> normals = generate(kCube, kCubeTriangles);
    for (size_t t = 0; t < 12; ++t) {
        for (size_t k = 0; k < 3; ++k) {
            const Vector3f& n = normals[t * 3 + k];
            CHECK(std::abs(n[0]) + std::abs(n[1]) + std::abs(n[2]) == 1.0f);
            CHECK(n == normals[t * 3]);
        }
    }
}

TEST_CASE("normals: edges under 60 degrees are smooth, others are not", "[unit][engine]") {
    for (const double degrees : {5.0, 30.0, 59.0}) {
        const std::vector<Vector3f> normals = generate(fold(degrees), kFoldTriangles);
        CHECK(normals[2] == normals[6]);
    }
    for (const double degrees : {61.0, 90.0, 150.0}) {
        const std::vector<Vector3f> normals = generate(fold(degrees), kFoldTriangles);
        CHECK(normals[2] == normals[0]);
        CHECK(normals[6] == normals[8]);
    }
}

TEST_CASE("normals: vertices at the same place are smoothed together", "[unit][engine]") {
    std::vector<Vector3f> shared = fold(20), split;
    std::vector<uint32_t> split_triangles;
    for (const uint32_t i : kFoldTriangles) {
        split_triangles.push_back(uint32_t(split.size()));
        split.push_back(shared[i]);
        split.back()[1] = split.back()[1] == 0.0f ? -0.0f : split.back()[1];
    }
    CHECK(generate(shared, kFoldTriangles) == generate(split, split_triangles));
}

TEST_CASE("normals: a sphere's are radial and of unit length", "[unit][engine]") {
    // Latitude-longitude sphere; its triangles differ in size and shape.
    constexpr int kSegments = 40, kRings = 20;
    std::vector<Vector3f> positions;
    std::vector<uint32_t> triangles;
    for (int r = 0; r <= kRings; ++r) {
        for (int s = 0; s < kSegments; ++s) {
            const double a = 6.283185307 * s / kSegments, b = 3.141592654 * r / kRings;
            positions.push_back({float(std::sin(b) * std::cos(a)), float(std::cos(b)),
                                 float(std::sin(b) * std::sin(a))});
        }
    }
    const auto at = [](int r, int s) { return uint32_t(r * kSegments + s % kSegments); };
    for (int r = 1; r < kRings; ++r) {
        for (int s = 0; s < kSegments && r + 1 < kRings; ++s) {
            triangles.insert(triangles.end(), {at(r, s), at(r, s + 1), at(r + 1, s)});
            triangles.insert(triangles.end(), {at(r, s + 1), at(r + 1, s + 1), at(r + 1, s)});
        }
    }
    const std::vector<Vector3f> normals = generate(positions, triangles);
    for (size_t i = 0; i < normals.size(); ++i) {
        const uint32_t ring = triangles[i] / kSegments;
        CHECK(dot(normals[i], normals[i]) == Approx(1.0).epsilon(1e-6));
        if (ring > 1 && ring < kRings - 1) {
            CHECK(dot(normals[i], positions[triangles[i]]) > 0.9999);
        }
    }
}

TEST_CASE("normals: given ones stay, tiny and huge triangles work", "[unit][engine]") {
    for (const float scale : {1e-18f, 1.0f, 1e18f}) {
        const std::vector<Vector3f> positions{{0, 0, 0}, {scale, 0, 0}, {0, scale, 0}};
        const std::vector<uint32_t> triangle{0, 1, 2};
        std::vector<Vector3f> normals(3);
        normals[1] = {0, 1, 0};
        generateNormals(positions, triangle, normals);
        CHECK(normals[0] == Vector3f{0, 0, 1});
        CHECK(normals[1] == Vector3f{0, 1, 0});
        CHECK(normals[2] == Vector3f{0, 0, 1});
    }
}

TEST_CASE("normals: a fan of thousands of triangles takes no quadratic time", "[unit][engine]") {
    std::vector<Vector3f> positions{{0, 0, 0}};
    std::vector<uint32_t> triangles;
    constexpr uint32_t kCount = 200000;
    for (uint32_t i = 0; i <= kCount; ++i) {
        const float t = float(i) / kCount;
        positions.push_back({t, 1.0f - t, 0.0f});
    }
    for (uint32_t i = 1; i <= kCount; ++i) {
        triangles.insert(triangles.end(), {0, i + 1, i});
    }
    const std::vector<Vector3f> normals = generate(positions, triangles);
    CHECK(normals[0] == Vector3f{0, 0, 1});
}

TEST_CASE("tangents: follow u, are orthogonal to the normal, and know mirrored textures",
          "[unit][engine]") {
    std::mt19937 random(9);
    for (int round = 0; round < 100; ++round) {
        const auto number = [&] { return float(int(random() % 2001) - 1000) / 500.0f; };
        Mesh mesh;
        for (int i = 0; i < 3; ++i) {
            mesh.x.push_back(number());
            mesh.y.push_back(number());
            mesh.z.push_back(0.0f);
            mesh.attributes.push_back({0, 0, 1, mesh.x.back(), mesh.y.back()});
        }
        const bool mirrored = round % 2 == 1;
        for (VertexAttributes& a : mesh.attributes) {
            a.u = mirrored ? -a.u : a.u;
        }
        mesh.indices = {0, 1, 2};
        const std::vector<VertexTangent> tangents = generateTangents(mesh);
        for (const VertexTangent& t : tangents) {
            CHECK(t.x == Approx(mirrored ? -1.0 : 1.0));
            CHECK(t.y == Approx(0.0).margin(1e-5));
            CHECK(t.z == 0.0f);
            CHECK(t.handedness == (mirrored ? -1.0f : 1.0f));
        }
    }
}

TEST_CASE("tangents: without usable texture coordinates any orthogonal unit vector is taken",
          "[unit][engine]") {
    Mesh mesh;
    mesh.x = {0, 1, 0};
    mesh.y = {0, 0, 1};
    mesh.z = {0, 0, 0};
    mesh.attributes.assign(3, {0, 0, 1, 0.5f, 0.5f});
    mesh.indices = {0, 1, 2};
    for (const VertexTangent& t : generateTangents(mesh)) {
        CHECK(t.z == 0.0f);
        CHECK(double(t.x) * t.x + double(t.y) * t.y == Approx(1.0));
    }
}
