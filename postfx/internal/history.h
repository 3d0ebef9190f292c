#pragma once
// What one frame leaves for the next one, and what a resolve kernel sees of both frames.

#include <cstddef>
#include <cstdint>

#include "rasterizer/gbuffer.h"

namespace still::taa {

/// Planes of one frame's history. All share the image's stride (in elements).
/// Invariant: mean · count + rest is the sum of the pixel's samples, and mean is that sum divided
/// by count, rounded half up. |rest| ≤ 127 because count ≤ 255.
template <class U16, class I8, class U8>
struct HistoryPointers {
    U16* mean[3] = {};  ///< red, green, blue in fx12: the image that is shown
    I8* rest[3] = {};
    U8* count = nullptr;
    U16* surface = nullptr;  ///< of the pixel's owner, the nearest sample in its 3×3 window
    U16* depth = nullptr;    ///< logDepth16 of the owner
    U16* normal = nullptr;   ///< of the owner, see compactNormal()
};
using HistoryOut = HistoryPointers<uint16_t, int8_t, uint8_t>;
using HistoryIn = HistoryPointers<const uint16_t, const int8_t, const uint8_t>;

/// The current frame's planes; `normal` may be null.
struct Current {
    const uint16_t* colour[3] = {};
    const uint32_t* depth = nullptr;
    const uint16_t* id = nullptr;
    const uint32_t* normal = nullptr;
    const Motion* motion = nullptr;
    const uint16_t* depth_before = nullptr;
};

/// Everything a kernel needs to resolve any tile of a frame.
struct ResolveJob {
    int width = 0, height = 0;
    ptrdiff_t stride = 0;
    Current now;
    HistoryIn before;
    HistoryOut next;
    /// One bit per surface that was seen standing still this frame; null when nothing moves.
    const uint64_t* at_rest = nullptr;
    int sample_cap = 64;
    bool camera_moved = false;
    bool shading_changed = false;

    bool restsNow(uint16_t surface) const {
        return at_rest == nullptr || ((at_rest[surface >> 6] >> (surface & 63)) & 1) != 0;
    }
};

/// A tile's pixels, clipped to the image.
struct TileRect {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

/// The loops a tile can be resolved with.
enum class TileWork : uint8_t {
    fresh,    ///< no history: every pixel starts with this frame's sample
    still,    ///< nothing moved: each pixel adds its sample until it has enough
    general,  ///< each pixel looks for its history
    idle,     ///< both history buffers already hold the finished tile
};

}  // namespace still::taa
