#pragma once
// Sutherland–Hodgman clipping (1974) in homogeneous space, for the few triangles that cross the
// near plane or leave the guard band.

#include "rasterizer/internal/vertex_reference.h"

namespace still::internal {

/// In double: an edge may run from 0.1 to 10,000 in front of the eye, and in float its corner on
/// the near plane would be tens of pixels off the line.
struct ClippedVertex {
    double x, y, z, w;
    double b[3];  ///< barycentric coordinates in the source triangle
    int source;   ///< the corner of the source triangle that it is, −1 when clipping made it
};

/// A triangle cut by five planes has at most eight corners.
constexpr int kMaxClippedCorners = 8;

/// Clips against the near plane and the four guard planes |x|, |y| ≤ guard · w. Returns the number
/// of corners, 0 when nothing is left. New corners are interpolated from the inside towards the
/// outside, so that two triangles that share an edge get the same corner.
int clipTriangle(const ClipVertex corners[3], double guard_x, double guard_y,
                 ClippedVertex out[kMaxClippedCorners]);

}  // namespace still::internal
