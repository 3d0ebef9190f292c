#pragma once
// One row of one channel. The scalar twin, sharpen_reference.cpp, defines the result.

#include <algorithm>
#include <cstdint>

#include "rasterizer/fixed.h"
#include "rasterizer/simd.h"

namespace still::sharpening {

/// Three rows of a channel (the middle one is sharpened) and the row of confidence or null. May be
/// read one pixel to the left, and a row's padding to the right.
struct Rows {
    const uint16_t *above, *here, *below;
    const uint8_t* confidence;
};

/// With weights −w for each neighbour, (e − w Σ) / (1 − 4 w) = e + g (4 e − Σ), g = w / (1 − 4 w):
/// 3/4 for w = 3/16. The gain is proportional to sharpness and to confidence.
constexpr int kGainBits = 12;
constexpr int fullGain(int sharpness_q15) {
    return roundShift(sharpness_q15 * 3, 2 + 15 - kGainBits);
}

/// gain · confidence / 255, rounded; 255 keeps it.
constexpr int confidentGain(int gain, int confidence) {
    return roundShift(gain * confidence * 257, 16);
}

constexpr int sharpened(int e, int above, int left, int right, int below, int gain) {
    const int moved = e + roundShift((4 * e - above - left - right - below) * gain, kGainBits);
    return std::clamp(moved, std::min({e, above, left, right, below}),
                      std::max({e, above, left, right, below}));
}

/// Writes `width` pixels, and may write into the padding after them. The first and the last one may
/// be wrong: their neighbours outside are whatever stands there.
using RowKernel = void (*)(const Rows& rows, int width, int gain, uint16_t* out);

RowKernel rowKernel(SimdTarget target);
void sharpenRowReference(const Rows& rows, int width, int gain, uint16_t* out);

}  // namespace still::sharpening
