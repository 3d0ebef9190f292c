// Geometry: edges of the whole picture → means where there are none → lines through the others.
// Colour: brightness of the whole picture → blended pixels.

#include "postfx/spatial.h"

#include <array>
#include <cassert>

#include "postfx/internal/spatial_colour.h"
#include "postfx/internal/spatial_kernels.h"
#include "postfx/internal/spatial_pixel.h"
#include "rasterizer/draw_list.h"

namespace still {
namespace {

using spatial::PlaneEdges;
using Picture = spatial::Picture<PlaneEdges>;

constexpr int kRowGrain = 8;

void filterPixel(const Picture& picture, int x, int y, const ColourTargets& out) {
    int rgb[3];
    spatial::filteredPixel(picture, x, y, rgb);
    out.red.row(y)[x] = uint16_t(rgb[0]);
    out.green.row(y)[x] = uint16_t(rgb[1]);
    out.blue.row(y)[x] = uint16_t(rgb[2]);
}

void geometryRow(const Picture& picture, ImageView<const uint8_t> edges, int y,
                 const spatial::RowKernels& kernels, const ColourTargets& out) {
    std::array<uint8_t, kMaxTargetSize + kRowPadding> busy;
    const int last = picture.width() - 1;
    const bool inner = y > 0 && y + 1 < picture.height();
    if (inner) {
        kernels.meanRow(picture.input(), edges, y, out, busy.data());
    }
    for (int x = 0; x <= last; ++x) {
        if (!inner || x == 0 || x == last || busy[size_t(x)] != 0) {
            filterPixel(picture, x, y, out);
        }
    }
}

void runGeometry(const SpatialInput& input, SimdTarget simd, ImageView<uint8_t> edges,
                 const ColourTargets& out, Workers& workers) {
    const spatial::RowKernels kernels = spatial::rowKernels(simd);
    workers.parallelFor(edges.height, kRowGrain, [&](int begin, int end, int) {
        for (int y = begin; y < end; ++y) {
            kernels.markEdges(input, y, edges.row(y));
        }
    });
    const Picture picture(input, {edges});
    workers.parallelFor(edges.height, kRowGrain, [&](int begin, int end, int) {
        for (int y = begin; y < end; ++y) {
            geometryRow(picture, edges, y, kernels, out);
        }
    });
}

void runColour(const ColourPlanes& colour, ImageView<uint8_t> brightness, const ColourTargets& out,
               Workers& workers) {
    workers.parallelFor(brightness.height, kRowGrain, [&](int begin, int end, int) {
        for (int y = begin; y < end; ++y) {
            spatial::brightnessRow(colour, y, brightness.row(y));
        }
    });
    workers.parallelFor(brightness.height, kRowGrain, [&](int begin, int end, int) {
        for (int y = begin; y < end; ++y) {
            spatial::colourRow(colour, brightness, y, out);
        }
    });
}

}  // namespace

SpatialInput spatialInput(const GBuffer& gbuffer, int jitter_x_fx8, int jitter_y_fx8) {
    SpatialInput input;
    input.colour = {gbuffer.red.view(), gbuffer.green.view(), gbuffer.blue.view()};
    input.id = gbuffer.id.view();
    if (gbuffer.planes.normal) {
        input.normal = gbuffer.normal.view();
    }
    input.jitter_x_fx8 = jitter_x_fx8;
    input.jitter_y_fx8 = jitter_y_fx8;
    return input;
}

void SpatialFilter::run(const SpatialInput& input, const SpatialSettings& settings,
                        const ColourTargets& out, Workers& workers) {
    const int width = input.colour.red.width, height = input.colour.red.height;
    assert(width > 0 && width <= kMaxTargetSize && height > 0);
    assert(out.red.width == width && out.red.height == height);
    marks_.resize(width, height);
    if (settings.edges == SpatialEdges::colour) {
        runColour(input.colour, marks_.view(), out, workers);
    } else {
        runGeometry(input, settings.simd, marks_.view(), out, workers);
    }
}

void spatialPixel(const SpatialInput& input, int x, int y, int rgb[3]) {
    assert(x >= 0 && x < input.colour.red.width && y >= 0 && y < input.colour.red.height);
    spatial::filteredPixel(spatial::Picture<spatial::LiveEdges>(input, {input}), x, y, rgb);
}

}  // namespace still
