#pragma once
// One vertex through the vertex stage: the truth for the vertex kernel, and the clipper's
// projection.

#include "rasterizer/internal/kernels.h"

namespace still::internal {

struct ClipVertex {
    float x, y, z, w;  ///< z reversed
};

struct ScreenVertex {
    int32_t x_fx8, y_fx8;
    float z, inv_w;
    uint8_t outcode;
};

ClipVertex transformVertex(const MatrixF& clip, float x, float y, float z);
ScreenVertex projectVertex(const VertexJob& job, const ClipVertex& v);

}  // namespace still::internal
