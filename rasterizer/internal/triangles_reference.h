#pragma once
// The plain scalar truth of the triangle stage.

#include "rasterizer/internal/geometry.h"

namespace still::internal {

/// GeometryKernels::cullTriangles.
void cullTrianglesReference(const TriangleJob& job, TriangleBatch& batch);

/// The outcode of a vertex, also of one that has a position; those of the frustum's sides are
/// taken from the snapped position then. A pixel of margin covers the difference.
int outcodeOf(const ScreenVertex& v, int width, int height);

}  // namespace still::internal
