#pragma once
// The last raw frames, and what a kernel sees of them.

#include <cstddef>
#include <cstdint>

#include "postfx/taa.h"
#include "rasterizer/gbuffer.h"

namespace still::taa {

/// One frame's samples. The owner of a pixel is the nearest sample of its 3×3 window. All planes
/// share the image's stride (in elements).
template <class U32>
struct SlotPointers {
    U32* red_green = nullptr;  ///< fx12, red in the low half
    U32* blue_id = nullptr;    ///< blue fx12 in the low half, id of the sample in the high
    U32* depths = nullptr;  ///< logDepth16 of the sample in the low half, of the owner in the high
    U32* motion = nullptr;  ///< of the owner, as in GBuffer::motion, x in the low half
    U32* owner =
        nullptr;  ///< low half: surface of the owner, kInferredBit; high: its compactNormal()
    int jitter_x_fx8 = 0, jitter_y_fx8 = 0;
};
using SlotOut = SlotPointers<uint32_t>;
using SlotIn = SlotPointers<const uint32_t>;

/// The owner was not seen in this frame's window but must be there: see inferOwner().
constexpr uint32_t kInferredBit = 0x8000;

/// The current frame's planes; `normal` may be null.
struct Current {
    const uint16_t* colour[3] = {};
    const uint32_t* depth = nullptr;
    const uint16_t* id = nullptr;
    const uint32_t* normal = nullptr;
    const Motion* motion = nullptr;
    const uint16_t* depth_before = nullptr;
};

/// Sums of the samples of pixels that stand still. mean · count + rest is the sum, and mean is the
/// sum divided by count, rounded half up. |rest| ≤ 127 because count ≤ 255. From Job::settled samples
/// on, the mean is what Job::shown shows, and stands there only.
struct StillSums {
    uint16_t* mean[3] = {};  ///< of fewer samples
    int8_t* rest[3] = {};
    uint8_t* count = nullptr;
};

/// Everything a kernel needs for any tile of a frame.
struct Job {
    int width = 0, height = 0;
    ptrdiff_t stride = 0;
    Current now;
    int frames = 1;         ///< valid slots, this frame's included: 1 … kMaxRing
    SlotOut record;         ///< this frame's slot …
    SlotIn slot[kMaxRing];  ///< … which is also slot[0]; slot[k] is k frames old
    StillSums sums;
    uint16_t* shown[3] = {};         ///< the resolved image
    uint8_t* shown_count = nullptr;  ///< samples in it; gathered pixels: frames, rounded
    /// Frames since a surface's shading changed, by surface number, 255 = long ago; null when none
    /// changed within the ring.
    const uint32_t* change_age = nullptr;
    /// The same since a surface began to move: what was seen of it before is no longer there.
    const uint32_t* start_age = nullptr;
    /// 1 for surfaces of objects that turn or bend, by surface number; null when there are none.
    const uint32_t* turning = nullptr;
    int sample_cap = 64;
    int settled = 8;  ///< min(kSettled, sample_cap)
    bool camera_moved = false;
};

/// A tile's pixels, clipped to the image.
struct TileRect {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

constexpr int lowHalf(uint32_t v) {
    return int(v & 0xFFFF);
}
constexpr int highHalf(uint32_t v) {
    return int(v >> 16);
}
constexpr uint32_t packHalves(uint32_t low, uint32_t high) {
    return low | (high << 16);
}
constexpr Motion unpackMotion(uint32_t v) {
    return {int16_t(v & 0xFFFF), int16_t(v >> 16)};
}
constexpr uint32_t packMotion(Motion m) {
    return packHalves(uint16_t(m.x_fx8), uint16_t(m.y_fx8));
}

}  // namespace still::taa
