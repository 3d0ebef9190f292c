#pragma once
// Snapped screen triangle → what coverage needs: orientation, edges, depth plane.
//
// y grows downwards. With the doubled area positive, triangles run clockwise on the screen:
//
//        v0 ───────► v1      top edge: horizontal, going right
//          ▲        ╱        left edge: going up
//           ╲      ╱         A sample on a top or left edge is inside, on any other edge outside
//             ╲  ▼           (the top-left rule, Direct3D 11 functional spec §3.4.2), so a shared
//              v2            edge is covered exactly once.

#include "rasterizer/internal/geometry.h"

namespace still::internal {

/// Pixel rectangle, both ends included. Empty when x1 < x0 or y1 < y0.
struct PixelBox {
    int x0, y0, x1, y1;
    bool empty() const { return x1 < x0 || y1 < y0; }
};

/// Sample positions inside the triangle's bounds, clamped to the picture.
PixelBox pixelBox(const SetupTriangle& t, int width, int height);

/// Fills positions, depths and orientation. False when the area is zero or no sample of the
/// picture lies in its bounds: the triangle is dropped. `v` carries positions without jitter.
bool setupTriangle(const ScreenVertex v[3], int sample_x_fx8, int sample_y_fx8, int width,
                   int height, SetupTriangle& out);

/// A record of the tile whose first pixel is (tile_x0, tile_y0), with the positions of the picture.
/// Not for wide ones; `triangle` stays that of the chunk and inv_w is left out.
SetupTriangle expand(const TileTriangle& record, int tile_x0, int tile_y0);

/// Depth over the screen, in double: slivers and planes from near to far keep their precision, and
/// each tile takes only the value near itself to float.
struct DepthPlane {
    double origin, dx, dy;  ///< at pixel (0, 0) and per pixel
};
DepthPlane depthPlane(const SetupTriangle& t);

/// Edge k runs from vertex k to vertex k + 1. value(x, y) = c + x·a + y·b ≥ 0 inside, top-left rule
/// included, for whole pixels x, y from the origin it was made for.
struct Edge {
    int64_t c;
    int32_t a, b;
};
Edge makeEdge(const SetupTriangle& t, int k, int origin_x, int origin_y);

}  // namespace still::internal
