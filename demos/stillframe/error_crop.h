#pragma once
// The place where a picture is farthest from its reference, cut out for people to look at.

#include <cstdint>

#include "rasterizer/image.h"

namespace still::command {

/// Sides of a crop, in pixels; smaller pictures are cut out whole.
constexpr int kCropSize = 32;

/// Remembers the worst window of all pictures shown to it.
class ErrorCrop {
  public:
    /// The views have equal sizes.
    void look(int frame, ImageView<const Rgb8> picture, ImageView<const Rgb8> reference);

    int frame() const { return frame_; }
    int x() const { return x_; }  ///< of the top left pixel
    int y() const { return y_; }
    /// Side by side without gaps: picture, reference, and their difference four times as bright.
    ImageView<const Rgb8> strip() const { return strip_.view(); }

  private:
    void cut(ImageView<const Rgb8> picture, ImageView<const Rgb8> reference);

    uint64_t worst_ = 0;
    int frame_ = 0, x_ = 0, y_ = 0;
    Image<Rgb8> strip_;
};

}  // namespace still::command
