#include "demos/stillframe/matte.h"

#include <algorithm>

#include "rasterizer/fixed.h"

namespace still::command {
namespace {

/// Coverage, 0 … kColourOne.
int coverage(int red, int green, int blue) {
    const int seen_through = (red + green + blue + 1) / 3;
    return std::clamp(kColourOne - seen_through, 0, int(kColourOne));
}

uint16_t divided(uint16_t light_fx12, int alpha) {
    const int whole = (int(light_fx12) * int(kColourOne) + alpha / 2) / alpha;
    return uint16_t(std::min(whole, 65535));
}

}  // namespace

Image<Rgba8> matte(const ColourPlanes& black, const ColourPlanes& white, const OutputTable& table) {
    Image<Rgba8> result(black.red.width, black.red.height);
    for (int y = 0; y < result.height(); ++y) {
        for (int x = 0; x < result.width(); ++x) {
            const uint16_t r = black.red.at(x, y), g = black.green.at(x, y),
                           b = black.blue.at(x, y);
            const int alpha =
                coverage(white.red.at(x, y) - r, white.green.at(x, y) - g, white.blue.at(x, y) - b);
            const uint8_t alpha8 = uint8_t((alpha * 255 + kColourOne / 2) / kColourOne);
            result.at(x, y) = alpha8 == 0
                                  ? Rgba8{0, 0, 0, 0}
                                  : Rgba8{table[divided(r, alpha)], table[divided(g, alpha)],
                                          table[divided(b, alpha)], alpha8};
        }
    }
    return result;
}

}  // namespace still::command
