#include "demos/inspect/magnifier.h"

#include <algorithm>

#include "demos/inspect/canvas.h"
#include "demos/inspect/lines.h"

namespace still::inspect {
namespace {

constexpr Rgb8 kFrame{255, 255, 255};
constexpr Rgb8 kOutside{40, 40, 40};
constexpr Rgb8 kGrid{128, 128, 128};
constexpr Rgb8 kMiddle{255, 255, 255};
constexpr Rgb8 kPicked{255, 140, 0};
constexpr Rgb8 kNow{255, 0, 0};
constexpr int kGridOpacity = 90;

void frameSquare(ImageView<Rgb8> out, int x, int y, int size, Rgb8 colour) {
    fillRectangle(out, x, y, size, 1, colour);
    fillRectangle(out, x, y + size - 1, size, 1, colour);
    fillRectangle(out, x, y, 1, size, colour);
    fillRectangle(out, x + size - 1, y, 1, size, colour);
}

bool isInside(const ImageView<const Rgb8>& picture, int x, int y) {
    return x >= 0 && y >= 0 && x < picture.width && y < picture.height;
}

/// One pane's lens with its upper left corner at (left, top).
struct Lens {
    const LensSource& source;
    ImageView<Rgb8> out;
    int left, top, pixels, factor;

    int firstX() const { return source.middle.x - pixels / 2; }
    int firstY() const { return source.middle.y - pixels / 2; }

    void drawPixels(bool grid) const {
        for (int row = 0; row < pixels * factor; ++row) {
            for (int column = 0; column < pixels * factor; ++column) {
                const int x = left + column, y = top + row;
                if (x < 0 || y < 0 || x >= out.width || y >= out.height) {
                    continue;
                }
                const int from_x = firstX() + column / factor, from_y = firstY() + row / factor;
                const bool inside = isInside(source.picture, from_x, from_y);
                Rgb8& pixel = out.row(y)[x];
                pixel = inside ? source.picture.at(from_x, from_y) : kOutside;
                if (grid && (column % factor == 0 || row % factor == 0)) {
                    pixel = blend(pixel, kGrid, kGridOpacity);
                }
            }
        }
    }
    void frame(LensPixel pixel, Rgb8 colour) const {
        const int column = pixel.x - firstX(), row = pixel.y - firstY();
        if (column >= 0 && row >= 0 && column < pixels && row < pixels) {
            frameSquare(out, left + column * factor - 1, top + row * factor - 1, factor + 2,
                        colour);
        }
    }
    /// The middle pixel once more, larger, in the lower left corner, with the pattern in it.
    void drawPattern() const {
        const int side = std::max(pixels * factor / 3, 17);
        const int x0 = left, y0 = top + pixels * factor - side;
        const bool inside = isInside(source.picture, source.middle.x, source.middle.y);
        const Rgb8 under = inside ? source.picture.at(source.middle.x, source.middle.y) : kOutside;
        const bool bright = 2 * under.r + 5 * under.g + under.b > 8 * 110;
        const Rgb8 ink = bright ? Rgb8{0, 0, 0} : Rgb8{255, 255, 255};
        fillRectangle(out, x0, y0, side, side, under);
        frameSquare(out, x0 - 1, y0 - 1, side + 2, kMiddle);
        const auto dot = [&](SampleOffset offset, int size, Rgb8 colour) {
            fillRectangle(out, x0 + (offset.x_fx8 + 128) * side / 256 - size / 2,
                          y0 + (offset.y_fx8 + 128) * side / 256 - size / 2, size, size, colour);
        };
        const int size = side >= 64 ? 2 : 1;
        for (const SampleOffset offset : source.pattern) {
            dot(offset, size, ink);
        }
        dot(source.now, size + 2, kNow);
    }
};

}  // namespace

int lensPixels(int factor, int window_width, int window_height) {
    const int fits = std::min(window_width, window_height) * 2 / 5 / factor;
    return std::max(fits, 5) | 1;
}

void drawMagnifier(const Magnifier& magnifier, std::span<const LensSource> panes,
                   ImageView<Rgb8> out) {
    const int factor = std::clamp(magnifier.factor, 2, 64);
    const int pixels = lensPixels(factor, out.width, out.height);
    const int side = pixels * factor, width = side * int(panes.size());
    const auto within = [](int wanted, int size, int room) {
        return std::clamp(wanted, 1, std::max(1, room - size - 1));
    };
    const int left = within(magnifier.x - width / 2, width, out.width);
    const int top = within(magnifier.y - side / 2, side, out.height);
    fillRectangle(out, left - 1, top - 1, width + 2, side + 2, kFrame);
    for (size_t i = 0; i < panes.size(); ++i) {
        const LensSource& source = panes[i];
        const Lens lens{source, out, left + int(i) * side, top, pixels, factor};
        lens.drawPixels(magnifier.grid);
        if (i > 0) {
            fillRectangle(out, lens.left, top, 1, side, kFrame);
        }
        lens.frame(source.middle, kMiddle);
        if (source.picked) {
            lens.frame(*source.picked, kPicked);
        }
        if (magnifier.jitter) {
            lens.drawPattern();
        }
    }
}

}  // namespace still::inspect
