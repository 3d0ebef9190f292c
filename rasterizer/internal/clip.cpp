#include "rasterizer/internal/clip.h"

#include <cstring>

namespace still::internal {

namespace {

enum Plane { kNear, kLeft, kRight, kBottom, kTop, kPlanes };

/// ≥ 0 inside.
float distance(const ClipVertex& v, Plane plane, float guard_x, float guard_y) {
    switch (plane) {
        case kNear:
            return v.w - v.z;
        case kLeft:
            return guard_x * v.w + v.x;
        case kRight:
            return guard_x * v.w - v.x;
        case kBottom:
            return guard_y * v.w + v.y;
        default:
            return guard_y * v.w - v.y;
    }
}

float lerp(float in, float out, float t) {
    return in + (out - in) * t;
}

ClippedVertex between(const ClippedVertex& in, const ClippedVertex& out, float t) {
    ClippedVertex r;
    r.position = {lerp(in.position.x, out.position.x, t), lerp(in.position.y, out.position.y, t),
                  lerp(in.position.z, out.position.z, t), lerp(in.position.w, out.position.w, t)};
    for (int k = 0; k < 3; ++k) {
        r.b[k] = lerp(in.b[k], out.b[k], t);
    }
    return r;
}

}  // namespace

int clipTriangle(const ClipVertex corners[3], float guard_x, float guard_y,
                 ClippedVertex out[kMaxClippedCorners]) {
    ClippedVertex polygon[kMaxClippedCorners];
    int count = 3;
    for (int k = 0; k < 3; ++k) {
        out[k].position = corners[k];
        for (int j = 0; j < 3; ++j) {
            out[k].b[j] = j == k ? 1.0f : 0.0f;
        }
    }
    for (int plane = 0; plane < kPlanes && count >= 3; ++plane) {
        std::memcpy(polygon, out, sizeof(polygon));
        int kept = 0;
        for (int k = 0; k < count; ++k) {
            const ClippedVertex& a = polygon[k];
            const ClippedVertex& b = polygon[k + 1 == count ? 0 : k + 1];
            const float da = distance(a.position, Plane(plane), guard_x, guard_y);
            const float db = distance(b.position, Plane(plane), guard_x, guard_y);
            if (da >= 0.0f) {
                out[kept++] = a;
            }
            if ((da >= 0.0f) != (db >= 0.0f)) {
                out[kept++] =
                    da >= 0.0f ? between(a, b, da / (da - db)) : between(b, a, db / (db - da));
            }
        }
        count = kept;
    }
    return count >= 3 ? count : 0;
}

}  // namespace still::internal
