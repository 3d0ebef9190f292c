// Roots of all pixels, with a border → each output row from four rows of them.

#include "postfx/spatial_upscale.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "postfx/internal/spatial_upscale_kernel.h"
#include "rasterizer/fixed.h"

namespace still {
namespace {

using enlarging::kBorder;

constexpr int kRowGrain = 16;

/// Where an output pixel's centre lies among the input's.
struct Place {
    int before = 0;  ///< the last pixel whose centre is not after it, −1 … size − 1
    float part = 0;  ///< how far it lies towards the next one
};

Place placeOf(int output, int size, int output_size) {
    const int twice = 2 * output_size;
    const int place = (2 * output + 1) * size - output_size;
    const int before = floorDiv(place, twice);
    return {before, float(place - before * twice) / float(twice)};
}

/// Fills the border's pixels of a row, which begins with it, with the outermost ones.
void extendRow(float* row, int width) {
    for (int i = 0; i < kBorder; ++i) {
        row[i] = row[kBorder];
        row[width + kBorder + i] = row[width + kBorder - 1];
    }
}

void rootsOfRow(const ColourPlanes& in, int y, float* const roots[4]) {
    const uint16_t* light[3] = {in.red.row(y), in.green.row(y), in.blue.row(y)};
    const int width = in.red.width;
    for (int c = 0; c < 3; ++c) {
        for (int x = 0; x < width; ++x) {
            roots[c][x + kBorder] = std::sqrt(float(light[c][x]));
        }
        extendRow(roots[c], width);
    }
    if (roots[3] != nullptr) {
        for (int x = 0; x < width + 2 * kBorder; ++x) {
            roots[3][x] = enlarging::brightnessOf(roots[0][x], roots[1][x], roots[2][x]);
        }
    }
}

}  // namespace

void SpatialUpscaler::run(const ColourPlanes& in, EnlargeFilter filter, const ColourTargets& out,
                          SimdTarget simd, Workers& workers) {
    const int width = in.red.width, height = in.red.height;
    const int out_width = out.red.width, out_height = out.red.height;
    assert(width >= 1 && height >= 1 && out_width >= width && out_height >= height);
    const bool edge = filter == EnlargeFilter::edge;
    const int planes = edge ? 4 : 3;
    for (int p = 0; p < planes; ++p) {
        roots_[p].resize(width + 2 * kBorder, height);
    }
    workers.parallelFor(height, kRowGrain, [&](int begin, int end, int) {
        for (int y = begin; y < end; ++y) {
            float* const roots[4] = {roots_[0].view().row(y), roots_[1].view().row(y),
                                     roots_[2].view().row(y),
                                     edge ? roots_[3].view().row(y) : nullptr};
            rootsOfRow(in, y, roots);
        }
    });
    column_.resize(out_width, 1);
    column_part_.resize(out_width, 1);
    for (int x = 0; x < out_width; ++x) {
        const Place place = placeOf(x, width, out_width);
        column_.at(x, 0) = place.before - 1 + kBorder;
        column_part_.at(x, 0) = place.part;
    }
    const auto kernels = enlarging::rowKernels(simd);
    const auto kernel = edge ? kernels.edge : kernels.bicubic;
    workers.parallelFor(out_height, kRowGrain, [&](int begin, int end, int) {
        for (int y = begin; y < end; ++y) {
            const Place place = placeOf(y, height, out_height);
            enlarging::Row row{.column = column_.view().data,
                               .part_x = column_part_.view().data,
                               .part_y = place.part,
                               .width = out_width,
                               .out = {out.red.row(y), out.green.row(y), out.blue.row(y)}};
            for (int k = 0; k < 4; ++k) {
                const int from = std::clamp(place.before - 1 + k, 0, height - 1);
                for (int c = 0; c < 3; ++c) {
                    row.root[c][k] = roots_[c].view().row(from);
                }
                row.brightness[k] = edge ? roots_[3].view().row(from) : nullptr;
            }
            kernel(row);
        }
    });
}

}  // namespace still
