#pragma once
// Holds a colour against the 3×3 window of this frame's samples (mean ± deviation in YCoCg): the
// only evidence left when nothing proves that history belongs to a pixel. Costs fine detail, so it
// is used nowhere else.
//
// Source: Salvi, "An Excursion in Temporal Supersampling" (GDC 2016).

#include "postfx/internal/history.h"

namespace still::taa {

/// Clamps `rgb` (fx12). Returns whether it was changed.
bool clipToWindow(const ResolveJob& job, int x, int y, int rgb[3]) noexcept;

}  // namespace still::taa
