#pragma once
// 256 colours for one picture.
// Sources: Heckbert, "Color Image Quantization for Frame Buffer Display", 1982 (median cut);
// Bayer, "An optimum method for two-level rendition of continuous-tone pictures", 1973.

#include <array>
#include <cstdint>
#include <vector>

#include "rasterizer/image.h"

namespace still::command {

struct GifPalette {
    std::array<Rgb8, 256> colours{};
    int count = 0;  ///< 1 … 256; the others are black
};

/// Median cut over a histogram of 5 bits a channel. The same pixels give the same palette.
GifPalette choosePalette(ImageView<const Rgb8> image);

/// Palette index of each pixel, row by row without padding, after ordered dithering: its pattern
/// stands still on the screen, so surfaces that do not move do not boil.
std::vector<uint8_t> applyPalette(ImageView<const Rgb8> image, const GifPalette& palette);

}  // namespace still::command
