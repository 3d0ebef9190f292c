#include "demos/scenes/mesh_builder.h"

#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace still::scenes {
namespace {

dvec3 positionOf(const Mesh& mesh, uint32_t i) {
    return {mesh.x[i], mesh.y[i], mesh.z[i]};
}

dvec3 normalOf(const Mesh& mesh, uint32_t i) {
    return {mesh.attributes[i].nx, mesh.attributes[i].ny, mesh.attributes[i].nz};
}

/// Directions of +u and +v over a triangle, as long as the triangle is large.
struct TextureAxes {
    dvec3 along_u{0.0}, along_v{0.0};
};
TextureAxes textureAxes(const Mesh& mesh, uint32_t a, uint32_t b, uint32_t c) {
    const VertexAttributes &ta = mesh.attributes[a], &tb = mesh.attributes[b],
                           &tc = mesh.attributes[c];
    const double ub = double(tb.u) - ta.u, vb = double(tb.v) - ta.v;
    const double uc = double(tc.u) - ta.u, vc = double(tc.v) - ta.v;
    const double sign = ub * vc - uc * vb < 0 ? -1 : 1;
    const dvec3 eb = positionOf(mesh, b) - positionOf(mesh, a);
    const dvec3 ec = positionOf(mesh, c) - positionOf(mesh, a);
    return {(eb * vc - ec * vb) * sign, (ec * ub - eb * uc) * sign};
}

/// Any unit vector at right angles to `normal`.
dvec3 anyTangent(const dvec3& normal) {
    const dvec3 helper = std::abs(normal.x) < 0.7 ? dvec3{1, 0, 0} : dvec3{0, 1, 0};
    return unit(glm::cross(helper, normal));
}

VertexTangent tangentFor(const dvec3& normal, const TextureAxes& axes) {
    const dvec3 flat = axes.along_u - normal * glm::dot(normal, axes.along_u);
    const bool usable = glm::dot(flat, flat) > 1e-24;
    const dvec3 tangent = usable ? unit(flat) : anyTangent(normal);
    const bool mirrored = glm::dot(glm::cross(normal, tangent), axes.along_v) < 0;
    return {float(tangent.x), float(tangent.y), float(tangent.z), mirrored ? -1.0f : 1.0f};
}

}  // namespace

dvec3 unit(const dvec3& v) {
    const double length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    assert(length > 0);
    return {v.x / length, v.y / length, v.z / length};
}

uint32_t MeshBuilder::vertex(const dvec3& position, const dvec3& normal, const dvec2& uv) {
    const dvec3 n = unit(normal);
    mesh_.x.push_back(float(position.x));
    mesh_.y.push_back(float(position.y));
    mesh_.z.push_back(float(position.z));
    mesh_.attributes.push_back({float(n.x), float(n.y), float(n.z), float(uv.x), float(uv.y)});
    return mesh_.vertexCount() - 1;
}

void MeshBuilder::triangle(uint32_t a, uint32_t b, uint32_t c) {
    const dvec3 pa = positionOf(mesh_, a), pb = positionOf(mesh_, b), pc = positionOf(mesh_, c);
    if (pa == pb || pb == pc || pc == pa) {
        return;
    }
    if (mesh_.parts.empty() || mesh_.parts.back().material != material_) {
        mesh_.parts.push_back({mesh_.triangleCount(), 0, material_});
    }
    mesh_.indices.insert(mesh_.indices.end(), {a, b, c});
    ++mesh_.parts.back().triangle_count;
}

void MeshBuilder::gridTriangles(uint32_t first, int columns, int rows) {
    const uint32_t pitch = uint32_t(columns) + 1;
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            const uint32_t a = first + uint32_t(j) * pitch + uint32_t(i);
            triangle(a, a + 1, a + 1 + pitch);
            triangle(a, a + 1 + pitch, a + pitch);
        }
    }
}

void MeshBuilder::rectangle(const dvec3& corner, const dvec3& right, const dvec3& up,
                            double metres_per_uv, const dvec2& uv) {
    const dvec3 normal = glm::cross(right, up);
    const double du = glm::length(right) / metres_per_uv;
    const double dv = glm::length(up) / metres_per_uv;
    const uint32_t a = vertex(corner, normal, uv);
    vertex(corner + right, normal, uv + dvec2{du, 0});
    vertex(corner + up, normal, uv + dvec2{0, dv});
    vertex(corner + right + up, normal, uv + dvec2{du, dv});
    gridTriangles(a, 1, 1);
}

void MeshBuilder::polygon(std::span<const dvec3> corners, std::span<const dvec2> uvs) {
    assert(corners.size() == uvs.size());
    if (corners.size() < 3) {
        return;
    }
    dvec3 area{0.0};
    for (size_t i = 2; i < corners.size(); ++i) {
        area += glm::cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
    }
    if (glm::dot(area, area) < 1e-16) {
        return;
    }
    const uint32_t first = mesh_.vertexCount();
    for (size_t i = 0; i < corners.size(); ++i) {
        vertex(corners[i], area, uvs[i]);
    }
    for (uint32_t i = 2; i < corners.size(); ++i) {
        triangle(first, first + i - 1, first + i);
    }
}

void MeshBuilder::box(const dvec3& min, const dvec3& max, double metres_per_uv) {
    const dvec3 size = max - min;
    const dvec3 x{size.x, 0, 0}, y{0, size.y, 0}, z{0, 0, size.z};
    const double m = metres_per_uv;
    rectangle({max.x, min.y, max.z}, -z, y, m, dvec2{-max.z, min.y} / m);
    rectangle({min.x, min.y, min.z}, z, y, m, dvec2{min.z, min.y} / m);
    rectangle({min.x, max.y, max.z}, x, -z, m, dvec2{min.x, -max.z} / m);
    rectangle({min.x, min.y, min.z}, x, z, m, dvec2{min.x, min.z} / m);
    rectangle({min.x, min.y, max.z}, x, y, m, dvec2{min.x, min.y} / m);
    rectangle({max.x, min.y, min.z}, -x, y, m, dvec2{-max.x, min.y} / m);
}

void MeshBuilder::append(const Mesh& mesh, const dmat4& transform) {
    const glm::dmat3 normal_matrix = glm::transpose(glm::inverse(glm::dmat3(transform)));
    const uint32_t first = mesh_.vertexCount();
    for (uint32_t i = 0; i < mesh.vertexCount(); ++i) {
        vertex(dvec3(transform * glm::dvec4(positionOf(mesh, i), 1.0)),
               normal_matrix * normalOf(mesh, i), {mesh.attributes[i].u, mesh.attributes[i].v});
    }
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        triangle(first + mesh.indices[i], first + mesh.indices[i + 1], first + mesh.indices[i + 2]);
    }
}

Mesh MeshBuilder::take() {
    Mesh mesh = std::move(mesh_);
    mesh_ = Mesh{};
    return mesh;
}

Mesh MeshBuilder::takeWithTangents() {
    Mesh mesh = take();
    std::vector<TextureAxes> axes(mesh.vertexCount());
    for (size_t t = 0; t < mesh.indices.size(); t += 3) {
        const TextureAxes each =
            textureAxes(mesh, mesh.indices[t], mesh.indices[t + 1], mesh.indices[t + 2]);
        for (size_t k = t; k < t + 3; ++k) {
            axes[mesh.indices[k]].along_u += each.along_u;
            axes[mesh.indices[k]].along_v += each.along_v;
        }
    }
    for (uint32_t i = 0; i < mesh.vertexCount(); ++i) {
        mesh.tangents.push_back(tangentFor(normalOf(mesh, i), axes[i]));
    }
    return mesh;
}

}  // namespace still::scenes
