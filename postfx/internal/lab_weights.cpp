#include "postfx/internal/lab_weights.h"

#include <algorithm>
#include <numeric>

#include "rasterizer/fixed.h"

namespace still::lab {
namespace {

// Numbers are in 2^-30 unless the name says otherwise.
constexpr int64_t kOne = int64_t{1} << 30;
constexpr int64_t kPi = 3373259426;

constexpr int64_t times(int64_t a, int64_t b) {
    return roundShift(a * b, 30);
}

/// sin(x) for 0 ≤ x ≤ π/2, by its series.
constexpr int64_t sine(int64_t x) {
    const int64_t square = times(x, x);
    int64_t series = kOne;
    for (const int k : {13 * 12, 11 * 10, 9 * 8, 7 * 6, 5 * 4, 3 * 2}) {
        series = kOne - times(square, series) / k;
    }
    return times(x, series);
}

/// sin(πt) / (πt) for 0 ≤ t < 2, t in 1/512.
constexpr int64_t sinc(int t_fx9) {
    if (t_fx9 == 0) {
        return kOne;
    }
    const int folded = t_fx9 % 512 <= 256 ? t_fx9 % 512 : 512 - t_fx9 % 512;
    const int64_t height = sine(kPi * folded / 512);
    return (t_fx9 < 512 ? height : -height) * kOne / (kPi * t_fx9 / 512);
}

/// exp(−x), 0 ≤ x < 8: the series of x/64, then squared six times.
constexpr int64_t decay(int64_t x) {
    int64_t result = kOne;
    for (int k = 6; k >= 1; --k) {
        result = kOne - times(x / 64, result) / k;
    }
    for (int i = 0; i < 6; ++i) {
        result = times(result, result);
    }
    return result;
}

/// Harris' four terms over a radius of 1.65 pixels.
constexpr int64_t blackmanHarris(int x_fx8) {
    const int64_t half_angle = kPi * x_fx8 * 100 / (2 * 165 * 256);
    const int64_t s = sine(half_angle);
    const int64_t c = kOne - 2 * times(s, s);  // cos(πx / 1.65)
    const int64_t c2 = 2 * times(c, c) - kOne;
    const int64_t c3 = times(c, 2 * c2 - kOne);
    return (35875 * kOne + 48829 * c + 14128 * c2 + 1168 * c3) / 100000;
}

/// a3·x³ + a2·x² + a1·x + a0, in 2^-24.
constexpr int64_t cubic(int x_fx8, int a3, int a2, int a1, int a0) {
    const int64_t x = x_fx8;
    return a3 * x * x * x + a2 * x * x * 256 + a1 * x * 65536 + int64_t{a0} * 65536 * 256;
}

/// The filter's value at a distance of 0 … 1.5 pixels, times any constant.
constexpr int64_t kernelAt(SampleFilter filter, int x_fx8) {
    const bool inner = x_fx8 < 256;
    switch (filter) {
        case SampleFilter::box:
            return x_fx8 <= 128 ? kOne : 0;
        case SampleFilter::triangle:
            return std::max(256 - x_fx8, 0);
        case SampleFilter::gaussian:
            return decay(2458868777 * x_fx8 * x_fx8 / 65536);  // 2.29
        case SampleFilter::blackman_harris:
            return blackmanHarris(x_fx8);
        case SampleFilter::mitchell:
            return inner ? cubic(x_fx8, 21, -36, 0, 16) : cubic(x_fx8, -7, 36, -60, 32);
        case SampleFilter::catmull_rom:
            return inner ? cubic(x_fx8, 3, -5, 0, 2) : cubic(x_fx8, -1, 5, -8, 4);
        case SampleFilter::b_spline:
            return inner ? cubic(x_fx8, 3, -6, 0, 4) : cubic(x_fx8, -1, 6, -12, 8);
        case SampleFilter::lanczos2:
            return times(sinc(2 * x_fx8), sinc(x_fx8));
    }
    return 0;
}

/// Of the samples left of, at and right of the centre; their sum is 2^20.
std::array<int64_t, 3> axisWeights(SampleFilter filter, int jitter_fx8) {
    std::array<int64_t, 3> w{};
    for (int i = 0; i < 3; ++i) {
        const int x = 256 * (i - 1) + jitter_fx8;
        w[size_t(i)] = kernelAt(filter, x < 0 ? -x : x);
    }
    const int64_t sum = w[0] + w[1] + w[2];
    w[0] = floorDiv(2 * (w[0] << 20) + sum, 2 * sum);
    w[2] = floorDiv(2 * (w[2] << 20) + sum, 2 * sum);
    w[1] = (1 << 20) - w[0] - w[2];
    return w;
}

}  // namespace

std::array<int32_t, 9> sampleWeights(SampleFilter filter, int jitter_x_fx8, int jitter_y_fx8) {
    if (filter == SampleFilter::box) {
        return {0, 0, 0, 0, 4096, 0, 0, 0, 0};
    }
    const auto x = axisWeights(filter, jitter_x_fx8), y = axisWeights(filter, jitter_y_fx8);
    std::array<int32_t, 9> weights{};
    for (size_t k = 0; k < 9; ++k) {
        weights[k] = int32_t(roundShift(x[k % 3] * y[k / 3], 28));
    }
    weights[4] += 4096 - std::accumulate(weights.begin(), weights.end(), 0);
    return weights;
}

}  // namespace still::lab
