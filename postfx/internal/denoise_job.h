#pragma once
// What the denoiser's kernels see of a frame.

#include <cstddef>
#include <cstdint>

#include "postfx/denoise.h"
#include "postfx/internal/ring.h"

namespace still::denoising {

using taa::TileRect;

/// Channels of direct light, then of indirect light.
constexpr int kParts = 2;
constexpr int kChannels = 3 * kParts;

/// What is kept of a pixel from frame to frame. Light in the unit of its planes, 1/4096, unrounded.
struct Past {
    float* light[kChannels] = {};  ///< mean of the samples
    float* square[kParts] = {};    ///< mean of their squared luminances
    uint8_t* count[kParts] = {};   ///< so many samples the means are worth
    uint8_t* age[kParts] = {};     ///< frames since light changed, 255 = long
    uint8_t* still = nullptr;      ///< frames for which the pixel has stood still, 255 = long
    float* normal[3] = {};         ///< unit length
    uint16_t* surface = nullptr;   ///< 0: background
    uint16_t* depth = nullptr;     ///< logDepth16
};

/// The surface that a pixel at rest showed before the one that Past tells of: at an edge the
/// samples hit now this one and now that one, and each keeps its light.
struct Other {
    float* light[kChannels] = {};
    float* square[kParts] = {};
    uint8_t* count[kParts] = {};
    uint16_t* surface = nullptr;  ///< 0: none
    uint32_t* stored = nullptr;   ///< Job::frame when it was put here
};

/// Of one part of the light in a block of the frame before: by what it has changed.
struct BlockChange {
    float ratio = 1;   ///< light is this many times what it was …
    float unsure = 0;  ///< … give or take this share of it, 0 … 1
};

/// Planes that are filtered, one after the other.
struct FilterPlanes {
    uint16_t* light[kChannels] = {};
    float* variance[kParts] = {};  ///< of the luminance
};

/// Everything that a kernel needs for any tile of a frame. All planes have the same stride.
struct Job {
    int width = 0, height = 0;
    ptrdiff_t stride = 0;
    const uint16_t* id = nullptr;
    const uint32_t* depth = nullptr;
    const uint32_t* normal = nullptr;
    const Motion* motion = nullptr;
    const uint16_t* depth_before = nullptr;
    const uint16_t* noisy[kChannels] = {};
    float* step[2] = {};  ///< of depth from pixel to pixel, on the pixel's surface
    uint32_t frame = 0;   ///< counts
    bool has_past = false;
    Past before, now;
    Other other;
    const BlockChange* change[kParts] = {};  ///< null: nothing changed
    int blocks_x = 0;
    FilterPlanes first;  ///< what the first pass of the filter reads
    uint8_t* light_age = nullptr;
};

}  // namespace still::denoising
