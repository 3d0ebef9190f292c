#include "demos/stillframe/difference.h"

#include <algorithm>
#include <cstdlib>

namespace still::command {

Image<Rgb8> differencePicture(ImageView<const Rgb8> a, ImageView<const Rgb8> b) {
    Image<Rgb8> picture(a.width, a.height);
    for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width; ++x) {
            const Rgb8 p = a.at(x, y);
            const Rgb8 q = b.at(x, y);
            const int most =
                std::max({std::abs(p.r - q.r), std::abs(p.g - q.g), std::abs(p.b - q.b)});
            const uint8_t grey = uint8_t((p.r + 2 * p.g + p.b) / 16);
            // A difference of 1 must be visible, 64 and more are all the same to the eye.
            const uint8_t green = uint8_t(std::min(255, most * 4));
            picture.at(x, y) = most == 0 ? Rgb8{grey, grey, grey} : Rgb8{255, green, 0};
        }
    }
    return picture;
}

}  // namespace still::command
