#include "engine/shapes.h"

#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>

#include "engine/det_math.h"

namespace still::shapes {
namespace {

/// Adds a vertex and returns its index. Computed in double, rounded once.
uint32_t addVertex(Mesh& mesh, const glm::dvec3& position, const glm::dvec3& normal, double u,
                   double v) {
    mesh.x.push_back(float(position.x));
    mesh.y.push_back(float(position.y));
    mesh.z.push_back(float(position.z));
    mesh.attributes.push_back(
        {float(normal.x), float(normal.y), float(normal.z), float(u), float(v)});
    return mesh.vertexCount() - 1;
}

void addTriangle(Mesh& mesh, uint32_t a, uint32_t b, uint32_t c) {
    mesh.indices.insert(mesh.indices.end(), {a, b, c});
}

/// Triangles of a grid whose vertices start at `first`, `columns` + 1 in a row, the next row above.
/// Seen from outside, columns grow to the right.
void addGridTriangles(Mesh& mesh, uint32_t first, int columns, int rows) {
    const uint32_t pitch = uint32_t(columns) + 1;
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            const uint32_t a = first + uint32_t(j) * pitch + uint32_t(i);
            addTriangle(mesh, a, a + 1, a + 1 + pitch);
            addTriangle(mesh, a, a + 1 + pitch, a + pitch);
        }
    }
}

Mesh finished(Mesh mesh) {
    mesh.parts = {{.first_triangle = 0, .triangle_count = mesh.triangleCount(), .material = 0}};
    return mesh;
}

/// A point of the unit circle seen from +y: step i of n, counter-clockwise from +x. The last step
/// is the first one to the bit, so that seams close.
struct CirclePoint {
    double x, z;
};
CirclePoint circle(int i, int n) {
    const double turns = double(i % n) / n;
    return {det::cosTurns(turns), -det::sinTurns(turns)};
}

/// Cap of the unit cylinder at y = ±1: a fan with planar texture coordinates.
void addCap(Mesh& mesh, int segments, double y) {
    const glm::dvec3 normal{0, y, 0};
    const uint32_t centre = addVertex(mesh, {0, y, 0}, normal, 0.5, 0.5);
    for (int i = 0; i < segments; ++i) {
        const CirclePoint p = circle(i, segments);
        addVertex(mesh, {p.x, y, p.z}, normal, 0.5 + 0.5 * p.x, 0.5 - 0.5 * p.z * y);
    }
    for (int i = 0; i < segments; ++i) {
        const uint32_t a = centre + 1 + uint32_t(i);
        const uint32_t b = centre + 1 + uint32_t((i + 1) % segments);
        addTriangle(mesh, centre, y > 0 ? a : b, y > 0 ? b : a);
    }
}

/// One pole of the sphere: each triangle has its own tip in the middle of its strip of the texture.
void addPole(Mesh& mesh, int segments, double y, uint32_t ring) {
    for (int i = 0; i < segments; ++i) {
        const double u = (i + 0.5) / segments;
        const uint32_t tip = addVertex(mesh, {0, y, 0}, {0, y, 0}, u, y > 0 ? 1 : 0);
        const uint32_t a = ring + uint32_t(i);
        addTriangle(mesh, y > 0 ? a : a + 1, y > 0 ? a + 1 : a, tip);
    }
}

}  // namespace

Mesh box(float x, float y, float z) {
    const glm::dvec3 half{x, y, z};
    Mesh mesh;
    // Each face: its normal, then the directions of u and v; u × v = normal.
    const glm::dvec3 faces[6][3] = {
        {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}, {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
        {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}}, {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
        {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}},  {{0, 0, -1}, {-1, 0, 0}, {0, 1, 0}},
    };
    for (const auto& [normal, right, up] : faces) {
        const uint32_t first = mesh.vertexCount();
        for (int corner = 0; corner < 4; ++corner) {
            const double u = corner % 2, v = corner / 2;
            addVertex(mesh, (normal + right * (2 * u - 1) + up * (2 * v - 1)) * half, normal, u, v);
        }
        addGridTriangles(mesh, first, 1, 1);
    }
    return finished(std::move(mesh));
}

Mesh plane(float x, float z, int nx, int nz, float tiles) {
    assert(nx >= 1 && nz >= 1);
    Mesh mesh;
    for (int j = 0; j <= nz; ++j) {
        for (int i = 0; i <= nx; ++i) {
            const double u = double(i) / nx, v = double(j) / nz;
            addVertex(mesh, {(2 * u - 1) * x, 0, (1 - 2 * v) * z}, {0, 1, 0}, u * tiles, v * tiles);
        }
    }
    addGridTriangles(mesh, 0, nx, nz);
    return finished(std::move(mesh));
}

Mesh sphere(int segments, int rings) {
    assert(segments >= 3 && rings >= 2);
    Mesh mesh;
    for (int j = 1; j < rings; ++j) {
        const double v = double(j) / rings;
        const double y = -det::cosTurns(v / 2), radius = det::sinTurns(v / 2);
        for (int i = 0; i <= segments; ++i) {
            const CirclePoint p = circle(i, segments);
            const glm::dvec3 position{radius * p.x, y, radius * p.z};
            addVertex(mesh, position, position, double(i) / segments, v);
        }
    }
    addGridTriangles(mesh, 0, segments, rings - 2);
    addPole(mesh, segments, -1, 0);
    addPole(mesh, segments, 1, uint32_t(rings - 2) * (uint32_t(segments) + 1));
    return finished(std::move(mesh));
}

Mesh cylinder(int segments) {
    assert(segments >= 3);
    Mesh mesh;
    for (int j = 0; j < 2; ++j) {
        for (int i = 0; i <= segments; ++i) {
            const CirclePoint p = circle(i, segments);
            addVertex(mesh, {p.x, 2.0 * j - 1, p.z}, {p.x, 0, p.z}, double(i) / segments, j);
        }
    }
    addGridTriangles(mesh, 0, segments, 1);
    addCap(mesh, segments, -1);
    addCap(mesh, segments, 1);
    return finished(std::move(mesh));
}

Mesh torus(float tube, int segments, int sides) {
    assert(segments >= 3 && sides >= 3);
    Mesh mesh;
    for (int j = 0; j <= sides; ++j) {
        const double angle = double(j % sides) / sides;
        const double out = det::cosTurns(angle), up = det::sinTurns(angle);
        for (int i = 0; i <= segments; ++i) {
            const CirclePoint p = circle(i, segments);
            const double radius = 1 + tube * out;
            addVertex(mesh, {radius * p.x, tube * up, radius * p.z}, {out * p.x, up, out * p.z},
                      double(i) / segments, double(j) / sides);
        }
    }
    addGridTriangles(mesh, 0, segments, sides);
    return finished(std::move(mesh));
}

Result<Mesh> named(const std::string& name) {
    if (name == "box") {
        return box(1, 1, 1);
    }
    if (name == "plane") {
        return plane(1, 1, 1, 1, 1);
    }
    if (name == "sphere") {
        return sphere(64, 32);
    }
    if (name == "cylinder") {
        return cylinder(64);
    }
    if (name == "torus") {
        return torus(0.35f, 96, 32);
    }
    std::string known;
    for (const std::string& each : names()) {
        known += (known.empty() ? "" : ", ") + each;
    }
    return fail("shape \"" + name + "\" is unknown, expected one of " + known);
}

std::vector<std::string> names() {
    return {"box", "plane", "sphere", "cylinder", "torus"};
}

}  // namespace still::shapes
