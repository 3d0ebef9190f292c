// Object space → snapped screen position. Every operation rounds once, in the order written here;
// vertex-inl.h repeats it lane by lane.

#include "rasterizer/internal/vertex_reference.h"

#include <algorithm>
#include <cmath>

#include "rasterizer/fixed.h"

namespace still::internal {

namespace {

float row(const float m[4], float x, float y, float z) {
    return (m[0] * x + m[1] * y) + (m[2] * z + m[3]);
}

bool finite(float v) {
    return v - v == 0.0f;
}

}  // namespace

ClipVertex transformVertex(const MatrixF& clip, float x, float y, float z) {
    return {row(clip.m[0], x, y, z), row(clip.m[1], x, y, z), row(clip.m[2], x, y, z),
            row(clip.m[3], x, y, z)};
}

ScreenVertex projectVertex(const VertexJob& job, const ClipVertex& v) {
    const auto nowhere = [](int outcode) { return ScreenVertex{kNoPosition, outcode, 0.0f, 0.0f}; };
    if (!(finite(v.x) && finite(v.y) && finite(v.z) && finite(v.w))) {
        return nowhere(kOutInvalid);
    }
    const float fx = job.frustum_x * v.w;
    const float fy = job.frustum_y * v.w;
    const bool near_ok = v.z <= v.w && v.w > 1e-20f;
    int code = near_ok ? 0 : kOutNear;
    code |= v.x < -fx ? kOutLeft : 0;
    code |= v.x > fx ? kOutRight : 0;
    code |= v.y > fy ? kOutTop : 0;
    code |= v.y < -fy ? kOutBottom : 0;
    code |= v.z < 0.0f ? kOutFar : 0;
    if (!near_ok) {
        return nowhere(code);
    }
    const float r = 1.0f / v.w;
    const float sx = (v.x * r) * job.scale_x_fx8;
    const float sy = (v.y * r) * job.scale_y_fx8;
    if (!(std::fabs(sx) <= job.guard_fx8 && std::fabs(sy) <= job.guard_fx8)) {
        return nowhere(code | kOutGuard);
    }
    return {roundToInt(sx) + job.centre_x_fx8, roundToInt(sy) + job.centre_y_fx8, v.z * r, r};
}

void transformVerticesReference(const VertexJob& job, int begin, int end) {
    for (int i = begin; i < end; ++i) {
        job.out[i] = projectVertex(job, transformVertex(job.clip, job.x[i], job.y[i], job.z[i]));
    }
}

PositionBox boundVerticesReference(const float* x, const float* y, const float* z, size_t count) {
    PositionBox box;
    const float* const axes[3] = {x, y, z};
    for (int axis = 0; axis < 3; ++axis) {
        const auto [low, high] = std::minmax_element(axes[axis], axes[axis] + count);
        box.low[axis] = *low;
        box.high[axis] = *high;
    }
    return box;
}

}  // namespace still::internal
