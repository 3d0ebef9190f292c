#include "demos/stillframe/error_crop.h"

#include <algorithm>
#include <cstdlib>
#include <vector>

namespace still::command {
namespace {

/// Windows are tried at every so many pixels.
constexpr int kStep = 4;
constexpr int kGain = 4;

uint64_t squaredError(Rgb8 a, Rgb8 b) {
    const int r = a.r - b.r;
    const int g = a.g - b.g;
    const int blue = a.b - b.b;
    return uint64_t(r * r + g * g + blue * blue);
}

/// Sum of the errors above and left of each corner, one more than pixels in both directions.
class ErrorSums {
  public:
    ErrorSums(ImageView<const Rgb8> a, ImageView<const Rgb8> b)
        : width_(size_t(a.width) + 1), sums_(width_ * (size_t(a.height) + 1)) {
        for (int y = 0; y < a.height; ++y) {
            uint64_t row = 0;
            for (int x = 0; x < a.width; ++x) {
                row += squaredError(a.at(x, y), b.at(x, y));
                sums_[index(x + 1, y + 1)] = sums_[index(x + 1, y)] + row;
            }
        }
    }
    uint64_t inside(int x, int y, int width, int height) const {
        return sums_[index(x + width, y + height)] - sums_[index(x, y + height)] -
               sums_[index(x + width, y)] + sums_[index(x, y)];
    }

  private:
    size_t index(int x, int y) const { return size_t(y) * width_ + size_t(x); }

    size_t width_;
    std::vector<uint64_t> sums_;
};

uint8_t brightened(uint8_t a, uint8_t b) {
    return uint8_t(std::min(255, kGain * std::abs(a - b)));
}

}  // namespace

void ErrorCrop::look(int frame, ImageView<const Rgb8> picture, ImageView<const Rgb8> reference) {
    const int width = std::min(kCropSize, picture.width);
    const int height = std::min(kCropSize, picture.height);
    const ErrorSums sums(picture, reference);
    bool found = strip_.empty();
    for (int y = 0; y <= picture.height - height; y += kStep) {
        for (int x = 0; x <= picture.width - width; x += kStep) {
            const uint64_t error = sums.inside(x, y, width, height);
            if (error > worst_ || (found && x == 0 && y == 0)) {
                worst_ = error;
                frame_ = frame;
                x_ = x;
                y_ = y;
                found = true;
            }
        }
    }
    if (found && frame_ == frame) {
        cut(picture, reference);
    }
}

void ErrorCrop::cut(ImageView<const Rgb8> picture, ImageView<const Rgb8> reference) {
    const int width = std::min(kCropSize, picture.width);
    const int height = std::min(kCropSize, picture.height);
    strip_.resize(3 * width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const Rgb8 p = picture.at(x_ + x, y_ + y);
            const Rgb8 q = reference.at(x_ + x, y_ + y);
            strip_.at(x, y) = p;
            strip_.at(width + x, y) = q;
            strip_.at(2 * width + x, y) = {brightened(p.r, q.r), brightened(p.g, q.g),
                                           brightened(p.b, q.b)};
        }
    }
}

}  // namespace still::command
