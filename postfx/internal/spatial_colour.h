#pragma once
// SpatialEdges::colour, row by row. Source: T. Lottes, "FXAA" (2009): which pixels, which side, how
// far from the ends of the edge; and his filter for single pixels.

#include "postfx/spatial.h"

namespace still::spatial {

/// Brightness of row `y` on a scale near the eye's: √luma, 255 = white; HDR saturates.
void brightnessRow(const ColourPlanes& colour, int y, uint8_t* brightness);

/// Filters row `y`; needs the brightness of the whole picture.
void colourRow(const ColourPlanes& colour, ImageView<const uint8_t> brightness, int y,
               const ColourTargets& out);

}  // namespace still::spatial
