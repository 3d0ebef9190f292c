#pragma once
// Where filters write: the counterpart of ColourPlanes.

#include <cstdint>

#include "rasterizer/image.h"

namespace still {

/// Linear light, fx12, planar; written. Rows are padded as in Image.
struct ColourTargets {
    ImageView<uint16_t> red, green, blue;
};

}  // namespace still
