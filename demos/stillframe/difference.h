#pragma once
// A picture of where two pictures differ.

#include "rasterizer/image.h"

namespace still::command {

/// Equal pixels dim and grey, different ones red to yellow by their largest channel. The views have
/// equal sizes.
Image<Rgb8> differencePicture(ImageView<const Rgb8> a, ImageView<const Rgb8> b);

}  // namespace still::command
