// Sources: I. M. Sobol, "On the distribution of points in a cube" (1967); A. Owen, "Randomly
// permuted (t,m,s)-nets and (t,s)-sequences" (1995); G. Larcher, F. Pillichshammer, "Walsh series
// analysis of the L2-discrepancy of symmetrisized point sets" (2001). All in integers.
//
// The TAA sequence was chosen by measurement. "edge": rms error of the coverage of 20000 random
// half-planes after n samples (α = 1/N); "all n": mean over n = 1 … 64 of rms · n^0.75. "motion": a
// surface glides by v pixel per frame under the samples; unevenness (rms of the cyclic discrepancy
// times √W, random samples: 0.29) of the phases in the last W frames, W = 8 … 64, along x and y,
// the worst and the mean over 20 speeds among which are 1/2, 1/4, 1/8, 1/16, 3/8, 7/8, 1/3, 0.618.
//
//   candidate                         edge 8     16     32     64     all n  motion worst mean
//   Halton (2,3), points 1 … 64       0.0700     0.0484 0.0280 0.0174 0.385  1.156        0.280
//   R2                                0.0961     0.0645 0.0383 0.0196 0.440  1.589        0.199
//   Hammersley, order · 7             0.0900     0.0529 0.0313 0.0146 0.411  1.156        0.257
//   Larcher-Pillichshammer, bit-rev.  0.1346     0.1082 0.0703 0.0118 0.661  1.156        0.264
//   Sobol                             0.0816     0.0478 0.0242 0.0130 0.413  1.156        0.282
//   Sobol, points Owen-scrambled      0.0590     0.0389 0.0212 0.0131 0.334  1.156        0.274
//   chosen: points, order scrambled   0.0610     0.0373 0.0210 0.0127 0.310  0.350        0.246
// (The last but one on the 3000 half-planes of the search, the others on 20000 fresh ones.)
//
// Scrambling the points alone cannot cure the resonance: of two successive Sobol points one is
// always in the left half and one in the right half, in the same order, so at v = 1/2 all samples
// fall into the same half of the surface's pixel. Scrambling the order inside the aligned runs of
// 2, 4, 8 … keeps every run a net and breaks the beat. The scrambles are the best of 4500 random
// ones improved by flipping single bits while that helped.

#include "engine/jitter.h"

#include <array>
#include <bit>
#include <cassert>

namespace still {
namespace {

constexpr int kTaaBits = 6;
static_assert(kTaaPeriod == 1u << kTaaBits);

/// One bit for every node of the binary tree of 6-bit numbers; node 1 is the root.
constexpr uint64_t kOrderScramble = 0x7706afaea8742d54;
constexpr uint64_t kScrambleX = 0xe51d18efe9d965a2;
constexpr uint64_t kScrambleY = 0xb43d4795fae85bc3;

/// Owen's nested permutation: each bit is flipped or not depending on the bits above it.
constexpr uint32_t scrambled(uint32_t v, uint64_t flips) {
    uint32_t result = 0;
    uint32_t node = 1;
    for (int i = kTaaBits - 1; i >= 0; --i) {
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

constexpr std::array<SampleOffset, kTaaPeriod> makeTaaSequence() {
    std::array<SampleOffset, kTaaPeriod> sequence{};
    for (uint32_t i = 0; i < kTaaPeriod; ++i) {
        const uint32_t point = scrambled(i, kOrderScramble);
        const uint32_t x = scrambled(mirrored(point, kTaaBits), kScrambleX);
        const uint32_t y = scrambled(sobolSecond(point, kTaaBits), kScrambleY);
        sequence[i] = {cellOffset(x, kTaaBits), cellOffset(y, kTaaBits)};
    }
    return sequence;
}
constexpr std::array<SampleOffset, kTaaPeriod> kTaaSequence = makeTaaSequence();

}  // namespace

SampleOffset taaSample(uint32_t index) {
    return kTaaSequence[index % kTaaPeriod];
}

SampleOffset ssaaSample(uint32_t index, uint32_t count) {
    assert(count >= 1 && count <= 65536 && index < count);
    const int bits = int(std::bit_width(count - 1));
    const int x_fx8 = int((2 * index + 1) * 128 / count) - 128;
    return {x_fx8, cellOffset(larcherPillichshammer(index, bits), bits)};
}

}  // namespace still
