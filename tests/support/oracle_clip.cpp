#include "tests/support/oracle_clip.h"

#include <algorithm>
#include <cmath>

#include "rasterizer/fixed.h"

namespace still::oracle {
namespace {

struct ClipVertex {
    glm::dvec4 p;  ///< x, y, reversed z, w
    bool created = false;
};

/// A vertex is inside where dot(plane, p) ≥ 0.
std::array<glm::dvec4, 5> clipPlanes(const FrameView& view) {
    const double guard_x = kGuardPixels * 2 / view.width;
    const double guard_y = kGuardPixels * 2 / view.height;
    return {glm::dvec4(0, 0, -1, 1), glm::dvec4(1, 0, 0, guard_x), glm::dvec4(-1, 0, 0, guard_x),
            glm::dvec4(0, 1, 0, guard_y), glm::dvec4(0, -1, 0, guard_y)};
}

double distance(const glm::dvec4& plane, const glm::dvec4& p) {
    return plane.x * p.x + plane.y * p.y + plane.z * p.z + plane.w * p.w;
}

std::vector<ClipVertex> clipBy(const glm::dvec4& plane, const std::vector<ClipVertex>& in) {
    std::vector<ClipVertex> out;
    for (size_t k = 0; k < in.size(); ++k) {
        const ClipVertex& a = in[k];
        const ClipVertex& b = in[(k + 1) % in.size()];
        const double da = distance(plane, a.p);
        const double db = distance(plane, b.p);
        if (da >= 0) {
            out.push_back(a);
        }
        if ((da >= 0) != (db >= 0)) {
            const double t = da / (da - db);
            out.push_back({a.p + t * (b.p - a.p), true});
        }
    }
    return out;
}

/// The stated order of the fast rasterizer, in float. Precondition: p holds float values.
Corner snapExactly(const glm::dvec4& p, const FrameView& view) {
    const float inverse_w = 1.0f / float(p.w);
    const float x = float(p.x) * inverse_w;
    const float y = -float(p.y) * inverse_w;
    Corner c;
    c.x_fx8 = roundToInt(x * float(128 * view.width)) + 128 * view.width;
    c.y_fx8 = roundToInt(y * float(128 * view.height)) + 128 * view.height;
    c.depth = p.z / p.w;
    return c;
}

Corner snapCreated(const glm::dvec4& p, const FrameView& view) {
    Corner c;
    c.x_fx8 = int64_t(std::floor(p.x / p.w * 128.0 * view.width + 0.5)) + 128 * view.width;
    c.y_fx8 = int64_t(std::floor(-p.y / p.w * 128.0 * view.height + 0.5)) + 128 * view.height;
    c.depth = p.z / p.w;
    c.created = true;
    return c;
}

}  // namespace

void clipAndSnap(Triangle& triangle, const FrameView& view) {
    const std::array<glm::dvec4, 5> planes = clipPlanes(view);
    bool borderline = false;
    for (const glm::dvec4& plane : planes) {
        for (const glm::dvec4& p : triangle.clip) {
            const double size = std::max(std::abs(p.x), plane.w * std::abs(p.w));
            const double d = distance(plane, p);
            triangle.clipped = triangle.clipped || d < 0;
            borderline = borderline || std::abs(d) < 1e-5 * size;
        }
    }
    std::vector<ClipVertex> polygon;
    for (const glm::dvec4& p : triangle.clip) {
        polygon.push_back({p});
    }
    for (const glm::dvec4& plane : planes) {
        polygon = clipBy(plane, polygon);
    }
    // Where double and float may disagree on what is inside, all edges count as created.
    triangle.clipped = triangle.clipped || borderline;
    triangle.polygon.clear();
    for (const ClipVertex& v : polygon) {
        Corner c = v.created ? snapCreated(v.p, view) : snapExactly(v.p, view);
        c.created = c.created || borderline;
        triangle.polygon.push_back(c);
    }
}

}  // namespace still::oracle
