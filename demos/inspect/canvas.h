#pragma once
// The window's picture: panes scaled to its size, and lines.

#include "rasterizer/image.h"
#include "rasterizer/workers.h"

namespace still::inspect {

/// Writes columns begin … end − 1 of `out` from `picture`, which covers all of `out`: bilinear, or
/// as squares.
void placePicture(ImageView<const Rgb8> picture, int begin, int end, bool smooth,
                  ImageView<Rgb8> out, Workers& workers);

/// A rectangle, clipped to `out`.
void fillRectangle(ImageView<Rgb8> out, int x, int y, int width, int height, Rgb8 colour);

}  // namespace still::inspect
