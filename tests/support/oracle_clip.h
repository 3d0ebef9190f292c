#pragma once
// The oracle's clipper and snapping, apart from the rest because only this part knows the planes.

#include "tests/support/oracle_rasterizer.h"

namespace still::oracle {

/// Fills `polygon` and `clipped` from `clip`. Vertices that need no clipping are snapped with the
/// float operations of the fast rasterizer; the others are clipped in double (Sutherland, Hodgman
/// 1974: near plane, then left, right, bottom, top of the guard band).
void clipAndSnap(Triangle& triangle, const FrameView& view);

}  // namespace still::oracle
