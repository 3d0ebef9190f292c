#include "rasterizer/internal/triangle_setup.h"

#include <algorithm>
#include <utility>

#include "rasterizer/fixed.h"

namespace still::internal {

PixelBox pixelBox(const SetupTriangle& t, int width, int height) {
    const auto [min_x, max_x] = std::minmax({t.x_fx8[0], t.x_fx8[1], t.x_fx8[2]});
    const auto [min_y, max_y] = std::minmax({t.y_fx8[0], t.y_fx8[1], t.y_fx8[2]});
    constexpr int kRoundUp = kSubpixelOne - 1;
    return {std::max<int>(0, (min_x + kRoundUp) >> kSubpixelBits),
            std::max<int>(0, (min_y + kRoundUp) >> kSubpixelBits),
            std::min<int>(width - 1, max_x >> kSubpixelBits),
            std::min<int>(height - 1, max_y >> kSubpixelBits)};
}

namespace {

int64_t doubledArea(const SetupTriangle& t) {
    return int64_t{t.x_fx8[1] - t.x_fx8[0]} * (t.y_fx8[2] - t.y_fx8[0]) -
           int64_t{t.x_fx8[2] - t.x_fx8[0]} * (t.y_fx8[1] - t.y_fx8[0]);
}

}  // namespace

bool setupTriangle(const ScreenVertex v[3], int sample_x_fx8, int sample_y_fx8, int width,
                   int height, SetupTriangle& out) {
    for (int k = 0; k < 3; ++k) {
        out.x_fx8[k] = v[k].x_fx8 - sample_x_fx8;
        out.y_fx8[k] = v[k].y_fx8 - sample_y_fx8;
        out.inv_w[k] = v[k].inv_w;
        out.z[k] = v[k].z;
    }
    if (pixelBox(out, width, height).empty()) {
        return false;
    }
    const int64_t area2 = doubledArea(out);
    if (area2 == 0) {
        return false;
    }
    out.swapped = area2 < 0;
    if (out.swapped) {
        std::swap(out.x_fx8[1], out.x_fx8[2]);
        std::swap(out.y_fx8[1], out.y_fx8[2]);
        std::swap(out.inv_w[1], out.inv_w[2]);
        std::swap(out.z[1], out.z[2]);
    }
    return true;
}

SetupTriangle expand(const TileTriangle& record, int tile_x0, int tile_y0) {
    SetupTriangle t;
    for (int k = 0; k < 3; ++k) {
        t.x_fx8[k] = record.corner[k].x_fx8 + tile_x0 * kSubpixelOne;
        t.y_fx8[k] = record.corner[k].y_fx8 + tile_y0 * kSubpixelOne;
        t.z[k] = record.z[k];
        t.inv_w[k] = 0.0f;
    }
    t.triangle = record.id & kTriangleMask;
    t.clip = -1;
    t.swapped = (record.id & kSwapped) != 0;
    return t;
}

DepthPlane depthPlane(const SetupTriangle& t) {
    const double x1 = t.x_fx8[1] - t.x_fx8[0], y1 = t.y_fx8[1] - t.y_fx8[0];
    const double x2 = t.x_fx8[2] - t.x_fx8[0], y2 = t.y_fx8[2] - t.y_fx8[0];
    const double z0 = double(t.z[0]);
    const double z1 = double(t.z[1]) - z0, z2 = double(t.z[2]) - z0;
    const double per_pixel = double(kSubpixelOne) / double(doubledArea(t));
    DepthPlane p;
    p.dx = (z1 * y2 - z2 * y1) * per_pixel;
    p.dy = (z2 * x1 - z1 * x2) * per_pixel;
    const double px = t.x_fx8[0] / double(kSubpixelOne), py = t.y_fx8[0] / double(kSubpixelOne);
    p.origin = z0 - (p.dx * px + p.dy * py);
    return p;
}

Edge makeEdge(const SetupTriangle& t, int k, int origin_x, int origin_y) {
    const int next = k == 2 ? 0 : k + 1;
    const int32_t dx = t.x_fx8[next] - t.x_fx8[k];
    const int32_t dy = t.y_fx8[next] - t.y_fx8[k];
    const bool top_left = dy < 0 || (dy == 0 && dx > 0);
    const int64_t at_origin = int64_t{dx} * (origin_y * kSubpixelOne - t.y_fx8[k]) -
                              int64_t{dy} * (origin_x * kSubpixelOne - t.x_fx8[k]);
    // Steps of a pixel add multiples of 256, so dropping the low bits (floor) keeps every sign.
    return {(at_origin - (top_left ? 0 : 1)) >> kSubpixelBits, -dy, dx};
}

}  // namespace still::internal
