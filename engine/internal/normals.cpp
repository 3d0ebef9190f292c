// Sources: N. Max, "Weights for Computing Vertex Normals from Facet Normals", 1999 (weights that
// are exact on spheres and need no angles); M. Mikkelsen, "Simulation of Wrinkled Surfaces
// Revisited", 2008 (tangent frames). Doubles, + − × ÷ √ in a written order.

#include "engine/internal/normals.h"

#include <bit>
#include <cassert>
#include <cmath>

#include "engine/internal/obj_unique.h"

namespace still {

namespace {

using Vector = std::array<double, 3>;

/// At places where more corners than this meet, creases are not looked for: it takes time quadratic
/// in their number.
constexpr size_t kMaxCreaseCorners = 256;

Vector toVector(const Vector3f& v) {
    return {v[0], v[1], v[2]};
}

Vector operator-(const Vector& a, const Vector& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Vector operator*(const Vector& a, double s) {
    return {a[0] * s, a[1] * s, a[2] * s};
}

void operator+=(Vector& a, const Vector& b) {
    a = {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

double dot(const Vector& a, const Vector& b) {
    return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}

Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vector normalisedVector(const Vector& v) {
    const double length = std::sqrt(dot(v, v));
    if (!(length > 0.0 && std::isfinite(length))) {
        return {0.0, 0.0, 0.0};
    }
    return {v[0] / length, v[1] / length, v[2] / length};
}

Vector3f toFloat(const Vector& v) {
    return {float(v[0]), float(v[1]), float(v[2])};
}

bool isZero(const Vector3f& v) {
    return v[0] == 0.0f && v[1] == 0.0f && v[2] == 0.0f;
}

/// Number of the place of each position.
std::vector<uint32_t> placesOf(std::span<const Vector3f> positions, size_t& count) {
    UniqueKeys<3> unique(positions.size());
    std::vector<uint32_t> places;
    places.reserve(positions.size());
    for (const Vector3f& p : positions) {
        // Adding +0 turns −0 into +0.
        places.push_back(unique.numberOf({std::bit_cast<uint32_t>(p[0] + 0.0f),
                                          std::bit_cast<uint32_t>(p[1] + 0.0f),
                                          std::bit_cast<uint32_t>(p[2] + 0.0f)}));
    }
    count = unique.size();
    return places;
}

/// Corners sorted by place, corners of one place in file order.
struct CornersByPlace {
    std::vector<uint32_t> begin, corners;

    CornersByPlace(std::span<const uint32_t> triangles, const std::vector<uint32_t>& places,
                   size_t place_count)
        : begin(place_count + 1), corners(triangles.size()) {
        for (const uint32_t position : triangles) {
            ++begin[places[position] + 1];
        }
        for (size_t i = 1; i < begin.size(); ++i) {
            begin[i] += begin[i - 1];
        }
        std::vector<uint32_t> next(begin.begin(), begin.end() - 1);
        for (uint32_t c = 0; c < triangles.size(); ++c) {
            corners[next[places[triangles[c]]]++] = c;
        }
    }
    std::span<const uint32_t> at(size_t place) const {
        return std::span(corners).subspan(begin[place], begin[place + 1] - begin[place]);
    }
};

/// What the normal at a corner is made of.
struct Facet {
    Vector normal;    ///< of the triangle, unit
    Vector weighted;  ///< the same, by the corner's weight
};

Facet facetOf(std::span<const Vector3f> positions, std::span<const uint32_t> triangles,
              uint32_t corner) {
    const uint32_t first = corner / 3 * 3;
    const Vector here = toVector(positions[triangles[corner]]);
    const Vector a = toVector(positions[triangles[first + (corner + 1 - first) % 3]]) - here;
    const Vector b = toVector(positions[triangles[first + (corner + 2 - first) % 3]]) - here;
    const Vector normal = cross(a, b);
    const double weight = dot(a, a) * dot(b, b);
    assert(weight > 0.0);
    return {normalisedVector(normal), {normal[0] / weight, normal[1] / weight, normal[2] / weight}};
}

/// Mean over the facets within the crease angle of `own`.
Vector3f meanNormal(const std::vector<Facet>& facets, const Facet& own) {
    const bool smooth_all = facets.size() > kMaxCreaseCorners;
    Vector sum{};
    for (const Facet& facet : facets) {
        if (smooth_all || dot(facet.normal, own.normal) >= kCreaseCosine) {
            sum += facet.weighted;
        }
    }
    const Vector3f mean = toFloat(normalisedVector(sum));
    return isZero(mean) ? toFloat(own.normal) : mean;
}

/// Some unit vector orthogonal to the unit vector n.
Vector anyOrthogonal(const Vector& n) {
    size_t axis = 0;
    for (size_t k = 1; k < 3; ++k) {
        axis = std::abs(n[k]) < std::abs(n[axis]) ? k : axis;
    }
    Vector unit{};
    unit[axis] = 1.0;
    return normalisedVector(cross(unit, n));
}

Vector positionOf(const Mesh& mesh, uint32_t vertex) {
    return {mesh.x[vertex], mesh.y[vertex], mesh.z[vertex]};
}

}  // namespace

Vector3f normalised(const Vector3f& v) {
    return toFloat(normalisedVector(toVector(v)));
}

bool isMirrored(std::array<float, 2> a, std::array<float, 2> b, std::array<float, 2> c) {
    const double bu = double(b[0]) - a[0], bv = double(b[1]) - a[1];
    const double cu = double(c[0]) - a[0], cv = double(c[1]) - a[1];
    return bu * cv - bv * cu < 0.0;
}

void generateNormals(std::span<const Vector3f> positions, std::span<const uint32_t> triangles,
                     std::span<Vector3f> normals) {
    assert(triangles.size() == normals.size());
    size_t place_count = 0;
    const std::vector<uint32_t> places = placesOf(positions, place_count);
    const CornersByPlace by_place(triangles, places, place_count);
    std::vector<Facet> facets;
    for (size_t place = 0; place < place_count; ++place) {
        const std::span<const uint32_t> corners = by_place.at(place);
        facets.clear();
        for (const uint32_t corner : corners) {
            facets.push_back(facetOf(positions, triangles, corner));
        }
        // With so many facets that all are taken, the mean is the same for every corner.
        const bool shared = facets.size() > kMaxCreaseCorners;
        const Vector3f shared_mean = shared ? meanNormal(facets, facets[0]) : Vector3f{};
        for (size_t i = 0; i < corners.size(); ++i) {
            if (isZero(normals[corners[i]])) {
                normals[corners[i]] = shared ? shared_mean : meanNormal(facets, facets[i]);
            }
        }
    }
}

std::vector<VertexTangent> generateTangents(const Mesh& mesh) {
    std::vector<Vector> along_u(mesh.vertexCount());
    std::vector<double> handedness(mesh.vertexCount());
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
        const Vector ab = positionOf(mesh, b) - positionOf(mesh, a);
        const Vector ac = positionOf(mesh, c) - positionOf(mesh, a);
        const VertexAttributes &ta = mesh.attributes[a], &tb = mesh.attributes[b],
                               &tc = mesh.attributes[c];
        const double bu = double(tb.u) - ta.u, bv = double(tb.v) - ta.v;
        const double cu = double(tc.u) - ta.u, cv = double(tc.v) - ta.v;
        const double orientation = bu * cv - bv * cu;
        if (orientation == 0.0) {
            continue;
        }
        const double sign = orientation < 0.0 ? -1.0 : 1.0;
        const Vector normal = cross(ab, ac);
        const double area = std::sqrt(dot(normal, normal));
        const Vector direction = normalisedVector((ab * cv - ac * bv) * sign) * area;
        for (const uint32_t vertex : {a, b, c}) {
            const VertexAttributes& at = mesh.attributes[vertex];
            along_u[vertex] += direction;
            // Against the vertex normal, so that it does not matter which way the triangle runs.
            handedness[vertex] += sign * dot(normal, {at.nx, at.ny, at.nz});
        }
    }
    std::vector<VertexTangent> tangents;
    tangents.reserve(mesh.vertexCount());
    for (uint32_t i = 0; i < mesh.vertexCount(); ++i) {
        const VertexAttributes& at = mesh.attributes[i];
        const Vector n{at.nx, at.ny, at.nz};
        Vector t = normalisedVector(along_u[i] - n * dot(n, along_u[i]));
        t = t[0] == 0.0 && t[1] == 0.0 && t[2] == 0.0 ? anyOrthogonal(n) : t;
        const Vector3f f = toFloat(t);
        tangents.push_back({f[0], f[1], f[2], handedness[i] < 0.0 ? -1.0f : 1.0f});
    }
    return tangents;
}

}  // namespace still
