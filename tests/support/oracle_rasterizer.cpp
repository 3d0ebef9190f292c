#include "tests/support/oracle_rasterizer.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>

#include "rasterizer/fixed.h"
#include "tests/support/oracle_clip.h"

namespace still::oracle {
namespace {

glm::dmat4 toMatrix(const Affine& a) {
    glm::dmat4 m(1.0);
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
            m[column][row] = double(a[size_t(row * 4 + column)]);
        }
    }
    return m;
}

/// Rows x, y, reversed z, w of the matrix, rounded to float once.
std::array<glm::vec4, 4> rasterRows(const glm::dmat4& m) {
    std::array<glm::dvec4, 4> rows;
    for (int r = 0; r < 4; ++r) {
        rows[size_t(r)] = {m[0][r], m[1][r], m[2][r], m[3][r]};
    }
    rows[2] = 0.5 * (rows[3] - rows[2]);
    return {glm::vec4(rows[0]), glm::vec4(rows[1]), glm::vec4(rows[2]), glm::vec4(rows[3])};
}

float rowTimes(const glm::vec4& r, float x, float y, float z) {
    const float left = r.x * x + r.y * y;
    const float right = r.z * z + r.w;
    return left + right;
}

bool finite(const glm::dvec4& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
}

/// Twice the signed area of (a, b, p); positive when p is right of a → b with y down.
int64_t edge(const Corner& a, const Corner& b, int64_t x, int64_t y) {
    return (b.x_fx8 - a.x_fx8) * (y - a.y_fx8) - (b.y_fx8 - a.y_fx8) * (x - a.x_fx8);
}

/// With y down and positive area: a top edge runs to the right, a left edge runs upwards.
bool isTopLeft(const Corner& a, const Corner& b) {
    return (a.y_fx8 == b.y_fx8 && b.x_fx8 > a.x_fx8) || b.y_fx8 < a.y_fx8;
}

bool triangleCovers(const Corner& a, Corner b, Corner c, int64_t x, int64_t y) {
    const int64_t area = edge(a, b, c.x_fx8, c.y_fx8);
    if (area == 0) {
        return false;
    }
    if (area < 0) {
        std::swap(b, c);
    }
    const auto inside = [&](const Corner& p, const Corner& q) {
        const int64_t e = edge(p, q, x, y);
        return e > 0 || (e == 0 && isTopLeft(p, q));
    };
    return inside(a, b) && inside(b, c) && inside(c, a);
}

double distanceToSegment(const Corner& a, const Corner& b, double x, double y) {
    const double dx = double(b.x_fx8 - a.x_fx8);
    const double dy = double(b.y_fx8 - a.y_fx8);
    const double px = x - double(a.x_fx8);
    const double py = y - double(a.y_fx8);
    const double length2 = dx * dx + dy * dy;
    const double t = length2 == 0 ? 0 : std::clamp((px * dx + py * dy) / length2, 0.0, 1.0);
    return std::hypot(px - t * dx, py - t * dy);
}

}  // namespace

void Range::add(double v) {
    min = std::min(min, v);
    max = std::max(max, v);
}

Frame::Frame(const DrawList& list, const FrameView& view) : list_(list), view_(view) {
    for (const Instance& instance : list.instances) {
        addInstance(instance);
    }
}

void Frame::addInstance(const Instance& instance) {
    const Mesh& mesh = list_.meshes[instance.mesh];
    const glm::dmat4 mvp = instance.identity ? view_.view_projection
                                             : view_.view_projection * toMatrix(instance.transform);
    const std::array<glm::vec4, 4> rows = rasterRows(mvp);
    for (size_t part = 0; part < mesh.parts.size(); ++part) {
        const MeshPart& p = mesh.parts[part];
        for (uint32_t t = p.first_triangle; t < p.first_triangle + p.triangle_count; ++t) {
            Triangle triangle;
            triangle.surface = uint16_t(instance.first_surface + part);
            triangle.mesh = &mesh;
            triangle.instance = &instance;
            bool all_finite = true;
            for (size_t k = 0; k < 3; ++k) {
                const uint32_t v = mesh.indices[size_t(t) * 3 + k];
                triangle.vertices[k] = v;
                for (int r = 0; r < 4; ++r) {
                    triangle.clip[k][r] =
                        double(rowTimes(rows[size_t(r)], mesh.x[v], mesh.y[v], mesh.z[v]));
                }
                all_finite = all_finite && finite(triangle.clip[k]);
            }
            if (all_finite) {
                clipAndSnap(triangle, view_);
            }
            triangles_.push_back(triangle);
        }
    }
}

std::array<int64_t, 2> Frame::sample(int px, int py) const {
    return {int64_t(px) * 256 + 128 + view_.jitter_x_fx8,
            int64_t(py) * 256 + 128 + view_.jitter_y_fx8};
}

bool Frame::covers(const Triangle& triangle, int px, int py) const {
    const auto [x, y] = sample(px, py);
    const std::vector<Corner>& p = triangle.polygon;
    for (size_t k = 2; k < p.size(); ++k) {
        if (triangleCovers(p[0], p[k - 1], p[k], x, y)) {
            return true;
        }
    }
    return false;
}

double Frame::depthAt(const Triangle& triangle, int px, int py) const {
    const auto [x, y] = sample(px, py);
    const std::vector<Corner>& p = triangle.polygon;
    for (size_t k = 2; k < p.size(); ++k) {
        if (triangleCovers(p[0], p[k - 1], p[k], x, y)) {
            const double area = double(edge(p[0], p[k - 1], p[k].x_fx8, p[k].y_fx8));
            const double b1 = double(edge(p[k], p[0], x, y)) / area;
            const double b2 = double(edge(p[0], p[k - 1], x, y)) / area;
            return p[0].depth + b1 * (p[k - 1].depth - p[0].depth) + b2 * (p[k].depth - p[0].depth);
        }
    }
    return 0;
}

double Frame::depthSlope(const Triangle& triangle) const {
    const std::vector<Corner>& p = triangle.polygon;
    double steepest = 0;
    for (size_t k = 2; k < p.size(); ++k) {
        const double area = double(edge(p[0], p[k - 1], p[k].x_fx8, p[k].y_fx8));
        if (area == 0) {
            continue;
        }
        const double z1 = p[k - 1].depth - p[0].depth, z2 = p[k].depth - p[0].depth;
        const double dx =
            z1 * double(p[k].y_fx8 - p[0].y_fx8) - z2 * double(p[k - 1].y_fx8 - p[0].y_fx8);
        const double dy =
            z2 * double(p[k - 1].x_fx8 - p[0].x_fx8) - z1 * double(p[k].x_fx8 - p[0].x_fx8);
        steepest = std::max(steepest, (std::abs(dx) + std::abs(dy)) / std::abs(area));
    }
    return steepest * kSubpixelOne;
}

bool Frame::nearCreatedEdge(const Triangle& triangle, int px, int py, double distance_px) const {
    const auto [x, y] = sample(px, py);
    const std::vector<Corner>& p = triangle.polygon;
    for (size_t k = 0; k < p.size(); ++k) {
        const Corner& a = p[k];
        const Corner& b = p[(k + 1) % p.size()];
        if ((a.created || b.created) &&
            distanceToSegment(a, b, double(x), double(y)) <= distance_px * kSubpixelOne) {
            return true;
        }
    }
    return false;
}

Pixel Frame::visible(int px, int py) const {
    Pixel best;
    for (size_t t = 0; t < triangles_.size(); ++t) {
        if (covers(triangles_[t], px, py)) {
            const double depth = depthAt(triangles_[t], px, py);
            if (depth > best.depth) {
                best = {int(t), depth};
            }
        }
    }
    return best;
}

/// One point of a surface.
struct Frame::Point {
    double u = 0, v = 0;
    glm::dvec3 normal{0};
    glm::dvec4 clip_before{0};  ///< x, y, reversed z, w
    int sign = 0;               ///< of the homogeneous weight
};

bool Frame::pointAt(const Triangle& t, double x_px, double y_px, Point& point) const {
    const glm::dvec3 p(x_px / view_.width * 2 - 1, 1 - y_px / view_.height * 2, 1);
    std::array<glm::dvec3, 3> h;
    for (size_t k = 0; k < 3; ++k) {
        h[k] = {t.clip[k].x, t.clip[k].y, t.clip[k].w};
    }
    glm::dvec3 b(glm::dot(glm::cross(h[1], h[2]), p), glm::dot(glm::cross(h[2], h[0]), p),
                 glm::dot(glm::cross(h[0], h[1]), p));
    const double sum = b.x + b.y + b.z;
    if (sum == 0) {
        return false;
    }
    b /= sum;
    point = {};
    point.sign = sum > 0 ? 1 : -1;
    glm::dvec3 position(0), normal(0);
    for (int k = 0; k < 3; ++k) {
        const uint32_t v = t.vertices[size_t(k)];
        const VertexAttributes& a = t.mesh->attributes[v];
        position += b[k] * glm::dvec3(t.mesh->x[v], t.mesh->y[v], t.mesh->z[v]);
        normal += b[k] * glm::dvec3(a.nx, a.ny, a.nz);
        point.u += b[k] * a.u;
        point.v += b[k] * a.v;
    }
    const glm::dmat3 linear(toMatrix(t.instance->transform));
    point.normal = glm::normalize(glm::transpose(glm::inverse(linear)) * normal);
    const glm::dmat4 before = view_.view_projection_before * toMatrix(t.instance->transform_before);
    point.clip_before = before * glm::dvec4(position, 1);
    point.clip_before.z = 0.5 * (point.clip_before.w - point.clip_before.z);
    return true;
}

Attributes Frame::attributes(const Triangle& t, int px, int py, double snap_px) const {
    constexpr double kOffsets[5][2] = {{0, 0}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
    const auto [x_fx8, y_fx8] = sample(px, py);
    const double x_px = double(x_fx8) / kSubpixelOne;
    const double y_px = double(y_fx8) / kSubpixelOne;
    constexpr Range kNone{std::numeric_limits<double>::infinity(),
                          -std::numeric_limits<double>::infinity()};
    Attributes a;
    a.u = a.v = a.motion_x_fx8 = a.motion_y_fx8 = a.depth_before = kNone;
    a.normal = {kNone, kNone, kNone};
    int sign = 0;
    for (const auto& offset : kOffsets) {
        Point p;
        if (!pointAt(t, x_px + offset[0] * snap_px, y_px + offset[1] * snap_px, p) ||
            (sign != 0 && sign != p.sign)) {
            return {};
        }
        sign = p.sign;
        a.u.add(p.u);
        a.v.add(p.v);
        for (int k = 0; k < 3; ++k) {
            a.normal[size_t(k)].add(p.normal[k]);
        }
        if (p.clip_before.w <= 0 || p.clip_before.z > p.clip_before.w) {
            a.behind_before = true;
            continue;
        }
        const double before_x = (p.clip_before.x / p.clip_before.w + 1) * 0.5 * view_.width;
        const double before_y = (1 - p.clip_before.y / p.clip_before.w) * 0.5 * view_.height;
        a.motion_x_fx8.add((before_x - x_px) * kSubpixelOne);
        a.motion_y_fx8.add((before_y - y_px) * kSubpixelOne);
        a.depth_before.add(p.clip_before.z / p.clip_before.w);
    }
    a.bounded = true;
    return a;
}

}  // namespace still::oracle
