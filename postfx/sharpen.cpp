#include "postfx/sharpen.h"

#include <cassert>

#include "postfx/internal/sharpen_kernel.h"

namespace still {
namespace {

using sharpening::Rows;

constexpr int kRowGrain = 16;

/// One pixel whose neighbours may lie outside, where pixels repeat.
int borderPixel(const Rows& rows, int x, int width, int gain) {
    const int left = rows.here[std::max(x - 1, 0)], right = rows.here[std::min(x + 1, width - 1)];
    const int own_gain =
        rows.confidence == nullptr ? gain : sharpening::confidentGain(gain, rows.confidence[x]);
    return sharpening::sharpened(rows.here[x], rows.above[x], left, right, rows.below[x], own_gain);
}

}  // namespace

void sharpen(const ColourPlanes& in, ImageView<const uint8_t> confidence, int sharpness_q15,
             const ColourTargets& out, SimdTarget simd, Workers& workers) {
    assert(sharpness_q15 >= 0 && sharpness_q15 <= kFullSharpness_q15);
    assert(in.red.width == out.red.width && in.red.height == out.red.height && !in.red.empty());
    assert(confidence.empty() || confidence.width == in.red.width);
    const ImageView<const uint16_t> from[3] = {in.red, in.green, in.blue};
    const ImageView<uint16_t> to[3] = {out.red, out.green, out.blue};
    const int width = in.red.width, last = in.red.height - 1;
    const int gain = sharpening::fullGain(sharpness_q15);
    const sharpening::RowKernel kernel = sharpening::rowKernel(simd);
    workers.parallelFor(in.red.height, kRowGrain, [&](int begin, int end, int) {
        for (int y = begin; y < end; ++y) {
            for (int c = 0; c < 3; ++c) {
                const Rows rows{from[c].row(std::max(y - 1, 0)), from[c].row(y),
                                from[c].row(std::min(y + 1, last)),
                                confidence.empty() ? nullptr : confidence.row(y)};
                uint16_t* row = to[c].row(y);
                kernel(rows, width, gain, row);
                row[0] = uint16_t(borderPixel(rows, 0, width, gain));
                row[width - 1] = uint16_t(borderPixel(rows, width - 1, width, gain));
            }
        }
    });
}

}  // namespace still
