#pragma once
// The resolve's arithmetic, one pixel at a time, in integers. The scalar kernels are built from
// these and the SIMD kernels must give the same numbers. How the constants were found:
// postfx/README.md.

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "postfx/taa.h"
#include "rasterizer/fixed.h"

namespace still::taa {

/// Stored depth may differ from the expected one by this much (1 = 1/4096 … 1/2048 relative) …
constexpr int kDepthTolerance = 48;
/// … plus this multiple of the surface's own step towards its nearest neighbour …
constexpr int kSlopeFactor = 3;
/// … plus an eighth of the change that is expected over the frames in between.
constexpr int kStepShift = 3;
/// Steps of logDepth16 per pixel are held within this, so that all that comes of them fits 16 bits:
/// 2 octaves.
constexpr int kMaxSlope = 4000;
/// Steps per frame that are larger than 8 octaves count as 16.
constexpr int kMaxStep = 16383;
constexpr int heldStep(int step) {
    return step >= kMaxStep ? 2 * kMaxStep : (step <= -kMaxStep ? -2 * kMaxStep : step);
}

/// A sample of another surface counts for a pixel when the two surfaces have slid over each other
/// by at most this much since (1/256 pixel, larger axis).
constexpr int kMaxSlide = 128;
/// Two surfaces in a window that move apart by more than this per frame (larger axis) are followed
/// along their own ways.
constexpr int kApart = 8;
/// A sample of the farther one that is seen along the nearer one's way shows a wrong place when
/// they have slid by more than this since (1/256 pixel, larger axis).
constexpr int kMaxLag = 64;

/// Frames that are followed where a window shows one surface with little contrast, and with next to
/// none: more would hardly change the picture.
constexpr int kCalmFrames = 4;
constexpr int kFlatFrames = 2;
/// What the channels of such windows may span.
constexpr int kCalmShift = 2;
constexpr int kFlatShift = 4;
constexpr int contrastBound(int largest, int shift) {
    return (largest >> shift) + 4;
}

/// Frames that are followed on an object that turns or bends: it is lit otherwise every frame, and
/// its outline is not where its surface goes.
constexpr int kTurningFrames = 3;
/// Frames that are followed where the owner moves by more than kFast (1/256 pixel, larger axis):
/// its motion differs from one pixel to the next, and the error of place grows with every frame.
constexpr int kFastFrames = 2;
constexpr int kFast = 24 * 256;
/// Frames in which the farther of two surfaces is looked for.
constexpr int kFarFrames = 4;
/// A still pixel is shown as the mean of its samples from so many samples on.
constexpr int kSettled = 16;

/// Samples of a moved surface whose normals differ by more than about 10° (cosine² < 31/32) were
/// lit differently.
constexpr bool similarlyLit(int dot, int square_a, int square_b) {
    return dot > 0 && (dot >> 3) * (dot >> 3) >= ((square_a * 31) >> 8) * (square_b >> 3);
}

/// Octahedral normal of the G-buffer (2 × snorm16) cut down to 2 × 8 bit.
constexpr uint32_t compactNormal(uint32_t packed) {
    return ((packed >> 8) & 0x00FFu) | ((packed >> 16) & 0xFF00u);
}
struct SmallNormal {
    int x, y, z;
};
constexpr SmallNormal decodeNormal(uint32_t compact) {
    int x = int8_t(compact & 0xFF);
    int y = int8_t((compact >> 8) & 0xFF);
    const int z = 127 - (x < 0 ? -x : x) - (y < 0 ? -y : y);
    const int fold = z < 0 ? -z : 0;
    x += x < 0 ? fold : -fold;
    y += y < 0 ? fold : -fold;
    return {x, y, z};
}
constexpr int dotOf(SmallNormal a, SmallNormal b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// One channel of a pixel: see StillSums.
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

/// floor(2^16 / n) for 1 … 255, at most 2^16 − 1.
constexpr std::array<uint16_t, 256> makeShortReciprocals() {
    std::array<uint16_t, 256> table{};
    for (int n = 1; n < 256; ++n) {
        table[size_t(n)] = uint16_t(std::min(65536 / n, 65535));
    }
    return table;
}
inline constexpr std::array<uint16_t, 256> kShortReciprocals = makeShortReciprocals();

/// Weight of the right (lower) one of two neighbouring samples, 0 … kAxisWeight, for a pixel centre
/// that lies f/256 between them: a box of one pixel, its sides softened to ramps over 0.2 … 0.8.
constexpr int kAxisWeight = 16;
constexpr int axisWeight(int f) {
    return std::clamp(((f - 51) * 53 + 271) >> 9, 0, kAxisWeight);
}
/// What a frame's four samples around a pixel weigh together.
constexpr int kFrameWeight = kAxisWeight * kAxisWeight;

/// Moments of the accepted samples' places around the pixel's centre: w, e in 1/64 pixel.
struct Moments {
    int w = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;

    constexpr void add(int weight, int ex, int ey) {
        w += weight;
        x += weight * ex;
        y += weight * ey;
        xx += weight * ex * ex;
        xy += weight * ex * ey;
        yy += weight * ey * ey;
    }
};
/// 1/256 pixel to 1/64.
constexpr int placeOf(int e_fx8) {
    return e_fx8 >> 2;
}

/// floor(2^16 / i) for 256 … 511.
constexpr std::array<int32_t, 256> makeSmallReciprocals() {
    std::array<int32_t, 256> table{};
    for (int i = 0; i < 256; ++i) {
        table[size_t(i)] = 65536 / (256 + i);
    }
    return table;
}
alignas(64) inline constexpr std::array<int32_t, 256> kSmallReciprocals = makeSmallReciprocals();

/// Samples lie unevenly around the centre; giving each the weight w · (1 − tilt · e) moves their
/// centre of gravity onto the pixel's: the weights of a plane fitted through the samples, taken at
/// the centre. Q14 per 1/64 pixel; |x| + |y| ≤ kMaxTilt keeps all weights positive.
struct Tilt {
    int x = 0, y = 0;
};
constexpr int kTiltBits = 14;
constexpr int kMaxTilt = 298;
/// Part of the weight that pulls the tilt towards none (squared 1/64 pixels): 0.04 pixel².
constexpr int kRidge = 164;

/// nx / det in Q10, |result| < 2^14; det ≥ 256.
constexpr int tiltQuotient(int nx, int det, int shift) {
    const int small = std::clamp(nx >> shift, -16384, 16383);
    return (small * kSmallReciprocals[size_t((det >> shift) - 256)]) >> 6;
}

constexpr Tilt tiltOf(const Moments& m) {
    const int ridge = ((m.w * kRidge) >> 8) + 16;
    const int a = (m.xx >> 8) + ridge;
    const int b = m.xy >> 8;
    const int d = (m.yy >> 8) + ridge;
    const int x = m.x >> 4, y = m.y >> 4;
    const int det = a * d - b * b;
    const int shift = int(std::bit_width(uint32_t(det))) - 9;
    Tilt tilt{tiltQuotient(d * x - b * y, det, shift), tiltQuotient(a * y - b * x, det, shift)};
    for (int i = 0; i < 6; ++i) {
        const bool steep =
            (tilt.x < 0 ? -tilt.x : tilt.x) + (tilt.y < 0 ? -tilt.y : tilt.y) > kMaxTilt;
        tilt.x = steep ? tilt.x >> 1 : tilt.x;
        tilt.y = steep ? tilt.y >> 1 : tilt.y;
    }
    return tilt;
}

constexpr int tiltedWeight(int weight, Tilt tilt, int ex, int ey) {
    const int factor = (1 << kTiltBits) - tilt.x * ex - tilt.y * ey;
    return (weight * factor + (1 << (kTiltBits - 1))) >> kTiltBits;
}

/// floor(2^32 / n) + 1 for 2 … 8191; 0 and 1 are 0.
constexpr int kMaxTotal = 2 * kFrameWeight * kMaxRing;
constexpr std::array<uint32_t, size_t(kMaxTotal) + 1> makeReciprocals() {
    std::array<uint32_t, size_t(kMaxTotal) + 1> table{};
    for (size_t n = 2; n < table.size(); ++n) {
        table[n] = uint32_t((uint64_t{1} << 32) / n + 1);
    }
    return table;
}
alignas(64) inline constexpr auto kReciprocals = makeReciprocals();

/// (sum + total / 2) / total, by the table.
constexpr int weightedMean(uint32_t sum, int total) {
    return int((uint64_t(sum + uint32_t(total) / 2) * kReciprocals[size_t(total)]) >> 32);
}

}  // namespace still::taa
