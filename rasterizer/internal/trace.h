#pragma once
// Rays against the trees. Kernels stand in trace-inl.h (Highway) and trace_reference.cpp (the plain
// scalar truth); how a tree is walked is the same for both, trace_walk-inl.h.
//
// A triangle is hit by the watertight test of Woop, Benthin and Wald (2013): no ray passes between
// two triangles that share an edge. Both sides count. Boxes are wider than rounding can matter.

#include <algorithm>
#include <cmath>
#include <utility>

#include "rasterizer/internal/bvh_node.h"
#include "rasterizer/simd.h"

namespace still::internal {

/// Points origin + t · direction, 0 < t ≤ end. The direction need not be of unit length, not 0.
struct Ray {
    float origin[3];
    float end;
    float direction[3];
    uint32_t random;  ///< for stochastic holes
};

constexpr uint32_t kNothingHit = 0xFFFFFFFFu;

/// Of equal t the lowest instance, then the lowest triangle.
struct RayHit {
    float t = 0.0f;
    float b1 = 0.0f, b2 = 0.0f;  ///< weights of the second and third corner
    uint32_t instance = kNothingHit;
    uint32_t triangle = 0;
};

struct TraceKernels {
    /// Whether anything lies in each ray's way: 1 or 0.
    void (*occluded)(const SceneTree& scene, const Ray* rays, int count, uint8_t* blocked);
    /// The same, fast where neighbours in the list begin and end close to one another.
    void (*occludedTogether)(const SceneTree& scene, const Ray* rays, int count, uint8_t* blocked);
    void (*closest)(const SceneTree& scene, const Ray* rays, int count, RayHit* hits);
};

/// Precondition: `target` is one of availableSimdTargets().
TraceKernels traceFor(SimdTarget target);
TraceKernels traceReference();

/// Whether the surface has a hole there: alpha-tested surfaces by the texel of the finest level
/// that the place is in, stochastic ones by the ray's random number.
bool holeAt(const SceneTree& scene, uint32_t instance, uint32_t triangle, float b1, float b2,
            uint32_t random);

// ---- shared by all kernels -------------------------------------------------------------------

constexpr int kTraceStack = 512;
/// Factor on the far end of boxes: three roundings on either side.
constexpr float kFarSlack = 1.0f + 1.0f / (1 << 21);
/// Factor on the end of a ray while candidates for the closest hit are collected.
constexpr float kEndSlack = 1.0f + 1.0f / (1 << 20);
/// Components of directions are taken to be at least this large when they divide.
constexpr float kLeastDirection = 1e-18f;

/// A ray as the tests want it.
struct TraceRay {
    float origin[3];
    float inverse[3];
    /// Where in BvhNode::bounds the near and the far sides of the boxes begin.
    int near_at[3], far_at[3];
    int kx, ky, kz;    ///< axes; kz is the direction's largest
    float sx, sy, sz;  ///< shear

    TraceRay() = default;
    TraceRay(const float o[3], const float d[3]) {
        for (int k = 0; k < 3; ++k) {
            origin[k] = o[k];
            const bool tiny = std::fabs(d[k]) < kLeastDirection;
            inverse[k] = 1.0f / (tiny ? std::copysign(kLeastDirection, d[k]) : d[k]);
            const int high = inverse[k] < 0.0f ? 1 : 0;
            near_at[k] = (high * 3 + k) * kTreeWidth;
            far_at[k] = ((1 - high) * 3 + k) * kTreeWidth;
        }
        const float ax = std::fabs(d[0]), ay = std::fabs(d[1]), az = std::fabs(d[2]);
        kz = ax > ay ? (ax > az ? 0 : 2) : (ay > az ? 1 : 2);
        kx = kz == 2 ? 0 : kz + 1;
        ky = kx == 2 ? 0 : kx + 1;
        sz = 1.0f / d[kz];
        sx = d[kx] * sz;
        sy = d[ky] * sz;
    }
};

/// The ray in an instance's own space; t stays.
inline TraceRay toObject(const InstanceTree& instance, const Ray& ray) {
    const float* m = instance.to_object;
    float o[3], d[3];
    for (int r = 0; r < 3; ++r) {
        o[r] = (m[r * 4] * ray.origin[0] + m[r * 4 + 1] * ray.origin[1]) +
               (m[r * 4 + 2] * ray.origin[2] + m[r * 4 + 3]);
        d[r] = (m[r * 4] * ray.direction[0] + m[r * 4 + 1] * ray.direction[1]) +
               m[r * 4 + 2] * ray.direction[2];
    }
    return TraceRay(o, d);
}

/// What the test of a block knows of each triangle.
struct alignas(32) BlockHits {
    float t[kTreeWidth], b1[kTreeWidth], b2[kTreeWidth];
};

}  // namespace still::internal
