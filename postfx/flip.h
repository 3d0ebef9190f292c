#pragma once
// LDR-FLIP: how different two pictures look when one flips between them on a screen.
// P. Andersson, J. Nilsson, T. Akenine-Möller, M. Oskarsson, K. Åström, M. Fairchild: "FLIP: a
// difference evaluator for alternating images" (2020). Uses the C library's pow, exp and cbrt:
// equal to about six digits on different machines, not to the bit.

#include "rasterizer/image.h"
#include "rasterizer/workers.h"

namespace still {

struct FlipSettings {
    /// Of the viewer's field; the default is 0.7 m in front of a 0.7 m wide screen of 3840 pixels.
    double pixels_per_degree = 67.0206;
};

/// The error of every pixel, 0 (equal) … 1. Views are sRGB-encoded, of equal sizes, not empty.
/// Symmetric in `reference` and `test`.
Image<float> flipMap(ImageView<const Rgb8> reference, ImageView<const Rgb8> test,
                     const FlipSettings& settings, Workers& workers);

/// Mean of flipMap(): the number that is meant by "FLIP". The same for any number of threads.
double meanFlip(ImageView<const Rgb8> reference, ImageView<const Rgb8> test,
                const FlipSettings& settings, Workers& workers);

}  // namespace still
