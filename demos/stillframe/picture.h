#pragma once
// A finished frame on its way to a file.

#include "engine/texture.h"
#include "rasterizer/image.h"

namespace still::command {

/// One of the two views is set. Files take colours as they are and alpha as coverage: colours are
/// not multiplied by it.
struct Picture {
    ImageView<const Rgb8> opaque;
    ImageView<const Rgba8> matted;

    Picture(ImageView<const Rgb8> image) : opaque(image) {}
    Picture(ImageView<Rgb8> image) : opaque(image) {}
    Picture(ImageView<const Rgba8> image) : matted(image) {}
    bool hasAlpha() const { return matted.width > 0; }
    int width() const { return hasAlpha() ? matted.width : opaque.width; }
    int height() const { return hasAlpha() ? matted.height : opaque.height; }
};

}  // namespace still::command
