#pragma once
// Alpha from two renderings of the same frame, over black and over white: what differs between them
// is what shows of the background (difference matting). Exact, to the last bit of linear light,
// where a picture is a mean of samples: finished ones, ssaa and none. Others mix by colour too, so
// their edges may be off by a little.

#include "engine/texture.h"
#include "postfx/encode.h"

namespace still::command {

/// alpha = 1 − (white − black), mean of the channels; colours are those over black divided by
/// alpha, in linear light, then encoded by `table`. Black where alpha is 0. Planes of equal size.
Image<Rgba8> matte(const ColourPlanes& black, const ColourPlanes& white, const OutputTable& table);

}  // namespace still::command
