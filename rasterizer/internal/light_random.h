#pragma once
// Random numbers of sampled light: pairs in [0, 1)², a pure function of pixel, sample and purpose.
//
// Sobol's first two dimensions, shuffled and scrambled by hashes after Owen (Burley 2020), once
// over the samples of a pixel and once over the pixels of a tile in Morton order; the two are
// combined by exclusive or. So the first 2^k samples of any pixel are as even as they can be (a
// digital shift of a net), and so are those of 2^k neighbours in one frame.

#include <array>
#include <cstdint>
#include <vector>

#include "rasterizer/gbuffer.h"

namespace still::internal {

/// What a pair of numbers is for.
enum RandomUse : uint8_t {
    kRandomSun,
    kRandomLight,  ///< where on an area light
    kRandomPick,   ///< which area light: x at the pixel, y where its bounce hits
    kRandomHemisphere,
    kRandomHitSun,
    kRandomHitLight,
    kRandomHoles,
    kRandomUses
};

/// Fixed point: the numbers times 2^32.
struct RandomPair {
    uint32_t x = 0, y = 0;
};

/// The part that all pixels share: of one sample index.
struct SampleNumbers {
    std::array<RandomPair, kRandomUses> pairs;
};
SampleNumbers numbersOfSample(uint32_t sample);

/// The part that all samples share: tables over a tile, which each tile shifts by its own hash.
class PixelNumbers {
  public:
    PixelNumbers();

    /// Those of one tile and sample. Valid as long as this.
    class Tile {
      public:
        RandomPair at(int x, int y, RandomUse use) const {
            const uint32_t in_tile = uint32_t(y % kTileSize * kTileSize + x % kTileSize);
            const uint32_t entry = table_[uint32_t(use) * kTileSize * kTileSize + in_tile];
            const RandomPair& shift = shifts_.pairs[use];
            return {(entry & 0xFFFF0000u) ^ shift.x, entry << 16 ^ shift.y};
        }

      private:
        friend class PixelNumbers;
        const uint32_t* table_ = nullptr;
        SampleNumbers shifts_;
    };
    /// Of the tile that the pixel is in.
    Tile tileOf(int x, int y, const SampleNumbers& sample) const;

  private:
    std::vector<uint32_t> table_;  ///< of each use, kTileSize² pixels: x in the high half, y low
};

/// In [0, 1), 24 bits.
inline float toUnit(uint32_t number) {
    return float(int32_t(number >> 8)) * (1.0f / (1 << 24));
}

}  // namespace still::internal
