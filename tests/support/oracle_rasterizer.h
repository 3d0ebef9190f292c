#pragma once
// The slow rasterizer the fast one is checked against. Every pixel is tried against every triangle:
// no tiles, no increments, no SIMD. Coverage is exact in int64 on the same snapped vertices; the
// rest is double, solved straight from the clip positions.
//
//   float clip positions ─► snap (float, the stated order) ─► int64 edge functions ─► covered
//          │                        └─► depth, affine in screen space (double)
//          └─► homogeneous barycentrics (double) ─► u, v, normal, position, motion
//
// Source of the homogeneous barycentrics: Olano, Greer, "Triangle Scan Conversion using 2D
// Homogeneous Coordinates", 1997.

#include <array>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "rasterizer/draw_list.h"

namespace still::oracle {

/// Vertices farther than this from the viewport's centre are clipped (in pixels, each axis).
constexpr double kGuardPixels = 16384.0;

/// A corner of what is filled, in 1/256 pixel from the top left of the target.
struct Corner {
    int64_t x_fx8 = 0, y_fx8 = 0;
    double depth = 0;      ///< reversed Z / w
    bool created = false;  ///< by clipping
};

/// One submitted triangle and what is known about it.
struct Triangle {
    uint16_t surface = 0;
    const Mesh* mesh = nullptr;
    const Instance* instance = nullptr;
    std::array<uint32_t, 3> vertices{};
    std::array<glm::dvec4, 3> clip{};  ///< x, y, reversed z, w: the float values, exactly
    bool clipped = false;              ///< went through the clipper, or nearly
    std::vector<Corner> polygon;       ///< empty when nothing is left of it
};

/// Closed range.
struct Range {
    double min = 0, max = 0;
    void add(double v);
    bool holds(double v, double slack) const { return v >= min - slack && v <= max + slack; }
};

/// What is seen at a sample. Ranges cover every answer that vertices snapped within ±`snap_px` of
/// their place could give; a point in the middle is the exact answer.
struct Attributes {
    bool bounded = false;  ///< false: the surface is seen edge-on here, nothing can be said
    Range u, v;
    std::array<Range, 3> normal;       ///< world, of unit length
    Range motion_x_fx8, motion_y_fx8;  ///< previous minus current position
    Range depth_before;                ///< reversed Z in the previous frame
    bool behind_before = false;        ///< at least partly behind the previous camera
};

/// Visible triangle per pixel. `triangle` is −1 for background.
struct Pixel {
    int triangle = -1;
    double depth = 0;
};

class Frame {
  public:
    /// `list` and `view` must outlive the frame.
    Frame(const DrawList& list, const FrameView& view);

    const std::vector<Triangle>& triangles() const { return triangles_; }
    /// Brute force over all triangles; first submitted wins at equal depth.
    Pixel visible(int px, int py) const;
    /// Top-left rule on the snapped polygon.
    bool covers(const Triangle& triangle, int px, int py) const;
    /// Depth of the polygon's plane at the sample. Precondition: covers().
    double depthAt(const Triangle& triangle, int px, int py) const;
    /// How fast the depth changes, per pixel in x and y together; of the steepest piece.
    double depthSlope(const Triangle& triangle) const;
    /// True when the sample lies within `distance_px` of an edge that ends in a created corner.
    bool nearCreatedEdge(const Triangle& triangle, int px, int py, double distance_px) const;
    Attributes attributes(const Triangle& triangle, int px, int py, double snap_px) const;

  private:
    struct Point;
    bool pointAt(const Triangle& triangle, double x_px, double y_px, Point& point) const;
    void addInstance(const Instance& instance);
    std::array<int64_t, 2> sample(int px, int py) const;

    const DrawList& list_;
    const FrameView& view_;
    std::vector<Triangle> triangles_;
};

}  // namespace still::oracle
