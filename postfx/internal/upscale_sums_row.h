#pragma once
// A row of output pixels in which nothing happens, side by side: the lanes of upscale_sums.cpp.

#include <cstdint>

#include "postfx/upscale.h"
#include "rasterizer/gbuffer.h"

namespace still::upscale {

/// Output pixels of a tile along an axis, at most, and what lanes may read beyond.
constexpr int kMostOutputs = kMaxUpscale * kTileSize + kMaxUpscale;
constexpr int kRowLanes = 8;

/// All pointers at the tile's first output pixel, `samples` at the frame's pixel before the tile.
struct SumRow {
    uint32_t* colour[3] = {};
    uint16_t *count = nullptr, *frames = nullptr;
    const uint16_t* samples[3] = {};
    uint16_t* shown[3] = {};
    uint8_t* shown_count = nullptr;
    const int32_t* pixel = nullptr;  ///< of each output pixel: its sample's index, −1 for none
    const int32_t* next = nullptr;   ///< the first such index from here on
    int width = 0;
    int sample_cap = 0, settled = 0;
    bool changed = false;  ///< out: some pixel took a sample
};

/// A row's counts after its samples were added.
struct AgeRow {
    uint16_t* frames = nullptr;
    const uint16_t* count = nullptr;
    int width = 0;
    int sample_cap = 0;
    int least_frames = 65535, least_count = 65535;  ///< out
};

/// Each treats the row's first pixels and returns how many: all but some at its end.
struct SumKernels {
    /// Adds samples. Sums of more than 255 are left to the caller.
    int (*add)(SumRow& row) = nullptr;
    /// Counts the frame.
    int (*age)(AgeRow& row) = nullptr;
};

/// Null: there are no lanes.
SumKernels sumKernels(SimdTarget target);

}  // namespace still::upscale
