#pragma once
// Constants and arithmetic of the spatial filter, shared by the scalar and the SIMD kernels.

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "rasterizer/fixed.h"
#include "rasterizer/gbuffer.h"

namespace still::spatial {

/// Bits of the edge plane: the pixel's surface ends towards its right (lower) neighbour.
constexpr uint8_t kEdgeRight = 1;
constexpr uint8_t kEdgeBelow = 2;

/// Along an edge the filter looks this far to either side for its ends, in pixels.
constexpr int kSearch = 32;

/// Normals on the octahedron |x| + |y| + |z| = 32767: where they are farther apart than this
/// (summed over the axes) a surface may have a crease.
constexpr int kCrease = 4915;

/// It has one if the steps before and after are this many times smaller: bumps of a normal map are
/// no creases.
constexpr int kCreaseRatio = 4;

struct OctahedralNormal {
    int x, y, z;
};

constexpr OctahedralNormal unpackNormal(uint32_t packed) {
    int x = int16_t(packed);
    int y = int16_t(packed >> 16);
    const int z = 32767 - (x < 0 ? -x : x) - (y < 0 ? -y : y);
    const int fold = z < 0 ? -z : 0;
    x += x < 0 ? fold : -fold;
    y += y < 0 ? fold : -fold;
    return {x, y, z};
}

inline int normalDistance(uint32_t normal_a, uint32_t normal_b) {
    if (normal_a == normal_b) {
        return 0;
    }
    const OctahedralNormal a = unpackNormal(normal_a);
    const OctahedralNormal b = unpackNormal(normal_b);
    return std::abs(a.x - b.x) + std::abs(a.y - b.y) + std::abs(a.z - b.z);
}

/// Weights of the neighbours before and after on one axis, the centre has the rest.
struct Taps {
    int before_q14, after_q14;
};

/// The mean over a pixel from three samples that lie `jitter_fx8` from the pixels' centres: the
/// parabola through them, (d² ∓ d)/2 with d = −jitter, and its box mean. That adds 1/24 for a
/// picture without any detail finer than the samples; textures have some, and 1/16 is what suits
/// them (checker: +0.9 dB).
constexpr Taps pixelTaps(int jitter_fx8) {
    constexpr int kSixteenth_q14 = 1 << 10;
    const int d = -jitter_fx8;
    // d² / 2 in q14 is d² / 8; d / 2 is 32 d.
    const int curve = roundShift(d * d, 3) + kSixteenth_q14;
    return {curve - 32 * d, curve + 32 * d};
}

constexpr int threeTaps(int before, int centre, int after, Taps taps) {
    return centre +
           roundShift((before - centre) * taps.before_q14 + (after - centre) * taps.after_q14, 14);
}

/// Mean over the pixel from a 3×3 window, row by row, held within the plus-shaped neighbourhood:
/// parabolas overshoot.
inline int pixelMean(const int (&window)[9], Taps across, Taps down) {
    const int above = threeTaps(window[0], window[1], window[2], across);
    const int here = threeTaps(window[3], window[4], window[5], across);
    const int below = threeTaps(window[6], window[7], window[8], across);
    const int low = std::min({window[1], window[3], window[4], window[5], window[7]});
    const int high = std::max({window[1], window[3], window[4], window[5], window[7]});
    return std::clamp(threeTaps(above, here, below, down), low, high);
}

}  // namespace still::spatial
