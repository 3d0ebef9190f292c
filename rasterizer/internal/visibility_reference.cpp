// The scalar truth of the tile stage: every sample against every triangle of the tile, no
// hierarchy.

#include <algorithm>

#include "rasterizer/internal/shade_reference.h"
#include "rasterizer/internal/tile.h"
#include "rasterizer/internal/triangle_setup.h"

namespace still::internal {

namespace {

void clearTile(TileContext& tile) {
    std::fill_n(tile.depth, kTilePixels, 0.0f);
    std::fill_n(tile.visible, kTilePixels, kNothingVisible);
}

void shadeTileReference(const TileContext& tile) {
    for (int y = 0; y < tile.height; ++y) {
        for (int x = 0; x < tile.width; ++x) {
            const int i = y * kTileSize + x;
            const uint32_t ref = tile.visible[i];
            shadePixel(tile, ref == kNothingVisible ? nullptr : &tile.shade[ref], x, y,
                       tile.depth[i]);
        }
    }
}

void rasterizeTriangle(TileContext& tile, uint32_t ref) {
    const SetupTriangle t = setupOf(tile.refs[ref], tile.x0, tile.y0);
    const TilePlane plane = makeTilePlane(t, tile);
    Edge edges[3];
    for (int k = 0; k < 3; ++k) {
        edges[k] = makeEdge(t, k, tile.x0, tile.y0);
    }
    for (int y = plane.y0; y <= plane.y1; ++y) {
        for (int x = plane.x0; x <= plane.x1; ++x) {
            const bool covered = std::all_of(edges, edges + 3, [&](const Edge& e) {
                return e.c + int64_t{e.a} * x + int64_t{e.b} * y >= 0;
            });
            const int i = y * kTileSize + x;
            const float z = plane.at(x, y);
            if (!covered || !(z > tile.depth[i]) ||
                (tile.refs[ref].chunk->alpha && !alphaPasses(tile, tile.shade[ref], x, y))) {
                continue;
            }
            tile.depth[i] = z;
            tile.visible[i] = ref;
            if (tile.forward) {
                shadePixel(tile, &tile.shade[ref], x, y, z);
            }
        }
    }
}

void rasterizeTileReference(TileContext& tile) {
    clearTile(tile);
    if (tile.forward) {
        shadeTileReference(tile);
    }
    for (uint32_t ref = 0; ref < tile.ref_count; ++ref) {
        rasterizeTriangle(tile, ref);
    }
}

}  // namespace

const RasterKernels& referenceKernels() {
    static constexpr RasterKernels kKernels{rasterizeTileReference, shadeTileReference};
    return kKernels;
}

}  // namespace still::internal
