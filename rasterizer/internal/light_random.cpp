#include "rasterizer/internal/light_random.h"

namespace still::internal {

namespace {

uint32_t reversed(uint32_t x) {
    x = (x >> 16) | (x << 16);
    x = ((x & 0xFF00FF00u) >> 8) | ((x & 0x00FF00FFu) << 8);
    x = ((x & 0xF0F0F0F0u) >> 4) | ((x & 0x0F0F0F0Fu) << 4);
    x = ((x & 0xCCCCCCCCu) >> 2) | ((x & 0x33333333u) << 2);
    return ((x & 0xAAAAAAAAu) >> 1) | ((x & 0x55555555u) << 1);
}

uint32_t hashed(uint32_t x) {
    x ^= x >> 16;
    x *= 0x7FEB352Du;
    x ^= x >> 15;
    x *= 0x846CA68Bu;
    x ^= x >> 16;
    return x;
}

/// Turns each bit over or not, by a hash of the bits above it (Laine and Karras 2011; constants of
/// Vegdahl 2021): a nested uniform scramble, which keeps what is even about a point set.
uint32_t scrambled(uint32_t x, uint32_t seed) {
    x = reversed(x);
    x ^= x * 0x3D20ADEAu;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526C56u;
    x ^= x * 0x53A22864u;
    return reversed(x);
}

/// Second dimension of Sobol's sequence: columns of Pascal's triangle modulo 2.
uint32_t sobolSecond(uint32_t index) {
    uint32_t result = 0;
    for (uint32_t column = 1u << 31; index != 0; index >>= 1, column ^= column >> 1) {
        result ^= (index & 1u) != 0 ? column : 0u;
    }
    return result;
}

RandomPair scrambledSobol(uint32_t index, uint32_t seed) {
    const uint32_t i = scrambled(index, hashed(seed));
    return {scrambled(reversed(i), hashed(seed + 1)), scrambled(sobolSecond(i), hashed(seed + 2))};
}

/// Seeds of the two families of point sets; each use takes three numbers from one on.
constexpr uint32_t kSampleSeed = 1000, kPixelSeed = 2000, kTileSeed = 3000;
constexpr uint32_t kSeedsPerUse = 16;

uint32_t mortonCode(uint32_t x, uint32_t y) {
    uint32_t code = 0;
    for (uint32_t bit = 0; bit < 6; ++bit) {
        code |= (x >> bit & 1u) << (2 * bit) | (y >> bit & 1u) << (2 * bit + 1);
    }
    return code;
}

}  // namespace

SampleNumbers numbersOfSample(uint32_t sample) {
    SampleNumbers numbers;
    for (uint32_t use = 0; use < kRandomUses; ++use) {
        numbers.pairs[use] = scrambledSobol(sample, kSampleSeed + use * kSeedsPerUse);
    }
    return numbers;
}

PixelNumbers::PixelNumbers() {
    static_assert(kTileSize == 64);
    table_.reserve(size_t(kRandomUses) * kTileSize * kTileSize);
    for (uint32_t use = 0; use < kRandomUses; ++use) {
        for (uint32_t y = 0; y < uint32_t(kTileSize); ++y) {
            for (uint32_t x = 0; x < uint32_t(kTileSize); ++x) {
                const RandomPair p =
                    scrambledSobol(mortonCode(x, y), kPixelSeed + use * kSeedsPerUse);
                table_.push_back((p.x & 0xFFFF0000u) | p.y >> 16);
            }
        }
    }
}

PixelNumbers::Tile PixelNumbers::tileOf(int x, int y, const SampleNumbers& sample) const {
    Tile tile;
    tile.table_ = table_.data();
    const uint32_t number = uint32_t(y / kTileSize) << 16 | uint32_t(x / kTileSize);
    for (uint32_t use = 0; use < kRandomUses; ++use) {
        const uint32_t shift = hashed(hashed(number + kTileSeed) + use);
        const RandomPair& one = sample.pairs[use];
        tile.shifts_.pairs[use] = {shift ^ one.x, hashed(shift) ^ one.y};
    }
    return tile;
}

}  // namespace still::internal
