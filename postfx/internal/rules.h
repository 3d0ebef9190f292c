#pragma once
// The resolve's arithmetic, one pixel at a time, in integers. The scalar kernel is built from these
// and the SIMD kernels must give the same numbers. How the constants were found: postfx/README.md.

#include <cstdint>

#include "rasterizer/fixed.h"

namespace still::taa {

/// Stored depth may differ from the expected one by this much (1 = 1/4096 … 1/2048 relative) …
constexpr int kDepthTolerance = 32;
/// … plus this multiple of the surface's own step towards its nearest neighbour: one for the
/// jitter, one for the fraction of the motion, one for an owner that sits at its surface's rim.
constexpr int kSlopeFactor = 3;

/// Bilinear weights sum to 65536. History is taken when at least half of it is trusted.
constexpr uint32_t kFullWeight = 65536;
constexpr uint32_t kMinWeight = 32768;

/// Samples that history may stand for when its validity is only likely.
constexpr int kSuspectCount = 6;

/// The same where a window shows two surfaces that move apart by at least kApart (1/256 pixel, both
/// axes together): part of what the owner's motion brings along belongs to the other surface.
constexpr int kEdgeCount = 4;
constexpr int kApart = 64;

/// Trusted pixels that a 3×3 window needs, and the samples that its mean stands for.
constexpr int kWindowTaps = 5;
constexpr int kWindowCount = 1;

/// Resampled history carries this many fraction bits below fx12.
constexpr int kFractionBits = 8;

/// One channel of a pixel: see HistoryPointers.
struct Sum {
    int mean = 0, rest = 0;
};

/// Adds one sample to a mean of `count` ≥ 0 samples. Exact: nothing is ever lost.
constexpr Sum addSample(Sum sum, int count, int sample) {
    const int grown = count + 1;
    const int excess = sum.rest + sample - sum.mean;
    const int step = floorDiv(excess + grown / 2, grown);
    return {sum.mean + step, excess - step * grown};
}

/// A resampled value with kFractionBits, standing for `count` samples.
constexpr Sum sumOf(int value, int count) {
    const int mean = roundShift(value, kFractionBits);
    return {mean, roundShift((value - (mean << kFractionBits)) * count, kFractionBits)};
}

/// Weights of the taps −1, 0, 1, 2 at fraction f/256; they sum to 1024. Keys' cubic with slope
/// −5/8: a little sharper than Catmull-Rom (−1/2), because history passes through it every frame.
struct CubicWeights {
    int w[4];
};
constexpr int kCubicBits = 10;
constexpr CubicWeights cubicWeights(int f) {
    const int f1 = f << 16;  // fractions to the powers 1, 2, 3 in 2^-24
    const int f2 = f * f << 8;
    const int f3 = f * f * f;
    const int before = roundShift(-5 * (f3 - 2 * f2 + f1), 17);
    const int right = roundShift(14 * f2 - 11 * f3 + 5 * f1, 17);
    const int after = roundShift(5 * (f3 - f2), 17);
    return {{before, (1 << kCubicBits) - before - right - after, right, after}};
}

/// Rows of the 4×4 filter are kept with 3 fraction bits, so that the columns fit in 32 bits.
constexpr int kCubicRowShift = kCubicBits - 3;
constexpr int kCubicColumnShift = kCubicBits + 3 - kFractionBits;

/// Octahedral normal of the G-buffer (2 × snorm16) cut down to 2 × 8 bit.
constexpr uint16_t compactNormal(uint32_t packed) {
    return uint16_t(((packed >> 8) & 0x00FFu) | ((packed >> 16) & 0xFF00u));
}

/// True when two compact normals differ by less than about 37° (cosine² ≥ 5/8).
constexpr bool similarNormals(uint16_t a, uint16_t b) {
    struct Vector {
        int x, y, z;
    };
    const auto decode = [](uint16_t n) {
        int x = int8_t(n & 0xFF);
        int y = int8_t(n >> 8);
        const int z = 127 - (x < 0 ? -x : x) - (y < 0 ? -y : y);
        const int fold = z < 0 ? -z : 0;
        x += x < 0 ? fold : -fold;
        y += y < 0 ? fold : -fold;
        return Vector{x, y, z};
    };
    const Vector p = decode(a);
    const Vector q = decode(b);
    const int dot = p.x * q.x + p.y * q.y + p.z * q.z;
    const int pp = p.x * p.x + p.y * p.y + p.z * p.z;
    const int qq = q.x * q.x + q.y * q.y + q.z * q.z;
    return dot > 0 && (dot >> 3) * (dot >> 3) >= ((pp * 5) >> 6) * (qq >> 3);
}

/// Most samples that history may stand for after it was resampled: the more the filter blurs, the
/// sooner new samples must replace the old ones. 3 … 19.
constexpr int resampledCount(int blur) {
    return 3 + 16 / (blur + 1);
}
/// At fraction (fx, fy)/256.
constexpr int resampledCount(int fx, int fy) {
    return resampledCount((fx * (256 - fx) + fy * (256 - fy)) >> 8);  // 0 … 128
}

}  // namespace still::taa
