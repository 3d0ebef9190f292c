#include "demos/inspect/canvas.h"

#include <algorithm>
#include <cstring>
#include <vector>

namespace still::inspect {
namespace {

constexpr int kRowGrain = 16;

/// Between which two pixels of the picture a pixel of the window lies, and how far from the first,
/// in 1/256.
struct Between {
    int first = 0, second = 0, part_q8 = 0;
};

Between betweenAt(int place, int count, int wanted) {
    // Centre of the pixel in the picture, in 1/256 of its pixels, less half a pixel.
    const int64_t at = (int64_t{2} * place + 1) * count * 128 / wanted - 128;
    const int first = int(at >> 8);
    return {std::clamp(first, 0, count - 1), std::clamp(first + 1, 0, count - 1), int(at & 255)};
}

int mix(int a, int b, int part_q8) {
    return (a * (256 - part_q8) + b * part_q8 + 128) >> 8;
}

Rgb8 mixRgb(Rgb8 a, Rgb8 b, int part_q8) {
    return {uint8_t(mix(a.r, b.r, part_q8)), uint8_t(mix(a.g, b.g, part_q8)),
            uint8_t(mix(a.b, b.b, part_q8))};
}

}  // namespace

void placePicture(ImageView<const Rgb8> picture, int begin, int end, bool smooth,
                  ImageView<Rgb8> out, Workers& workers) {
    if (begin >= end) {
        return;
    }
    const bool same = picture.width == out.width && picture.height == out.height;
    std::vector<Between> columns;
    for (int x = begin; x < end && !same; ++x) {
        columns.push_back(betweenAt(x, picture.width, out.width));
    }
    workers.parallelFor(out.height, kRowGrain, [&](int first_row, int end_row, int) {
        for (int y = first_row; y < end_row; ++y) {
            Rgb8* to = out.row(y) + begin;
            if (same) {
                std::memcpy(to, picture.row(y) + begin, size_t(end - begin) * sizeof(Rgb8));
                continue;
            }
            const Between rows = betweenAt(y, picture.height, out.height);
            const Rgb8* upper = picture.row(rows.first);
            const Rgb8* lower = picture.row(rows.second);
            const Rgb8* nearest = picture.row(int(int64_t{y} * picture.height / out.height));
            for (int x = begin; x < end; ++x) {
                const Between& c = columns[size_t(x - begin)];
                *to++ = smooth ? mixRgb(mixRgb(upper[c.first], upper[c.second], c.part_q8),
                                        mixRgb(lower[c.first], lower[c.second], c.part_q8),
                                        rows.part_q8)
                               : nearest[int64_t{x} * picture.width / out.width];
            }
        }
    });
}

void fillRectangle(ImageView<Rgb8> out, int x, int y, int width, int height, Rgb8 colour) {
    const int end_x = std::min(x + width, out.width), end_y = std::min(y + height, out.height);
    for (int row = std::max(y, 0); row < end_y; ++row) {
        for (int column = std::max(x, 0); column < end_x; ++column) {
            out.row(row)[column] = colour;
        }
    }
}

}  // namespace still::inspect
