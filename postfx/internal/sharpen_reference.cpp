#include "postfx/internal/sharpen_kernel.h"

namespace still::sharpening {

void sharpenRowReference(const Rows& rows, int width, int gain, uint16_t* out) {
    for (int x = 0; x < width; ++x) {
        const int own_gain =
            rows.confidence == nullptr ? gain : confidentGain(gain, rows.confidence[x]);
        out[x] = uint16_t(sharpened(rows.here[x], rows.above[x], rows.here[x - 1], rows.here[x + 1],
                                    rows.below[x], own_gain));
    }
}

}  // namespace still::sharpening
