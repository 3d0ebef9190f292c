#include "rasterizer/internal/shade_setup.h"

#include <algorithm>

#include "rasterizer/fixed.h"
#include "rasterizer/internal/tile.h"

namespace still::internal {

namespace {

/// Σ a_k · b_k in the order of the shading kernels.
float sum3(const float a[3], const float b[3]) {
    return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}

/// The attributes that all surfaces have, and what follows from them and the planes.
void copyAttributes(const Surface& s, const uint32_t index[3], ShadeTriangle& out) {
    for (int k = 0; k < 3; ++k) {
        const float* attributes = s.attributes + size_t(index[k]) * kAttributeStride;
        out.nx[k] = attributes[0];
        out.ny[k] = attributes[1];
        out.nz[k] = attributes[2];
        out.u[k] = attributes[3];
        out.v[k] = attributes[4];
    }
    out.sum_dx = (out.p_dx[0] + out.p_dx[1]) + out.p_dx[2];
    out.sum_dy = (out.p_dy[0] + out.p_dy[1]) + out.p_dy[2];
    out.u_dx = sum3(out.u, out.p_dx);
    out.u_dy = sum3(out.u, out.p_dy);
    out.v_dx = sum3(out.v, out.p_dx);
    out.v_dy = sum3(out.v, out.p_dy);
}

}  // namespace

void makeShadeTriangle(TileContext& tile, const Chunk& chunk, uint32_t i) {
    const FrameTables& frame = *tile.frame;
    const TileTriangle& record = tile.triangles[i];
    ShadeTriangle& out = tile.shade[i];
    SetupTriangle t = setupOf(record, chunk, tile.x0, tile.y0);
    const Surface& s = frame.surfaces[chunk.surface];
    const int order[3] = {0, t.swapped != 0 ? 2 : 1, t.swapped != 0 ? 1 : 2};
    const uint32_t* index = s.indices + size_t(t.triangle) * 3;
    if ((record.id & kWide) == 0) {
        for (int k = 0; k < 3; ++k) {
            t.inv_w[k] = chunk.vertices[index[order[k]]].inv_w;
        }
    }
    const int anchor_x =
        std::max<int>(tile.x0, (std::min({t.x_fx8[0], t.x_fx8[1], t.x_fx8[2]}) + 255) >> 8);
    const int anchor_y =
        std::max<int>(tile.y0, (std::min({t.y_fx8[0], t.y_fx8[1], t.y_fx8[2]}) + 255) >> 8);
    double value[3], dx[3], dy[3];  // of p_k = λ_k / w_k, in the setup triangle's vertex order
    double area2 = 0;
    for (int k = 0; k < 3; ++k) {
        const int i = k == 2 ? 0 : k + 1;  // the edge opposite to vertex k runs from i to j
        const int j = i == 2 ? 0 : i + 1;
        const int64_t ex = t.x_fx8[j] - t.x_fx8[i], ey = t.y_fx8[j] - t.y_fx8[i];
        const int64_t e = ex * (anchor_y * kSubpixelOne - t.y_fx8[i]) -
                          ey * (anchor_x * kSubpixelOne - t.x_fx8[i]);
        value[k] = double(e);
        dx[k] = double(-ey * kSubpixelOne);
        dy[k] = double(ex * kSubpixelOne);
        area2 += value[k];
    }
    for (int k = 0; k < 3; ++k) {
        const double scale = double(t.inv_w[k]) / area2;
        value[k] *= scale;
        dx[k] *= scale;
        dy[k] *= scale;
    }
    for (int k = 0; k < 3; ++k) {
        double v = 0, vx = 0, vy = 0;
        for (int c = 0; c < 3; ++c) {
            // Setup corner c is source corner order[c], or a clipped corner between all three.
            const double weight = t.clip >= 0 ? double(chunk.clips[size_t(t.clip)].b[order[c]][k])
                                              : (order[c] == k ? 1.0 : 0.0);
            v += value[c] * weight;
            vx += dx[c] * weight;
            vy += dy[c] * weight;
        }
        out.p[k] = float(v);
        out.p_dx[k] = float(vx);
        out.p_dy[k] = float(vy);
        out.vertex[k] = int32_t(index[k]);
    }
    out.anchor_x = float(anchor_x - tile.x0);
    out.anchor_y = float(anchor_y - tile.y0);
    out.surface = chunk.surface;
    // With y down, the triangles that had to be swapped run counter-clockwise on the screen.
    out.flip = shadingFlip(s, frame.instances[s.instance], t.triangle, t.swapped != 0);
    copyAttributes(s, index, out);
    out.handedness = handednessOf(s, index);
    copyExtras(s, index, out);
}

}  // namespace still::internal
