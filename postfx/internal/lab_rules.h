#pragma once
// The laboratory's arithmetic, one value at a time. The scalar kernel is built from these and the
// SIMD kernels give the same numbers, so everything fits 32 bits. Signed shifts round half up
// (rasterizer/fixed.h).

#include <algorithm>
#include <cstdint>

#include "postfx/internal/lab_tables.h"
#include "postfx/policy.h"
#include "rasterizer/fixed.h"

namespace still::lab {

constexpr int kFractionBits = 8;  ///< of history, below working colour
constexpr int32_t kWorkingMax = 65535;
constexpr int32_t kWorkingMax_w24 = kWorkingMax << kFractionBits;
constexpr int32_t kAlphaOne = 32768;

/// floor(numerator · 2^kBits / denominator) for 0 ≤ numerator ≤ denominator < 2^30, at most
/// 2^kBits − 1. Bit by bit, as lanes do it.
template <int kBits>
constexpr uint32_t quotient(uint32_t numerator, uint32_t denominator) {
    uint32_t rest = numerator, result = 0;
    for (int bit = 0; bit < kBits; ++bit) {
        rest += rest;
        const bool fits = rest >= denominator;
        rest -= fits ? denominator : 0;
        result += result + (fits ? 1 : 0);
    }
    return result;
}

constexpr uint32_t highProduct(uint32_t a, uint32_t b) {
    return uint32_t((uint64_t{a} * b) >> 32);
}

/// 8 · √n, within 2 %: a table of 12 bits.
constexpr uint32_t rootOf(uint32_t n) {
    int level = 0;
    while (n >= uint32_t(RootTable::kSize)) {
        n >>= 6;
        ++level;
    }
    return kRoots.of[n] << (3 * level);
}

struct Rgb {
    int32_t v[3];
};

constexpr int32_t largest(const Rgb& c) {
    return std::max(std::max(c.v[0], c.v[1]), c.v[2]);
}

// ---- Tone: Reinhard's curve on the largest channel, in fx15.

/// The curve's value for 16.0.
constexpr int32_t kToneMax = 30840;

/// table[index / 2^kBits], interpolated.
template <int kBits>
constexpr uint32_t interpolated(const uint32_t* table, int32_t index) {
    const auto first = int32_t(table[index >> kBits]);
    const int32_t step = int32_t(table[(index >> kBits) + 1]) - first;
    return uint32_t(first + ((step * (index & ((1 << kBits) - 1))) >> kBits));
}

constexpr Rgb toneIn(const Rgb& c) {
    const uint32_t scale = interpolated<6>(kToneIn.of, largest(c));
    const auto mapped = [&](int32_t v) { return int32_t((uint32_t(v) * scale) >> 12); };
    return {{mapped(c.v[0]), mapped(c.v[1]), mapped(c.v[2])}};
}

constexpr Rgb toneOut(const Rgb& c) {
    const Rgb t{
        {std::min(c.v[0], kToneMax), std::min(c.v[1], kToneMax), std::min(c.v[2], kToneMax)}};
    const uint32_t scale = interpolated<5>(kToneOut.of, largest(t));
    const auto linear = [&](int32_t v) {
        return std::min<int32_t>(int32_t((uint32_t(v) * scale + 16384) >> 15), 65535);
    };
    return {{linear(t.v[0]), linear(t.v[1]), linear(t.v[2])}};
}

// ---- Colour spaces. Chroma is halved to fit the range of luma.

constexpr Rgb toYcocg(const Rgb& c) {
    return {{roundShift(c.v[0] + 2 * c.v[1] + c.v[2], 2), roundShift(c.v[0] - c.v[2], 1),
             roundShift(2 * c.v[1] - c.v[0] - c.v[2], 2)}};
}

constexpr Rgb fromYcocg(const Rgb& c) {
    const int32_t magenta = c.v[0] - c.v[2];
    return {{magenta + c.v[1], c.v[0] + c.v[2], magenta - c.v[1]}};
}

constexpr int32_t lumaOf(const Rgb& c) {
    return roundShift(c.v[0] + 2 * c.v[1] + c.v[2], 2);
}

/// Statistics take colours above 10.0 for 10.0, so that a window's squared deviations fit 32 bits.
constexpr int32_t kStatisticsMax = 40960;

constexpr bool usesStatistics(const TaaPolicy& p) {
    return p.rectification == Rectification::variance_clip ||
           p.rectification == Rectification::variance_clamp;
}

/// Towards the box's middle, not channel by channel.
constexpr bool clips(const TaaPolicy& p) {
    return p.rectification == Rectification::clip ||
           p.rectification == Rectification::rounded_clip ||
           p.rectification == Rectification::variance_clip;
}

/// Working colour as rectification sees it.
constexpr Rgb toSpace(const TaaPolicy& p, const Rgb& c) {
    return p.space == ColourSpace::ycocg ? toYcocg(c) : c;
}

constexpr Rgb fromSpace(const TaaPolicy& p, const Rgb& c) {
    const Rgb rgb = p.space == ColourSpace::ycocg ? fromYcocg(c) : c;
    return {{std::clamp<int32_t>(rgb.v[0], 0, kWorkingMax),
             std::clamp<int32_t>(rgb.v[1], 0, kWorkingMax),
             std::clamp<int32_t>(rgb.v[2], 0, kWorkingMax)}};
}

// ---- Windows

/// Mean of nine values from their sum and the middle one; exact where all are equal.
constexpr int32_t meanOfNine(int32_t sum, int32_t middle) {
    return middle + roundShift((sum - 9 * middle) * 3641, 15);
}

/// Σ (v − mean)² from Σ v² and Σ v: intermediate values wrap around, the result does not.
constexpr uint32_t squaredDeviation(uint32_t squares, int32_t sum, int32_t mean) {
    return squares - uint32_t(mean) * uint32_t(2 * sum - 9 * mean);
}

/// k in FrameConstants: k · 4096 / 3, because nine squared deviations are summed.
constexpr uint32_t sigmaFactor(int k_fx8) {
    return uint32_t(k_fx8 * 4096 + 384) / 768;
}

/// k · σ, at most 65535.
constexpr int32_t halfWidth(uint32_t squared_deviation, uint32_t sigma_q12) {
    const uint32_t width = (rootOf(squared_deviation) * sigma_q12 + 16384) >> 15;
    return int32_t(std::min<uint32_t>(width, 65535));
}

// ---- History filters

/// Catmull-Rom weights of the taps −1, 0, 1, 2 at fraction f/256; they sum to 1024.
struct CubicWeights {
    int32_t w[4];
};
constexpr int kCubicBits = 10;
constexpr CubicWeights cubicWeights(int f) {
    const int f1 = f << 16;  // fractions to the powers 1, 2, 3 in 2^-24
    const int f2 = f * f << 8;
    const int f3 = f * f * f;
    const int before = roundShift(2 * f2 - f1 - f3, 15);
    const int right = roundShift(f1 + 4 * f2 - 3 * f3, 15);
    const int after = roundShift(f3 - f2, 15);
    return {{before, (1 << kCubicBits) - before - right - after, right, after}};
}

/// Taps lose 4 of their 24 bits, so that weighted sums fit 32.
constexpr int kTapShift = 4;
constexpr int kCubicColumnShift = kCubicBits - kTapShift;

/// What a sum without the four corners must be multiplied by, minus 1, in 2^-16: the corners'
/// weight e ≤ 1/64 is missing, so e + e² + e³.
constexpr int32_t cornerGain(const CubicWeights& x, const CubicWeights& y) {
    const int32_t e = (x.w[0] + x.w[3]) * (y.w[0] + y.w[3]);  // 2^-20
    const int32_t square = e * e;
    return roundShift(e + (square >> 20) + (square >> 26), 4);
}

// ---- Tests

/// Octahedral normal of the G-buffer (2 × snorm16) cut down to 2 × 8 bit.
constexpr uint16_t compactNormal(uint32_t packed) {
    return uint16_t(((packed >> 8) & 0x00FFu) | ((packed >> 16) & 0xFF00u));
}

struct SmallVector {
    int32_t x, y, z;
};
constexpr SmallVector decodeNormal(uint16_t n) {
    int32_t x = int8_t(n & 0xFF), y = int8_t(n >> 8);
    const int32_t z = 127 - (x < 0 ? -x : x) - (y < 0 ? -y : y);
    const int32_t fold = std::max<int32_t>(-z, 0);
    x += x < 0 ? fold : -fold;
    y += y < 0 ? fold : -fold;
    return {x, y, z};
}
constexpr int32_t dot(const SmallVector& a, const SmallVector& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// Cosine below the one whose square is given.
constexpr bool differentNormals(uint16_t a, uint16_t b, uint32_t square_q15) {
    const SmallVector p = decodeNormal(a), q = decodeNormal(b);
    const int32_t cosine = dot(p, q);
    const int32_t bound = int32_t((uint32_t(dot(p, p)) * square_q15) >> 15) * dot(q, q);
    return cosine <= 0 || cosine * cosine < bound;
}

/// Relative difference of two logDepth16 above a threshold: |a − b| > limit · max(a, b). The
/// threshold is below ½, so exponents two apart differ too much.
constexpr bool differentDepths(int32_t a, int32_t b, int32_t limit_q15) {
    const int32_t far = std::min(a, b), near = std::max(a, b);
    const int32_t exponents = (near >> 11) - (far >> 11);
    const int32_t near_mantissa = (2048 + (near & 2047)) << std::min<int32_t>(exponents, 1);
    const int32_t difference = near_mantissa - (2048 + (far & 2047));
    return exponents > 1 || (difference << 15) > near_mantissa * limit_q15;
}

/// Farther apart than the limit (≤ 32767).
constexpr bool differentMotions(int32_t dx, int32_t dy, int32_t limit_fx8) {
    const int32_t x = std::min<int32_t>(dx < 0 ? -dx : dx, 32767);
    const int32_t y = std::min<int32_t>(dy < 0 ? -dy : dy, 32767);
    return x * x + y * y > limit_fx8 * limit_fx8;
}

constexpr bool differentLumas(int32_t a, int32_t b, int32_t limit_q15) {
    return (std::max(a, b) - std::min(a, b)) * kAlphaOne > std::max(a, b) * limit_q15;
}

/// Length of a motion vector, 1/256 pixel, within 2 %.
constexpr int32_t speedOf(int32_t x_fx8, int32_t y_fx8) {
    return int32_t(rootOf(uint32_t(x_fx8 * x_fx8) + uint32_t(y_fx8 * y_fx8)) >> 3);
}

// ---- Shares of the new sample

/// History's weight 1 − alpha, times weight_q8.
constexpr int32_t lessTrust(int32_t alpha_q15, int32_t weight_q8) {
    return kAlphaOne - (((kAlphaOne - alpha_q15) * weight_q8) >> 8);
}

/// lerp(alpha, 1, 1 − confidence), confidence 0 … 255.
constexpr int32_t confidenceAlpha(int32_t alpha_q15, int32_t confidence) {
    const uint32_t rest = uint32_t(kAlphaOne - alpha_q15) * uint32_t(255 - confidence) * 257u;
    return alpha_q15 + int32_t((rest + 32768) >> 16);
}
constexpr int32_t kConfidenceStep = 85;

constexpr int32_t velocityAlpha(int32_t alpha_q15, int32_t per_pixel_q15, int32_t speed_fx8) {
    return std::min(alpha_q15 + ((speed_fx8 * per_pixel_q15) >> 8), kAlphaOne);
}

/// Share of history's maturity in 0 … 255: count / (count_cap − 1).
constexpr int32_t meanConfidence(int32_t count, uint32_t count_share_q16) {
    return int32_t(std::min<uint32_t>((uint32_t(count) * count_share_q16) >> 16, 255));
}

/// Luminance under which differences do not count: 0.2.
constexpr int32_t steadyLuma(Tone tone) {
    return tone == Tone::linear ? 819 : 5461;
}

/// Pedersen's form of Lottes' weight: (1 − |a − b| / max(a, b, 0.2))².
constexpr int32_t steadyAlpha(const TaaPolicy& p, int32_t alpha_q15, int32_t luma,
                              int32_t history_luma) {
    const int32_t low = std::min(luma, history_luma), high = std::max(luma, history_luma);
    const int32_t scale = std::max(high, steadyLuma(p.tone));
    const auto alike = int32_t(256 - quotient<8>(uint32_t(high - low), uint32_t(scale)));
    const int32_t less_q15 = ((alike * alike >> 8) * (kAlphaOne - p.steady_share_q15)) >> 8;
    return alpha_q15 - ((alpha_q15 * less_q15) >> 15);
}

/// 1 / weight of a luminance for AntiFlicker::inverse_luminance and inverse_log, below 2^15.
constexpr int32_t inverseWeight(const TaaPolicy& p, int32_t luma) {
    if (p.anti_flicker == AntiFlicker::inverse_log) {
        return int32_t(kLogs.of[luma >> (p.tone == Tone::linear ? 6 : 9)]);
    }
    return (luma + (p.tone == Tone::linear ? 4096 : 32768)) >> 2;
}

/// alpha · W(sample) / (alpha · W(sample) + (1 − alpha) · W(history)).
constexpr int32_t weightedAlpha(int32_t alpha_q15, int32_t inverse_sample,
                                int32_t inverse_history) {
    const auto share = uint32_t(alpha_q15) * uint32_t(inverse_history);
    const auto rest = uint32_t(kAlphaOne - alpha_q15) * uint32_t(inverse_sample);
    return int32_t(quotient<15>(share, share + rest));
}

// ---- Blending

constexpr int32_t blended(int32_t history_w24, int32_t sample_w24, int32_t alpha_q15) {
    const int32_t d = sample_w24 - history_w24;
    const int32_t product = (d >> 8) * alpha_q15 + (((d & 255) * alpha_q15) >> 8);
    return history_w24 + roundShift(product, 7);
}

/// round(total / n), 2 ≤ n ≤ 255, by two divisions whose factors fit.
constexpr uint32_t dividedBy(uint32_t total, uint32_t n) {
    const uint32_t high = highProduct(total >> 8, kReciprocals.of[n]);
    const uint32_t rest = (total >> 8) - high * n;
    return (high << 8) + highProduct((rest << 8) + (total & 255) + (n >> 1), kReciprocals.of[n]);
}

/// Mean of `count` ≥ 1 samples that average history, and one more. When samples are whole working
/// colours, history's sum must be whole, too: rounding it restores the exact sum.
constexpr int32_t extendedMean(int32_t history_w24, int32_t sample_w24, int32_t count,
                               bool whole_samples) {
    uint32_t sum = uint32_t(history_w24) * uint32_t(count);
    sum = whole_samples ? ((sum + 128) >> 8) << 8 : sum;
    return int32_t(dividedBy(sum + uint32_t(sample_w24), uint32_t(count + 1)));
}

}  // namespace still::lab
