#pragma once
// The scalar truth of a surface point: barycentrics, interpolated attributes, position and frame in
// the world. Steps are the same, in the same order, as in surface-inl.h.

#include <algorithm>
#include <cmath>

#include "rasterizer/fixed.h"
#include "rasterizer/internal/kernels.h"
#include "rasterizer/internal/shading_constants.h"

namespace still::internal {

struct Float3 {
    float x, y, z;
};

/// The larger and the smaller one as the SIMD kernels choose it: of what is not a number, `b`.
inline float larger(float a, float b) {
    return a > b ? a : b;
}
inline float smaller(float a, float b) {
    return a < b ? a : b;
}

/// Linear light as planes hold it; 0 for what is not a number.
inline uint16_t toFx12(float linear) {
    return uint16_t(roundToInt(smaller(larger(linear, 0.0f), kColourMax) * kColourScale));
}

inline float dot(const Float3& a, const Float3& b) {
    return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

inline Float3 scale(const Float3& a, float s) {
    return {a.x * s, a.y * s, a.z * s};
}

inline Float3 normalized(const Float3& a) {
    return scale(a, 1.0f / std::sqrt(larger(dot(a, a), kTiny)));
}

inline Float3 cross(const Float3& a, const Float3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Perspective-correct barycentrics of a pixel and what texture sampling derives from them.
struct PixelBarycentrics {
    float b[3];
    float w;  ///< of the surface point (1 / Σ p)
    const ShadeTriangle* triangle;
};

inline PixelBarycentrics barycentricsAt(const ShadeTriangle& t, int x, int y) {
    PixelBarycentrics p;
    const float rx = float(x) - t.anchor_x, ry = float(y) - t.anchor_y;
    for (int k = 0; k < 3; ++k) {
        p.b[k] = larger((t.p[k] + t.p_dy[k] * ry) + t.p_dx[k] * rx, 0.0f);
    }
    p.w = 1.0f / larger((p.b[0] + p.b[1]) + p.b[2], kTiny);
    for (float& b : p.b) {
        b = b * p.w;
    }
    p.triangle = &t;
    return p;
}

inline float interpolate(const PixelBarycentrics& p, float f0, float f1, float f2) {
    return (p.b[0] * f0 + p.b[1] * f1) + p.b[2] * f2;
}

/// Field `field` of an interleaved per-vertex array.
inline float attribute(const PixelBarycentrics& p, const float* base, int stride, int field) {
    const int32_t* v = p.triangle->vertex;
    return interpolate(p, base[v[0] * stride + field], base[v[1] * stride + field],
                       base[v[2] * stride + field]);
}

inline Float3 rotate(const float m[9], const Float3& v) {
    return {(m[0] * v.x + m[1] * v.y) + m[2] * v.z, (m[3] * v.x + m[4] * v.y) + m[5] * v.z,
            (m[6] * v.x + m[7] * v.y) + m[8] * v.z};
}

inline Float3 transformPoint(const Affine& m, const Float3& p) {
    return {(m[0] * p.x + m[1] * p.y) + (m[2] * p.z + m[3]),
            (m[4] * p.x + m[5] * p.y) + (m[6] * p.z + m[7]),
            (m[8] * p.x + m[9] * p.y) + (m[10] * p.z + m[11])};
}

inline Float3 objectPosition(const PixelBarycentrics& p, const Surface& s) {
    return {attribute(p, s.x, 1, 0), attribute(p, s.y, 1, 0), attribute(p, s.z, 1, 0)};
}

inline Float3 worldTangent(const PixelBarycentrics& p, const Surface& s,
                           const InstanceSetup& instance) {
    Float3 t{attribute(p, s.tangents, kTangentStride, 0),
             attribute(p, s.tangents, kTangentStride, 1),
             attribute(p, s.tangents, kTangentStride, 2)};
    if (!instance.identity) {
        const Affine& m = instance.world;
        t = {(m[0] * t.x + m[1] * t.y) + m[2] * t.z, (m[4] * t.x + m[5] * t.y) + m[6] * t.z,
             (m[8] * t.x + m[9] * t.y) + m[10] * t.z};
    }
    return normalized(t);
}

/// Unit length, on the side that the mesh says is outside.
inline Float3 worldNormal(const PixelBarycentrics& p, const Surface& s,
                          const InstanceSetup& instance) {
    Float3 n{attribute(p, s.attributes, kAttributeStride, 0),
             attribute(p, s.attributes, kAttributeStride, 1),
             attribute(p, s.attributes, kAttributeStride, 2)};
    if (!instance.identity) {
        n = rotate(instance.normal, n);
    }
    return normalized(n);
}

/// Along +v, from the world's normal `n` and tangent `t`. A mirroring turns the frame's hand.
inline Float3 worldBitangent(const PixelBarycentrics& p, const Surface& s,
                             const InstanceSetup& instance, const Float3& n, const Float3& t) {
    const float handedness = s.tangents[p.triangle->vertex[0] * kTangentStride + 3];
    return scale(cross(n, t), instance.mirrored ? -handedness : handedness);
}

inline Float3 worldPosition(const PixelBarycentrics& p, const Surface& s,
                            const InstanceSetup& instance) {
    const Float3 position = objectPosition(p, s);
    return instance.identity ? position : transformPoint(instance.world, position);
}

/// Unit vector from a world position to the eye.
inline Float3 towardsEye(const FrameView& view, const Float3& position) {
    return normalized({view.eye.x - position.x, view.eye.y - position.y, view.eye.z - position.z});
}

}  // namespace still::internal
