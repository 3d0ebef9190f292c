#pragma once
// The last raw frames, and what a kernel sees of them.

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "postfx/taa.h"
#include "rasterizer/gbuffer.h"

namespace still::taa {

/// Where the samples of one of a slot's tiles lie. A tile that rests keeps those of an older frame.
struct TileJitter {
    int16_t x_fx8 = 0, y_fx8 = 0;

    bool sameAs(const TileJitter& o) const { return x_fx8 == o.x_fx8 && y_fx8 == o.y_fx8; }
};

/// One frame's samples. The owner of a pixel is the nearest sample of its 3×3 window. All planes
/// share the image's stride (in elements). Planes of 16-bit lanes: values of 0 … 65535 are kept
/// less kOffset, so that they compare, saturate and multiply as signed numbers.
template <class I16>
struct SlotPointers {
    I16* colour[3] = {};         ///< fx12 − kOffset
    I16* id = nullptr;           ///< bits of the G-buffer's id: negative where moved
    I16* depth = nullptr;        ///< logDepth16 − kOffset of the sample …
    I16* owner_depth = nullptr;  ///< … and of the owner
    I16* owner = nullptr;        ///< surface of the owner, kInferredBit
    I16* motion[2] = {};         ///< of the owner, as in GBuffer::motion: x, y
    I16* normal = nullptr;       ///< compactNormal() of the owner; 0 when the G-buffer has none
    int jitter_x_fx8 = 0, jitter_y_fx8 = 0;
    const TileJitter* tile_jitter = nullptr;  ///< of each tile, row by row; null: all lie as above
};
using SlotOut = SlotPointers<int16_t>;
using SlotIn = SlotPointers<const int16_t>;

constexpr int kOffset = 32768;
constexpr int16_t lessOffset(int v) {
    return int16_t(v - kOffset);
}
constexpr int plusOffset(int16_t v) {
    return v + kOffset;
}

/// The owner was not seen in this frame's window but must be there: see inferOwner().
constexpr int kInferredBit = 0x8000;

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
/// sum divided by count, rounded half up. |rest| ≤ 127 because count ≤ 255. From Job::settled
/// samples on, the mean is what Job::shown shows, and stands there only.
struct StillSums {
    uint16_t* mean[3] = {};  ///< of fewer samples
    int8_t* rest[3] = {};
    uint8_t* count = nullptr;
};

/// Everything a kernel needs for any tile of a frame.
struct Job {
    int width = 0, height = 0;
    int tiles_x = 0;
    ptrdiff_t stride = 0;
    Current now;
    int frames = 1;           ///< valid slots, this frame's included: 1 … kMaxRing
    SlotOut record;           ///< this frame's slot …
    SlotIn slot[kMaxRing];    ///< … which is also slot[0]; slot[k] is k frames old
    int16_t* hint = nullptr;  ///< of this frame's owners: see ownerHint()
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
    /// TaaFrame::light_age; null when light is long as it is.
    const uint8_t* light_age = nullptr;
    int sample_cap = 64;
    int settled = 8;  ///< min(kSettled, sample_cap)
    bool camera_moved = false;
    /// What the centre's sample shows of the nearest one's surface may lie so much farther and own
    /// the pixel still: kDepthTolerance, more where pixels are large.
    int centre_tolerance = 48;
};

/// A tile's pixels, clipped to the image.
struct TileRect {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};
inline TileRect tileRect(int tile, int width, int height) {
    const int across = (width + kTileSize - 1) / kTileSize;
    const int x0 = tile % across * kTileSize, y0 = tile / across * kTileSize;
    return {x0, y0, std::min(x0 + kTileSize, width), std::min(y0 + kTileSize, height)};
}

/// The tile of a slot with `tile_jitter` that holds a pixel, or the nearest pixel of the picture.
inline const TileJitter& jitterOf(const Job& job, const SlotIn& slot, int column, int row) {
    const int x = std::clamp(column, 0, job.width - 1) / kTileSize;
    const int y = std::clamp(row, 0, job.height - 1) / kTileSize;
    return slot.tile_jitter[y * job.tiles_x + x];
}

}  // namespace still::taa
