#include "rasterizer/internal/clip.h"

#include <cstring>

namespace still::internal {

namespace {

enum Plane { kNear, kLeft, kRight, kBottom, kTop, kPlanes };

/// ≥ 0 inside.
double distance(const ClippedVertex& v, Plane plane, double guard_x, double guard_y) {
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

double lerp(double in, double out, double t) {
    return in + (out - in) * t;
}

ClippedVertex between(const ClippedVertex& in, const ClippedVertex& out, double t) {
    ClippedVertex r{lerp(in.x, out.x, t),
                    lerp(in.y, out.y, t),
                    lerp(in.z, out.z, t),
                    lerp(in.w, out.w, t),
                    {},
                    -1};
    for (int k = 0; k < 3; ++k) {
        r.b[k] = lerp(in.b[k], out.b[k], t);
    }
    return r;
}

}  // namespace

int clipTriangle(const ClipVertex corners[3], double guard_x, double guard_y,
                 ClippedVertex out[kMaxClippedCorners]) {
    ClippedVertex polygon[kMaxClippedCorners];
    int count = 3;
    for (int k = 0; k < 3; ++k) {
        const ClipVertex& c = corners[k];
        out[k] = {c.x, c.y, c.z, c.w, {k == 0 ? 1.0 : 0.0, k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0},
                  k};
    }
    for (int plane = 0; plane < kPlanes && count >= 3; ++plane) {
        std::memcpy(polygon, out, sizeof(polygon));
        int kept = 0;
        for (int k = 0; k < count; ++k) {
            const ClippedVertex& a = polygon[k];
            const ClippedVertex& b = polygon[k + 1 == count ? 0 : k + 1];
            const double da = distance(a, Plane(plane), guard_x, guard_y);
            const double db = distance(b, Plane(plane), guard_x, guard_y);
            if (da >= 0.0) {
                out[kept++] = a;
            }
            if ((da >= 0.0) != (db >= 0.0)) {
                out[kept++] =
                    da >= 0.0 ? between(a, b, da / (da - db)) : between(b, a, db / (db - da));
            }
        }
        count = kept;
    }
    return count >= 3 ? count : 0;
}

}  // namespace still::internal
