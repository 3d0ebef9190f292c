// The scalar kernels, which define the result of all others.

#include "postfx/internal/spatial_kernels.h"
#include "postfx/internal/spatial_pixel.h"

namespace still::spatial {
namespace {

void markEdges(const SpatialInput& input, int y, uint8_t* marks) {
    const Picture<LiveEdges> picture(input, {input});
    for (int x = 0; x < picture.width(); ++x) {
        marks[x] = edgeMarks(picture, x, y);
    }
}

bool isBusy(ImageView<const uint8_t> edges, int x, int y) {
    const uint8_t *above = edges.row(y - 1), *here = edges.row(y), *below = edges.row(y + 1);
    int bits = 0;
    for (int i = x - 1; i <= x + 1; ++i) {
        bits |= (above[i] | here[i]) & kEdgeBelow;
    }
    for (int i = x - 1; i <= x; ++i) {
        bits |= (above[i] | here[i] | below[i]) & kEdgeRight;
    }
    return bits != 0;
}

void meanRow(const SpatialInput& input, ImageView<const uint8_t> edges, int y,
             const ColourTargets& out, uint8_t* busy) {
    const Taps across = pixelTaps(input.jitter_x_fx8), down = pixelTaps(input.jitter_y_fx8);
    const ImageView<const uint16_t> from[3] = {input.colour.red, input.colour.green,
                                               input.colour.blue};
    const ImageView<uint16_t> to[3] = {out.red, out.green, out.blue};
    for (int x = 1; x + 1 < edges.width; ++x) {
        busy[x] = isBusy(edges, x, y) ? 1 : 0;
        for (int c = 0; c < 3 && busy[x] == 0; ++c) {
            int window[9];
            for (int i = 0; i < 9; ++i) {
                window[i] = from[c].row(y - 1 + i / 3)[x - 1 + i % 3];
            }
            to[c].row(y)[x] = uint16_t(pixelMean(window, across, down));
        }
    }
}

}  // namespace

RowKernels referenceKernels() {
    return {markEdges, meanRow};
}

}  // namespace still::spatial
