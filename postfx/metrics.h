#pragma once
// How far two pictures are apart: squared error, PSNR, largest difference, SSIM. Exact or in a
// written order, so the numbers are the same on every machine.

#include <cstdint>

#include "rasterizer/image.h"

namespace still {

/// Error over the 8-bit channels of two pictures. Whole numbers, so errors of several frames add up
/// exactly.
struct PixelError {
    uint64_t squared_sum = 0;  ///< Σ (a − b)² over all channels
    uint64_t channels = 0;     ///< 3 · pixels
    int max_difference = 0;    ///< largest |a − b| of any channel, 0 … 255

    bool identical() const { return max_difference == 0; }
    PixelError& operator+=(const PixelError& other);
};

/// The views have equal sizes.
PixelError pixelError(ImageView<const Rgb8> a, ImageView<const Rgb8> b);

/// Peak signal-to-noise ratio in dB for a peak of 255; infinite when identical.
double psnrDb(const PixelError& error);

/// Mean structural similarity of the luma (BT.601 weights), 1 when identical. Windows of 11 × 11
/// with a Gaussian of σ = 1.5 that lie fully inside (Wang, Bovik, Sheikh, Simoncelli: "Image
/// quality assessment: from error visibility to structural similarity", 2004); a picture narrower
/// or lower than a window shortens the window to its own size. The views have equal sizes, not 0.
double ssim(ImageView<const Rgb8> a, ImageView<const Rgb8> b);

}  // namespace still
