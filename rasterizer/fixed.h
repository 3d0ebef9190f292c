#pragma once
// The one place where rounding is decided. The rule everywhere in Stillframe, for integers and for
// floats, positive and negative: to the nearest, ties towards plus infinity ("round half up").
//   roundShift(-3, 1) == -1    roundShift(3, 1) == 2    roundToInt(-2.5f) == -2

#include <bit>
#include <cfloat>
#include <cmath>
#include <cstdint>

// Excess precision (x87) would make every float differ from the SIMD kernels.
static_assert(FLT_EVAL_METHOD == 0, "Stillframe needs IEEE floats without excess precision");

namespace still {

/// Vertices are snapped to 1/256 pixel (suffix _fx8).
constexpr int kSubpixelBits = 8;
constexpr int32_t kSubpixelOne = 1 << kSubpixelBits;
constexpr int32_t kSubpixelHalf = kSubpixelOne / 2;

/// Linear light 1.0 in the 16-bit colour planes (suffix _fx12): range 0 … 15.9998.
constexpr int kColourBits = 12;
constexpr int32_t kColourOne = 1 << kColourBits;

/// value / 2^shift, to nearest, ties up; shift ≥ 1. Right shifts of negatives are arithmetic
/// (C++20 [expr.shift]), so this is floor(value / 2^shift + 1/2).
template <class I>
constexpr I roundShift(I value, int shift) {
    return I((value + (I(1) << (shift - 1))) >> shift);
}

/// floor(a / b) for b > 0.
template <class I>
constexpr I floorDiv(I a, I b) {
    return a >= 0 ? a / b : -((-a + b - 1) / b);
}

/// floor(v + 0.5), the sum rounded to float as SIMD does it. Precondition: |v| < 2^30.
inline int32_t roundToInt(float v) {
    return int32_t(std::floor(v + 0.5f));
}

/// Depth planes hold the bits of a reversed-Z float in [0, 1] (1 = near plane, 0 = infinitely far
/// or nothing): as integers they sort like the floats. logDepth16 keeps the exponent and 11 bits of
/// mantissa, so that a difference of 1 is a relative difference between 1/4096 and 1/2048 at any
/// distance. 65535 = near plane; depths under 2^-32 become 0.
constexpr uint16_t logDepth16(uint32_t depth_bits) {
    constexpr int32_t kTop = int32_t(0x3F800000u >> 12) - 65535;
    const int32_t v = int32_t(depth_bits >> 12) - kTop;
    return uint16_t(v < 0 ? 0 : (v > 65535 ? 65535 : v));
}

}  // namespace still
