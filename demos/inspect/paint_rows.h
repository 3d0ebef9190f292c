#pragma once
// Pixel by pixel, rows shared among the workers.

#include "rasterizer/image.h"
#include "rasterizer/workers.h"

namespace still::inspect {

/// out(x, y) = colour(x, y) for every pixel.
template <class T, class Colour>
void paintRows(ImageView<T> out, Workers& workers, Colour&& colour) {
    constexpr int kRowGrain = 16;
    workers.parallelFor(out.height, kRowGrain, [&](int begin, int end, int) {
        for (int y = begin; y < end; ++y) {
            T* row = out.row(y);
            for (int x = 0; x < out.width; ++x) {
                row[x] = colour(x, y);
            }
        }
    });
}

}  // namespace still::inspect
