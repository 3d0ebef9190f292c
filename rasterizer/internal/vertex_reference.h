#pragma once
// One vertex through the vertex stage: the truth for the vertex kernel, and the clipper's
// projection.

#include "rasterizer/internal/geometry.h"

namespace still::internal {

struct ClipVertex {
    float x, y, z, w;  ///< z reversed
};

ClipVertex transformVertex(const MatrixF& clip, float x, float y, float z);
ScreenVertex projectVertex(const VertexJob& job, const ClipVertex& v);

/// The kernels of GeometryKernels.
void transformVerticesReference(const VertexJob& job, int begin, int end);
PositionBox boundVerticesReference(const float* x, const float* y, const float* z, size_t count);

}  // namespace still::internal
