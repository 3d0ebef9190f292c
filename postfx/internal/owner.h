#pragma once
// Whose motion a pixel follows.

#include "postfx/internal/ring.h"

namespace still::taa {

/// The nearest sample of a pixel's 3×3 window, or one that must be there though no sample hit it.
struct Owner {
    int surface = 0;
    int depth = 0;     ///< logDepth16
    int expected = 0;  ///< logDepth16 that it had in the previous frame
    Motion motion;
    uint32_t normal = 0;  ///< compactNormal(), 0 without normals
    int slope = 0;        ///< its own change of depth per pixel, at most kMaxSlope, 0 where unknown
    bool moved = false;   ///< belongs to an object that moved
    bool inferred = false;
};

/// What the gather wants to know of a pixel's owner beside the record: twice the change of depth
/// towards the frame before, within ±kMaxStep, plus 1 when it moved.
int16_t ownerHint(const Owner& owner) noexcept;

/// Of this frame's samples. Ties: middle before top before bottom, middle before left before right.
Owner seenOwner(const Job& job, int x, int y) noexcept;

/// A line thinner than a pixel is missed by whole windows of samples. When the previous frame's
/// owner at the place where `seen` was lies in front of it, and the way that owner was going leads
/// here, it is still here. An inferred owner does not infer another one.
Owner inferOwner(const Job& job, int x, int y, const Owner& seen) noexcept;

/// Writes the pixels' samples and owners into job.record.
void recordTileReference(const Job& job, const TileRect& tile) noexcept;

}  // namespace still::taa
