#pragma once
// The 3×3 window of this frame's samples: the pixel's own colour, and what history is held against.
// Scalar truth.
//
// Sources: Karis, "High-Quality Temporal Supersampling" (SIGGRAPH 2014), for clamping and clipping
// in YCoCg and for tone-mapped samples; Salvi, "An Excursion in Temporal Supersampling" (GDC 2016),
// for μ ± kσ; Pedersen, "Temporal Reprojection Anti-Aliasing in INSIDE" (GDC 2016), for the rounded
// box.

#include "postfx/internal/lab_job.h"
#include "postfx/internal/lab_rules.h"

namespace still::lab {

/// Working colours, row by row. Beyond the border the picture's last row and column repeat.
struct Window {
    Rgb sample[9];
};

Window loadWindow(const ResolveJob& job, int x, int y) noexcept;

/// The pixel's colour of this frame by TaaPolicy::sample.
Rgb filteredSample_w24(const ResolveJob& job, const Window& window) noexcept;

/// Middle and half width of what history may be, per channel of TaaPolicy::space.
struct Box {
    int32_t low[3], high[3], middle[3], half[3];
};

/// The box of TaaPolicy::rectification; without one, the window's extent. `speed_fx8` as below.
Box boxOf(const ResolveJob& job, const Window& window, int speed_fx8) noexcept;

/// Holds history against the window. `speed_fx8` is the pixel's, 1/256 pixel a frame. Returns
/// whether `history` was changed.
bool rectify(const ResolveJob& job, const Window& window, int speed_fx8, Rgb& history) noexcept;

}  // namespace still::lab
