#include <algorithm>
#include <cmath>

#include "postfx/internal/spatial_upscale_kernel.h"

namespace still::enlarging {
namespace {

/// The root back to light, rounded half up.
uint16_t lightOf(float root) {
    const float held = std::min(std::max(root, 0.0f), 255.998f);
    return uint16_t(held * held + 0.5f);
}

void bicubicRow(const Row& row) {
    const Weights4<float> wy = catmullRom(row.part_y);
    for (int x = 0; x < row.width; ++x) {
        const Weights4<float> wx = catmullRom(row.part_x[x]);
        for (int c = 0; c < 3; ++c) {
            float sum = 0;
            for (int k = 0; k < 4; ++k) {
                const float* const* rows = row.root[c];
                const int i = row.column[x] + k;
                const float column = rows[0][i] * wy.w[0] + rows[1][i] * wy.w[1] +
                                     rows[2][i] * wy.w[2] + rows[3][i] * wy.w[3];
                sum = sum + column * wx.w[k];
            }
            row.out[c][x] = lightOf(sum);
        }
    }
}

/// What one of the four middle pixels says of the edge's direction and sharpness.
struct Edge {
    float x = 0, y = 0, length = 0;

    /// `share`: the pixel's bilinear weight.
    void add(float share, float above, float left, float middle, float right, float below) {
        x = x + axis(share, left, middle, right);
        y = y + axis(share, above, middle, below);
    }

  private:
    /// The slope over two pixels; a monotonous one of full height lengthens the edge by `share`.
    float axis(float share, float before, float middle, float after) {
        const float slope = after - before;
        const float steepest = std::max(std::abs(after - middle), std::abs(middle - before));
        const float ratio = std::min(std::abs(slope) / std::max(steepest, kNoEdge), 1.0f);
        length = length + ratio * ratio * share;
        return slope * share;
    }
};

/// The kernel's shape: along and across the edge, and how far its lobe reaches.
struct Shape {
    float along_x = 1, along_y = 0;  ///< unit vector across the edge
    float stretch_across = 1, stretch_along = 1;
    float lobe = 0.5f, reach = 2;
};

Shape shapeOf(const Edge& edge) {
    const float square = edge.x * edge.x + edge.y * edge.y;
    const bool none = square < kNoEdge;
    const float size = std::sqrt(std::max(square, kNoEdge));
    Shape shape;
    shape.along_x = none ? 1.0f : edge.x / size;
    shape.along_y = none ? 0.0f : edge.y / size;
    const float half = edge.length * 0.5f;
    const float sharp = half * half;
    const float longer = std::max(std::abs(shape.along_x), std::abs(shape.along_y));
    const float diagonal = (shape.along_x * shape.along_x + shape.along_y * shape.along_y) / longer;
    shape.stretch_across = 1.0f + (diagonal - 1.0f) * sharp;
    shape.stretch_along = 1.0f - 0.5f * sharp;
    shape.lobe = 0.5f - 0.29f * sharp;
    shape.reach = 1.0f / shape.lobe;
    return shape;
}

/// Weight of a sample at (x, y) from the output pixel's centre: about Lanczos 2, without a sine.
float weightAt(const Shape& shape, float x, float y) {
    const float u = (x * shape.along_x + y * shape.along_y) * shape.stretch_across;
    const float v = (y * shape.along_x - x * shape.along_y) * shape.stretch_along;
    const float d = std::min(u * u + v * v, shape.reach);
    const float base = 0.4f * d - 1.0f;
    const float window = shape.lobe * d - 1.0f;
    return (1.5625f * (base * base) - 0.5625f) * (window * window);
}

Shape shapeAt(const Row& row, int x) {
    const int i = row.column[x];
    const float px = row.part_x[x], py = row.part_y;
    const auto at = [&](int j, int k) { return row.brightness[j][i + k]; };
    Edge edge;
    for (int j = 1; j <= 2; ++j) {
        for (int k = 1; k <= 2; ++k) {
            const float share = (j == 1 ? 1.0f - py : py) * (k == 1 ? 1.0f - px : px);
            edge.add(share, at(j - 1, k), at(j, k - 1), at(j, k), at(j, k + 1), at(j + 1, k));
        }
    }
    return shapeOf(edge);
}

void edgeRow(const Row& row) {
    for (int x = 0; x < row.width; ++x) {
        const Shape shape = shapeAt(row, x);
        float total = 0, sum[3] = {};
        for (const Tap& tap : kTaps) {
            const float w = weightAt(shape, float(tap.column - 1) - row.part_x[x],
                                     float(tap.row - 1) - row.part_y);
            total = total + w;
            for (int c = 0; c < 3; ++c) {
                sum[c] = sum[c] + row.root[c][tap.row][row.column[x] + tap.column] * w;
            }
        }
        for (int c = 0; c < 3; ++c) {
            const float* above = row.root[c][1] + row.column[x];
            const float* below = row.root[c][2] + row.column[x];
            const float least =
                std::min(std::min(above[1], above[2]), std::min(below[1], below[2]));
            const float most = std::max(std::max(above[1], above[2]), std::max(below[1], below[2]));
            row.out[c][x] = lightOf(std::min(std::max(sum[c] / total, least), most));
        }
    }
}

}  // namespace

RowKernels referenceKernels() {
    return {bicubicRow, edgeRow};
}

}  // namespace still::enlarging
