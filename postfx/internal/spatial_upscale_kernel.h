#pragma once
// One row of an enlarged picture. The scalar twin, spatial_upscale_reference.cpp, defines the
// result; all operations are IEEE, in the order written there.

#include <algorithm>
#include <cstdint>

#include "rasterizer/simd.h"

namespace still::enlarging {

/// Rows of the input: the two above the output pixels' centres and the two below; columns beyond
/// its ends hold the outermost pixel: two on the left, the first of them at index 0, and padding on
/// the right.
constexpr int kBorder = 2;
struct Row {
    const float* root[3][4] = {};     ///< square roots of linear light, 1.0 = 64
    const float* brightness[4] = {};  ///< of the roots; EnlargeFilter::edge only
    const int32_t* column = nullptr;  ///< of each output pixel: index of the leftmost of 4 columns
    const float* part_x = nullptr;    ///< and how far it lies from the second to the third, 0 … 1
    float part_y = 0;
    int width = 0;  ///< of the output
    uint16_t* out[3] = {};
};

/// Brightness that edges are looked for in, of roots.
constexpr float brightnessOf(float red, float green, float blue) {
    return (red + blue) * 0.5f + green;
}

/// Weights of the four samples around a place `t` of the way from the second to the third:
/// Catmull-Rom.
template <class T>
struct Weights4 {
    T w[4];
};
constexpr Weights4<float> catmullRom(float t) {
    return {{((-0.5f * t + 1.0f) * t - 0.5f) * t, (1.5f * t - 2.5f) * t * t + 1.0f,
             ((-1.5f * t + 2.0f) * t + 0.5f) * t, (0.5f * t - 0.5f) * t * t}};
}

/// The twelve taps of `edge` (rows and columns of the 4×4 window, its corners left out), and of the
/// four middle ones the place.
struct Tap {
    int row, column;
};
constexpr Tap kTaps[12] = {{0, 1}, {0, 2}, {1, 0}, {1, 1}, {1, 2}, {1, 3},
                           {2, 0}, {2, 1}, {2, 2}, {2, 3}, {3, 1}, {3, 2}};

/// Below this an edge has no direction.
constexpr float kNoEdge = 1.0f / 32768;

/// May write the output's padding.
struct RowKernels {
    void (*bicubic)(const Row& row);
    void (*edge)(const Row& row);
};
RowKernels rowKernels(SimdTarget target);
RowKernels referenceKernels();

}  // namespace still::enlarging
