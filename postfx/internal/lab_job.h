#pragma once
// What a resolve of the laboratory reads and writes.
//
// Colours are worked on in 16 bits ("working colour"): linear light in fx12, or, with
// Tone::reinhard, c / (1 + max(r, g, b)) in fx15. History keeps 8 more bits of them (suffix _w24):
// with less, a blend of a few percent would stop short of its target.

#include <cstddef>
#include <cstdint>

#include "postfx/limits.h"
#include "postfx/policy.h"
#include "rasterizer/gbuffer.h"

namespace still::lab {

/// Planes of one frame's history; pointers are to pixel (0, 0), all share ResolveJob's
/// history_stride. Only those that the policy reads are written; the last four describe the pixel
/// whose motion was used (see Dilation).
template <class U32, class U8, class U16, class M>
struct HistoryPointers {
    U32* colour_w24[3] = {};
    U8* memory = nullptr;  ///< Blend::mean: samples in it; Blend::confidence: confidence, 255 = 1
    U16* depth = nullptr;  ///< logDepth16
    U16* surface = nullptr;
    U16* normal = nullptr;  ///< see compactNormal()
    M* motion = nullptr;
};
using HistoryOut = HistoryPointers<uint32_t, uint8_t, uint16_t, Motion>;
using HistoryIn = HistoryPointers<const uint32_t, const uint8_t, const uint16_t, const Motion>;

/// The current frame's planes; `normal` is null unless the policy tests normals.
struct Current {
    const uint16_t* colour[3] = {};
    const uint32_t* depth = nullptr;
    const uint16_t* id = nullptr;
    const uint32_t* normal = nullptr;
    const Motion* motion = nullptr;
    const uint16_t* depth_before = nullptr;
};

/// Numbers that follow from policy and jitter, the same for all pixels.
struct FrameConstants {
    int32_t sample_weight_q12[9] = {};  ///< row by row; their sum is 4096
    uint32_t sigma_q12 = 0;             ///< see sigmaFactor(): k at speed …
    uint32_t sigma_still_q12 = 0;       ///< … and at rest
    int32_t speed_limit_fx8 = 0;        ///< TaaPolicy::sigma_speed
    uint32_t inverse_speed = 0;         ///< 2^24 / speed_limit_fx8
    uint32_t normal_square_q15 = 0;     ///< of TaaPolicy::normal_reject_q15
    uint32_t count_share_q16 = 0;       ///< 255 / (count_cap − 1)
};

struct ResolveJob {
    int width = 0, height = 0;
    ptrdiff_t stride = 0;  ///< of the current frame's planes, `shown` and `confidence`
    ptrdiff_t history_stride = 0;
    Current now;
    HistoryIn before;
    HistoryOut next;
    uint16_t* shown[3] = {};        ///< null in builds for boards: see Laboratory
    uint8_t* confidence = nullptr;  ///< null there, too
    TaaPolicy policy;
    FrameConstants constants;
    bool has_history = false;
};

/// A tile's pixels, clipped to the image.
struct TileRect {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

/// Most tests that can fail: depth, normal, surface, motion, luminance.
constexpr int kTests = 5;

/// Resolves one tile and writes history and the shown planes.
using TileKernel = void (*)(const ResolveJob&, const TileRect&) noexcept;

}  // namespace still::lab
