#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <tuple>

#include "engine/shapes.h"

using namespace still;

namespace {

struct NamedMesh {
    std::string name;
    Mesh mesh;
};

std::vector<NamedMesh> samples() {
    return {{"box", shapes::box(1, 2, 3)},
            {"plane", shapes::plane(2, 3, 4, 5, 6)},
            {"flat plane", shapes::plane(1, 1, 1, 1, 1)},
            {"sphere", shapes::sphere(16, 8)},
            {"coarse sphere", shapes::sphere(3, 2)},
            {"cylinder", shapes::cylinder(12)},
            {"coarse cylinder", shapes::cylinder(3)},
            {"torus", shapes::torus(0.3f, 16, 8)},
            {"coarse torus", shapes::torus(0.5f, 3, 3)}};
}

glm::dvec3 position(const Mesh& mesh, uint32_t i) {
    return {mesh.x[i], mesh.y[i], mesh.z[i]};
}

glm::dvec3 normal(const Mesh& mesh, uint32_t i) {
    return {mesh.attributes[i].nx, mesh.attributes[i].ny, mesh.attributes[i].nz};
}

/// Area vector of triangle t: direction is the winding's normal, length twice the area.
glm::dvec3 areaVector(const Mesh& mesh, uint32_t t) {
    const glm::dvec3 a = position(mesh, mesh.indices[3 * t]);
    const glm::dvec3 b = position(mesh, mesh.indices[3 * t + 1]);
    const glm::dvec3 c = position(mesh, mesh.indices[3 * t + 2]);
    return glm::cross(b - a, c - a);
}

using Point = std::tuple<float, float, float>;
Point point(const Mesh& mesh, uint32_t i) {
    return {mesh.x[i] + 0.0f, mesh.y[i] + 0.0f, mesh.z[i] + 0.0f};
}

}  // namespace

TEST_CASE("shapes: every mesh is well formed with one part that covers it", "[engine][unit]") {
    for (const auto& [name, mesh] : samples()) {
        INFO(name);
        CHECK(mesh.triangleCount() > 0);
        CHECK(mesh.y.size() == mesh.x.size());
        CHECK(mesh.z.size() == mesh.x.size());
        CHECK(mesh.attributes.size() == mesh.x.size());
        CHECK(std::all_of(mesh.indices.begin(), mesh.indices.end(),
                          [count = mesh.vertexCount()](uint32_t i) { return i < count; }));
        REQUIRE(mesh.parts.size() == 1);
        CHECK(mesh.parts[0].first_triangle == 0);
        CHECK(mesh.parts[0].triangle_count == mesh.triangleCount());
    }
}

TEST_CASE("shapes: normals are of unit length and agree with the winding", "[engine][unit]") {
    for (const auto& [name, mesh] : samples()) {
        INFO(name);
        for (uint32_t i = 0; i < mesh.vertexCount(); ++i) {
            REQUIRE(glm::length(normal(mesh, i)) == Approx(1.0).margin(1e-6));
        }
        for (uint32_t t = 0; t < mesh.triangleCount(); ++t) {
            const glm::dvec3 area = areaVector(mesh, t);
            REQUIRE(glm::length(area) > 1e-9);
            glm::dvec3 sum{0};
            for (int k = 0; k < 3; ++k) {
                sum += normal(mesh, mesh.indices[3 * t + uint32_t(k)]);
            }
            REQUIRE(glm::dot(area, sum) > 0);
        }
    }
}

TEST_CASE("shapes: closed meshes have no holes and enclose a positive volume", "[engine][unit]") {
    for (const auto& [name, mesh] : samples()) {
        if (name.find("plane") != std::string::npos) {
            continue;
        }
        INFO(name);
        std::map<std::pair<Point, Point>, int> edges;
        double volume = 0;
        for (uint32_t t = 0; t < mesh.triangleCount(); ++t) {
            for (uint32_t k = 0; k < 3; ++k) {
                const Point a = point(mesh, mesh.indices[3 * t + k]);
                const Point b = point(mesh, mesh.indices[3 * t + (k + 1) % 3]);
                ++edges[{a, b}];
                --edges[{b, a}];
            }
            volume += glm::dot(areaVector(mesh, t), position(mesh, mesh.indices[3 * t])) / 6;
        }
        CHECK(std::all_of(edges.begin(), edges.end(), [](const auto& e) { return e.second == 0; }));
        CHECK(volume > 0.1);
    }
}

TEST_CASE("shapes: texture coordinates run along the surface and never mirror", "[engine][unit]") {
    for (const auto& [name, mesh] : samples()) {
        INFO(name);
        const float top = name == "plane" ? 6.0f : 1.0f;
        for (uint32_t t = 0; t < mesh.triangleCount(); ++t) {
            double u[3], v[3];
            for (uint32_t k = 0; k < 3; ++k) {
                const VertexAttributes& each = mesh.attributes[mesh.indices[3 * t + k]];
                u[k] = each.u;
                v[k] = each.v;
                REQUIRE(each.u >= 0);
                REQUIRE(each.u <= top);
                REQUIRE(each.v >= 0);
                REQUIRE(each.v <= top);
            }
            // A seam without its own vertices would turn one strip of triangles around.
            REQUIRE((u[1] - u[0]) * (v[2] - v[0]) - (u[2] - u[0]) * (v[1] - v[0]) > 0);
        }
    }
}

TEST_CASE("shapes: radii and extents are as documented", "[engine][unit]") {
    const Mesh sphere = shapes::sphere(20, 10);
    for (uint32_t i = 0; i < sphere.vertexCount(); ++i) {
        REQUIRE(glm::length(position(sphere, i)) == Approx(1.0).margin(1e-6));
    }
    const Mesh torus = shapes::torus(0.25f, 20, 10);
    for (uint32_t i = 0; i < torus.vertexCount(); ++i) {
        const glm::dvec3 p = position(torus, i);
        const double ring = std::sqrt(p.x * p.x + p.z * p.z) - 1;
        REQUIRE(std::sqrt(ring * ring + p.y * p.y) == Approx(0.25).margin(1e-6));
    }
    const Mesh box = shapes::box(1, 2, 3);
    CHECK(*std::max_element(box.y.begin(), box.y.end()) == 2.0f);
    CHECK(*std::min_element(box.z.begin(), box.z.end()) == -3.0f);
    CHECK(shapes::plane(1, 1, 7, 3, 1).triangleCount() == 42);
}

TEST_CASE("shapes: every listed name makes a mesh, another name is refused", "[engine][unit]") {
    for (const std::string& name : shapes::names()) {
        CHECK(shapes::named(name).has_value());
    }
    const auto refused = shapes::named("dodecahedron");
    REQUIRE(!refused.has_value());
    CHECK(refused.error().message.find("dodecahedron") != std::string::npos);
    CHECK(refused.error().message.find("torus") != std::string::npos);
}
