#pragma once
// Which part of the history belongs to a pixel: dilated motion, 2×2 taps tested one by one, 4×4
// Catmull-Rom where all taps agree, 3×3 as a last resort. Scalar truth.
//
// Sources: Schied et al., "Spatiotemporal Variance-Guided Filtering" (HPG 2017), for per-tap tests
// and the 3×3 fallback; Karis, "High-Quality Temporal Supersampling" (SIGGRAPH 2014), for motion
// dilation; Catmull and Rom 1974. The tests by exact surface, expected depth and stillness are
// ours.

#include "postfx/internal/history.h"

namespace still::taa {

/// The nearest sample of a pixel's 3×3 window. Its motion and depth stand for the pixel, so that a
/// silhouette's soft rim moves with the surface in front.
struct Owner {
    uint16_t id = 0;        ///< with kMovedBit
    uint16_t depth = 0;     ///< log
    uint16_t expected = 0;  ///< log depth it had in the previous frame
    uint16_t normal = 0;
    Motion motion;
    int slope = 0;  ///< log depth from the centre to the owner, 0 when the surfaces differ
};

/// History as found, before this frame's sample. count = 0: none.
struct Past {
    int mean[3] = {}, rest[3] = {};
    int count = 0;
    bool proven = false;   ///< same place, nothing moved: no limit but the cap
    bool suspect = false;  ///< must be held against this frame's colours
};

Owner findOwner(const ResolveJob& job, int x, int y) noexcept;
Past findPast(const ResolveJob& job, int x, int y, const Owner& owner) noexcept;

}  // namespace still::taa
