// Ear clipping. Sources: G. H. Meisters, "Polygons have ears", 1975; normal of a polygon by
// M. E. Newell (in Sutherland, Sproull, Schumacker, "Ten hidden-surface algorithms", 1974).

#include "engine/internal/obj_polygon.h"

#include <cassert>
#include <cmath>

namespace still {

namespace {

struct Point {
    double x, y;
};

using Corner = std::array<float, 3>;

/// Above this, a polygon that is not convex is cut as a fan: ear clipping takes quadratic time.
constexpr size_t kMaxEarCorners = 4096;

/// Twice the signed area of a, b, c; positive when counter-clockwise.
double turn(Point a, Point b, Point c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Projects along the axis in which the polygon's normal is longest, mirrored where necessary so
/// that the polygon runs counter-clockwise.
std::vector<Point> flatten(std::span<const Corner> corners) {
    std::array<double, 3> normal{};
    for (size_t i = 0; i < corners.size(); ++i) {
        const Corner& a = corners[i];
        const Corner& b = corners[(i + 1) % corners.size()];
        for (size_t k = 0; k < 3; ++k) {
            const size_t u = (k + 1) % 3, v = (k + 2) % 3;
            // Relative to the first corner, so that small faces far away keep their digits.
            const double au = double(a[u]) - corners[0][u], av = double(a[v]) - corners[0][v];
            const double bu = double(b[u]) - corners[0][u], bv = double(b[v]) - corners[0][v];
            normal[k] += au * bv - av * bu;
        }
    }
    size_t axis = 0;
    for (size_t k = 1; k < 3; ++k) {
        axis = std::abs(normal[k]) > std::abs(normal[axis]) ? k : axis;
    }
    const size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    const double mirror = normal[axis] < 0.0 ? -1.0 : 1.0;
    std::vector<Point> points;
    points.reserve(corners.size());
    for (const Corner& c : corners) {
        points.push_back({mirror * (double(c[u]) - corners[0][u]), double(c[v]) - corners[0][v]});
    }
    return points;
}

bool isConvex(const std::vector<Point>& points) {
    const size_t n = points.size();
    for (size_t i = 0; i < n; ++i) {
        const Point a = points[i], b = points[(i + 1) % n], c = points[(i + 2) % n];
        // The second test is for stars: all left turns, yet around more than once.
        if (turn(a, b, c) < 0.0 || turn(points[0], a, b) < 0.0) {
            return false;
        }
    }
    return true;
}

double squaredDistance(const Corner& a, const Corner& b) {
    const double x = double(a[0]) - b[0], y = double(a[1]) - b[1], z = double(a[2]) - b[2];
    return (x * x + y * y) + z * z;
}

/// Whether p is in the closed triangle a, b, c (counter-clockwise).
bool contains(Point a, Point b, Point c, Point p) {
    return turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
}

bool same(Point a, Point b) {
    return a.x == b.x && a.y == b.y;
}

/// What is left of the polygon while ears are cut off.
class EarClipper {
  public:
    explicit EarClipper(const std::vector<Point>& points) : points_(points) {
        for (uint32_t i = 0; i < points.size(); ++i) {
            left_.push_back(i);
        }
    }

    void run(std::vector<std::array<uint32_t, 3>>& triangles) {
        size_t at = 0, misses = 0;
        while (left_.size() > 3) {
            at %= left_.size();
            // After a whole round without an ear (a polygon that crosses itself) any corner does.
            if (misses < left_.size() && !isEar(at)) {
                ++at;
                ++misses;
                continue;
            }
            triangles.push_back(triangleAt(at));
            left_.erase(left_.begin() + ptrdiff_t(at));
            misses = 0;
        }
        triangles.push_back(triangleAt(1));
    }

  private:
    std::array<uint32_t, 3> triangleAt(size_t at) const {
        const size_t n = left_.size();
        return {left_[(at + n - 1) % n], left_[at], left_[(at + 1) % n]};
    }

    bool isEar(size_t at) const {
        const std::array<uint32_t, 3> t = triangleAt(at);
        const Point a = points_[t[0]], b = points_[t[1]], c = points_[t[2]];
        if (turn(a, b, c) <= 0.0) {
            return false;
        }
        const size_t n = left_.size();
        for (size_t i = 0; i < n; ++i) {
            const Point p = points_[left_[i]];
            // Corners at the very same place (bridges to holes) do not block, except by their turn.
            const bool own = same(p, a) || same(p, b) || same(p, c);
            if (!own && contains(a, b, c, p)) {
                return false;
            }
        }
        return true;
    }

    const std::vector<Point>& points_;
    std::vector<uint32_t> left_;
};

void addFan(uint32_t first, size_t count, std::vector<std::array<uint32_t, 3>>& triangles) {
    const uint32_t n = uint32_t(count);
    for (uint32_t i = 1; i + 1 < n; ++i) {
        triangles.push_back({first, (first + i) % n, (first + i + 1) % n});
    }
}

/// The shorter diagonal of a convex quad; the one through the reflex corner of a concave one.
uint32_t quadStart(std::span<const Corner> corners, const std::vector<Point>& p) {
    for (uint32_t i = 0; i < 4; ++i) {
        if (turn(p[(i + 3) % 4], p[i], p[(i + 1) % 4]) < 0.0) {
            return i;
        }
    }
    const double even = squaredDistance(corners[0], corners[2]);
    const double odd = squaredDistance(corners[1], corners[3]);
    return odd < even ? 1 : 0;
}

}  // namespace

void triangulatePolygon(std::span<const std::array<float, 3>> corners,
                        std::vector<std::array<uint32_t, 3>>& triangles) {
    assert(corners.size() >= 3);
    if (corners.size() == 3) {
        triangles.push_back({0, 1, 2});
        return;
    }
    const std::vector<Point> points = flatten(corners);
    if (corners.size() == 4) {
        addFan(quadStart(corners, points), 4, triangles);
    } else if (corners.size() > kMaxEarCorners || isConvex(points)) {
        addFan(0, corners.size(), triangles);
    } else {
        EarClipper(points).run(triangles);
    }
}

}  // namespace still
