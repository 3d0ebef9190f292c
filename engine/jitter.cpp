// Sources: I. M. Sobol, "On the distribution of points in a cube" (1967); A. Owen, "Randomly
// permuted (t,m,s)-nets and (t,s)-sequences" (1995); G. Larcher, F. Pillichshammer, "Walsh series
// analysis of the L2-discrepancy of symmetrisized point sets" (2001); J. Halton, "On the efficiency
// of certain quasi-random sequences of points" (1960); M. Roberts, "The unreasonable effectiveness
// of quasirandom sequences" (2018); D. Mitchell, "Spectrally optimal sampling for distribution ray
// tracing" (1991). All in integers.
//
// Ours was chosen by measurement. "edge n": rms error of the mean of the first n samples at 20000
// random edges through the pixel (angle and distance uniform); "all n": mean over n = 1 … 64 of
// rms · n^0.75. "rest", "slow", "fast": the same at 400 edges for a pixel that is gathered from any
// 8 frames in a row (soft box, fitted plane: postfx/internal/rules.h) of a surface that stands
// still or glides by v pixel per frame under the samples: slow are 12 directions of each of v =
// 0.05, 0.1, 0.2 and 0.3, fast those of 0.4 and 0.5; "worst" is the worst of the slow ones.
//
// pattern           edge 1 edge 4 edge 8 16     32     64     all n  rest   slow   fast   worst
// none              0.2496                                    3.271  0.2594 0.1315 0.0652 0.2118
// uniform2          0.3403 0.1589                             2.089  0.1294 0.0715 0.0946 0.0948
// rgss4             0.3599 0.0910                             1.211  0.0802 0.0746 0.0780 0.1410
// halton8           0.2731 0.1483 0.0716                      0.972  0.0519 0.0687 0.0860 0.0841
// halton16          0.2731 0.1483 0.0716 0.0498               0.721  0.0595 0.0704 0.0835 0.0968
// halton32          0.2731 0.1483 0.0716 0.0498 0.0292        0.489  0.0607 0.0710 0.0852 0.1013
// hammersley4       0.4235 0.1041                             1.393  0.0760 0.0737 0.0779 0.1424
// hammersley8       0.4661 0.1264 0.0656                      0.892  0.0510 0.0695 0.0880 0.0864
// hammersley16      0.4895 0.1229 0.0811 0.0397               0.571  0.0641 0.0703 0.0823 0.0822
// r2                0.3052 0.1236 0.0970 0.0647 0.0383 0.0199 0.443  0.0542 0.0704 0.0793 0.1332
// blue_noise        0.2496 0.1552 0.0623 0.0439 0.0280 0.0153 0.338  0.0713 0.0774 0.0828 0.0857
// net16             0.2512 0.1093 0.0616 0.0372               0.532  0.0648 0.0754 0.0812 0.0928
// net32             0.2516 0.1112 0.0632 0.0367 0.0210        0.369  0.0643 0.0729 0.0829 0.0816
// net64, ours       0.2524 0.1030 0.0600 0.0348 0.0216 0.0125 0.317  0.0588 0.0693 0.0843 0.0799
// in net32's order  0.2524 0.1109 0.0631 0.0365 0.0206 0.0125 0.309  0.0642 0.0735 0.0827 0.0841
// Halton, 64 points 0.2731 0.1483 0.0716 0.0498 0.0292 0.0183 0.401  0.0604 0.0714 0.0853 0.1040
// Sobol             0.5048 0.1368 0.0810 0.0468 0.0239 0.0128 0.410  0.0630 0.0725 0.0820 0.0869
// Sobol, scrambled  0.2684 0.1169 0.0630 0.0373 0.0206 0.0125 0.321  0.0641 0.0737 0.0824 0.0846
//
// The scrambles of the points are the best of 4500 random ones improved by flipping single bits
// while that helped. net16 and net32 are the beginnings of the net in an order whose aligned runs
// of 2, 4, 8 … are nets, scrambled in the same way, among those that begin with the point nearest
// the pixel's centre: the frame after a cut is then as good as an unjittered one.
//
// What moves is seen through a window of 8 frames that begins anywhere, so net64 has another order.
// No order is better for all motions: over all v within a pixel the phases of two frames are
// independent, and the mean square error is that of 8 random samples. One can only take error from
// some motions and give it to others, and what is seen sharply rests or moves slowly. Even steps as
// R2's are the best at rest and for most v, but where step and motion cancel out, all samples fall
// on one place (0.16 at v = 0.5). Nine pans of the courtyard by 0.04 … 0.28 pixel a frame, 320×180
// against ssaa:64, mean and worst: ours 35.4 and 34.8 dB, net32's order 35.2 and 34.7, R2 35.7 and
// 33.7.
//
// Ours came from R2's order on the points of the net (edge 8: 0.106) by swapping pairs (annealing,
// 2.4 million trials, the first point fixed) for the least sum of
// - the mean square error of 4, 6, 8 (a half), 12 and 16 frames in a row, as cubic mean over v =
//   0.04 … 0.28 in 8 directions, 1/4 along the axes, 1/2 along axes and diagonals,
// - half of the same at rest for 4, 8, 16 and 32 frames,
// - a fifth of the mean square errors of the first n frames, as multiples of net32's order.
// Dead ends: smaller exponents find more regular orders, which resonate as R2 does and are no
// better elsewhere; more weight on v < 0.2 wins another 0.001 there and loses 0.008 at 0.3.

#include "engine/jitter.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <span>

#include "rasterizer/fixed.h"

namespace still {
namespace {

constexpr int kTaaBits = 6;
static_assert(kTaaPeriod == 1u << kTaaBits);

/// One bit for every node of the binary tree of 6-bit numbers; node 1 is the root.
constexpr uint64_t kRunScramble = 0x1626578b09e9ec44;
constexpr uint64_t kScrambleX = 0xe51d18efe9d965a2;
constexpr uint64_t kScrambleY = 0xb43d4795fae85bc3;

/// Owen's nested permutation of the numbers of `bits` bits: each bit is flipped or not depending
/// on the bits above it.
constexpr uint32_t scrambled(uint32_t v, uint64_t flips, int bits) {
    uint32_t result = 0;
    uint32_t node = 1;
    for (int i = bits - 1; i >= 0; --i) {
        const uint32_t bit = (v >> i) & 1;
        result |= (bit ^ (uint32_t(flips >> node) & 1)) << i;
        node = node * 2 + bit;
    }
    return result;
}

/// The lowest `bits` bits of v, mirrored: van der Corput's sequence, Sobol's first coordinate.
constexpr uint32_t mirrored(uint32_t v, int bits) {
    uint32_t result = 0;
    for (int i = 0; i < bits; ++i) {
        result |= ((v >> i) & 1) << (bits - 1 - i);
    }
    return result;
}

/// Sobol's second coordinate as an integer of `bits` bits; the generator matrix is Pascal's
/// triangle.
constexpr uint32_t sobolSecond(uint32_t i, int bits) {
    uint32_t result = 0;
    for (uint32_t column = (1u << bits) >> 1; i != 0; i >>= 1, column ^= column >> 1) {
        result ^= (i & 1) != 0 ? column : 0;
    }
    return result;
}

/// Larcher and Pillichshammer's radical inverse; with i / 2^bits it makes the evenest net here.
constexpr uint32_t larcherPillichshammer(uint32_t i, int bits) {
    uint32_t result = 0;
    for (uint32_t column = (1u << bits) >> 1; i != 0; i >>= 1, column |= column >> 1) {
        result ^= (i & 1) != 0 ? column : 0;
    }
    return result;
}

/// Cell `k` of 2^bits cells across the pixel → its centre; for more than 128 cells its lower edge
/// on the 1/256 grid.
constexpr int cellOffset(uint32_t k, int bits) {
    const uint32_t position_fx8 = bits < 8 ? (2 * k + 1) << (7 - bits) : k >> (bits - 8);
    return int(position_fx8) - 128;
}

/// A net of 2^bits samples, each in the centre of its cell of 1/2^bits pixel. Aligned runs of 2, 4,
/// 8 … are nets themselves, so no two share a column or a row.
template <int kBits>
constexpr std::array<SampleOffset, 1 << kBits> makeNet() {
    std::array<SampleOffset, 1 << kBits> net{};
    for (uint32_t i = 0; i < net.size(); ++i) {
        const uint32_t point = scrambled(i, kRunScramble, kTaaBits);
        const uint32_t x = scrambled(mirrored(point, kTaaBits), kScrambleX, kTaaBits);
        const uint32_t y = scrambled(sobolSecond(point, kTaaBits), kScrambleY, kTaaBits);
        net[i] = {cellOffset(x >> (kTaaBits - kBits), kBits),
                  cellOffset(y >> (kTaaBits - kBits), kBits)};
    }
    return net;
}

/// Sample i of the TAA sequence is point kWindowOrder[i] of the net: any 8 in a row lie evenly.
constexpr std::array<uint8_t, kTaaPeriod> kWindowOrder{
    0,  56, 8,  32, 14, 60, 12, 11, 48, 62, 27, 4,  13, 52, 33, 10, 46, 49, 29, 39, 17, 23,
    42, 58, 1,  35, 37, 5,  36, 26, 45, 47, 15, 59, 54, 24, 51, 41, 40, 61, 3,  34, 55, 21,
    6,  30, 44, 43, 18, 53, 31, 7,  20, 9,  38, 28, 57, 16, 25, 22, 50, 2,  63, 19,
};

constexpr std::array<SampleOffset, kTaaPeriod> makeTaaSequence() {
    constexpr auto net = makeNet<kTaaBits>();
    std::array<SampleOffset, kTaaPeriod> sequence{};
    for (size_t i = 0; i < sequence.size(); ++i) {
        sequence[i] = net[kWindowOrder[i]];
    }
    return sequence;
}

/// Digits of i in `base`, mirrored behind the point, to the nearest 1/256, half up, from −1/2.
constexpr int radicalInverseOffset(uint32_t i, uint32_t base) {
    uint32_t numerator = 0, denominator = 1;
    for (; i != 0; i /= base) {
        numerator = numerator * base + i % base;
        denominator *= base;
    }
    return int((512 * numerator + denominator) / (2 * denominator)) - 128;
}

constexpr std::array<SampleOffset, 32> makeHalton() {
    std::array<SampleOffset, 32> points{};
    for (uint32_t i = 0; i < points.size(); ++i) {
        points[i] = {radicalInverseOffset(i + 1, 2), radicalInverseOffset(i + 1, 3)};
    }
    return points;
}

/// Point k is (k, mirrored k) of 2^bits cells. Taken in its own order it would sweep the pixel
/// from left to right, so sample i is point i · step.
template <int kBits>
constexpr std::array<SampleOffset, 1 << kBits> makeHammersley(uint32_t step) {
    std::array<SampleOffset, 1 << kBits> points{};
    for (uint32_t i = 0; i < points.size(); ++i) {
        const uint32_t point = i * step % uint32_t(points.size());
        points[i] = {cellOffset(point, kBits), cellOffset(mirrored(point, kBits), kBits)};
    }
    return points;
}

/// Sample i is frac((i + 1) · (1/ρ, 1/ρ²)) of the plastic number ρ (ρ³ = ρ + 1), in 1/2^32,
/// rounded half up; what rounds to the pixel's far edge stays inside.
constexpr std::array<SampleOffset, 64> makeR2() {
    constexpr uint32_t kStepX = 0xC13FA9A9, kStepY = 0x91E10DA6;
    constexpr auto offset = [](uint32_t position) {
        const int rounded = int((uint64_t{position} + (1u << 23)) >> 24);
        return (rounded < 256 ? rounded : 255) - 128;
    };
    std::array<SampleOffset, 64> points{};
    for (uint32_t i = 0; i < points.size(); ++i) {
        points[i] = {offset((i + 1) * kStepX), offset((i + 1) * kStepY)};
    }
    return points;
}

constexpr auto kNet64 = makeTaaSequence();
constexpr auto kNet32 = makeNet<5>();
constexpr auto kNet16 = makeNet<4>();
constexpr auto kHalton = makeHalton();
constexpr auto kHammersley16 = makeHammersley<4>(7);
constexpr auto kHammersley8 = makeHammersley<3>(3);
constexpr auto kHammersley4 = makeHammersley<2>(3);
constexpr auto kR2 = makeR2();
constexpr std::array<SampleOffset, 1> kCentre{};
constexpr std::array<SampleOffset, 2> kUniform2{{{-64, -64}, {64, 64}}};
/// The rotated grid, opposite corners one after the other.
constexpr std::array<SampleOffset, 4> kRgss4{{{-32, -96}, {32, 96}, {96, -32}, {-96, 32}}};

/// D. Mitchell's best candidates on a torus of 256 × 256: point 0 is the centre; point k is the
/// first of those of 8 · k candidates that are farthest from all points before it. Candidates are
/// pairs x, y of the top bytes of s ← 1664525 · s + 1013904223 (mod 2^32), from s = 28, which was
/// the best start of 300 by the error at edges. A test makes the table again.
constexpr std::array<SampleOffset, 64> kBlueNoise{{
    {0, 0},     {125, 52},   {67, -105},  {-68, -96}, {-49, 68},  {-123, -40},  {71, -4},
    {16, 102},  {-114, 116}, {5, -86},    {-59, -2},  {78, 90},   {-32, -47},   {-31, 121},
    {60, -48},  {30, 44},    {-111, -84}, {-96, 25},  {97, -71},  {114, 7},     {-81, -51},
    {8, -45},   {80, 45},    {106, -121}, {-93, 70},  {-34, 32},  {-11, 64},    {94, -35},
    {-67, 101}, {34, -19},   {-89, -18},  {112, 89},  {47, 122},  {-27, -98},   {-84, -125},
    {46, 72},   {4, -122},   {38, -81},   {-73, 43},  {40, 12},   {-28, -15},   {-22, 93},
    {78, 122},  {-41, -75},  {-4, 34},    {68, -73},  {-113, 0},  {-57, -34},   {112, -94},
    {16, 66},   {-118, 78},  {123, -68},  {-93, 100}, {98, 65},   {-119, -114}, {89, 17},
    {27, -107}, {57, 32},    {-53, -121}, {119, -18}, {-15, -71}, {-60, 23},    {34, -52},
    {-124, 26},
}};

std::span<const SampleOffset> samplesOf(JitterPattern pattern) {
    switch (pattern) {
        case JitterPattern::none:
            return kCentre;
        case JitterPattern::uniform2:
            return kUniform2;
        case JitterPattern::rgss4:
            return kRgss4;
        case JitterPattern::halton8:
            return std::span(kHalton).first<8>();
        case JitterPattern::halton16:
            return std::span(kHalton).first<16>();
        case JitterPattern::halton32:
            return kHalton;
        case JitterPattern::hammersley4:
            return kHammersley4;
        case JitterPattern::hammersley8:
            return kHammersley8;
        case JitterPattern::hammersley16:
            return kHammersley16;
        case JitterPattern::net16:
            return kNet16;
        case JitterPattern::net32:
            return kNet32;
        case JitterPattern::net64:
            return kNet64;
        case JitterPattern::r2:
            return kR2;
        case JitterPattern::blue_noise:
            return kBlueNoise;
    }
    return kCentre;
}

/// Bits of a cycle's order scramble (the finisher of SplitMix64); cycle 0 keeps the given order.
constexpr uint64_t flipsOfCycle(uint32_t cycle) {
    uint64_t z = uint64_t{cycle} * 0x9E3779B97F4A7C15u;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
}

/// Of temporal upscaling; see upscaleSample().
constexpr uint32_t kUpscaleSeedX = 3429, kUpscaleSeedY = 3430;

/// scrambled() with bits drawn for each node from `seed`.
constexpr uint32_t scrambledAnew(uint32_t v, uint32_t seed, int bits) {
    uint32_t result = 0;
    uint32_t node = 1;
    for (int i = bits - 1; i >= 0; --i) {
        const uint32_t bit = (v >> i) & 1;
        result |= (bit ^ uint32_t(flipsOfCycle(seed << 12 | node) >> 63)) << i;
        node = node * 2 + bit;
    }
    return result;
}

int scaledOffset(int offset_fx8, int scale_fx8) {
    return std::clamp(roundShift(offset_fx8 * scale_fx8, 8), -128, 127);
}

}  // namespace

uint32_t jitterPeriod(JitterPattern pattern) {
    return uint32_t(samplesOf(pattern).size());
}

SampleOffset jitterSample(JitterPattern pattern, int scale_fx8, bool scramble, uint32_t index) {
    assert(scale_fx8 >= 0 && scale_fx8 <= kMaxJitterScale_fx8);
    const std::span<const SampleOffset> samples = samplesOf(pattern);
    const uint32_t period = uint32_t(samples.size());
    uint32_t place = index % period;
    if (scramble) {
        place = scrambled(place, flipsOfCycle(index / period), std::countr_zero(period));
    }
    return {scaledOffset(samples[place].x_fx8, scale_fx8),
            scaledOffset(samples[place].y_fx8, scale_fx8)};
}

SampleOffset taaSample(uint32_t index) {
    return kNet64[index % kTaaPeriod];
}

uint32_t upscalePeriod(int ratio_fx8) {
    assert(ratio_fx8 >= kNativeRatio_fx8 && ratio_fx8 <= kMaxRatio_fx8);
    const uint32_t samples_fx16 = kTaaPeriod * uint32_t(ratio_fx8) * uint32_t(ratio_fx8);
    return std::bit_ceil((samples_fx16 + 65535) >> 16);
}

SampleOffset upscaleSample(uint32_t index, uint32_t period) {
    assert(std::has_single_bit(period) && period >= kTaaPeriod && period <= kMaxUpscalePeriod);
    const int bits = std::countr_zero(period);
    const uint32_t point = index % period;
    const uint32_t x = scrambledAnew(mirrored(point, bits), kUpscaleSeedX, bits);
    const uint32_t y = scrambledAnew(sobolSecond(point, bits), kUpscaleSeedY, bits);
    return {cellOffset(x, bits), cellOffset(y, bits)};
}

static bool lengthens(const TaaPolicy& policy) {
    return upscalesInTime(policy) && policy.jitter == JitterPattern::net64;
}

uint32_t policyPeriod(const TaaPolicy& policy) {
    return lengthens(policy) ? upscalePeriod(policy.ratio_fx8) : jitterPeriod(policy.jitter);
}

SampleOffset policySample(const TaaPolicy& policy, uint32_t index) {
    if (!lengthens(policy)) {
        return jitterSample(policy.jitter, policy.jitter_scale_fx8, policy.scramble, index);
    }
    const SampleOffset sample = upscaleSample(index, policyPeriod(policy));
    return {scaledOffset(sample.x_fx8, policy.jitter_scale_fx8),
            scaledOffset(sample.y_fx8, policy.jitter_scale_fx8)};
}

SampleOffset ssaaSample(uint32_t index, uint32_t count) {
    assert(count >= 1 && count <= 65536 && index < count);
    const int bits = int(std::bit_width(count - 1));
    const int x_fx8 = int((2 * index + 1) * 128 / count) - 128;
    return {x_fx8, cellOffset(larcherPillichshammer(index, bits), bits)};
}

}  // namespace still
