// The scalar truth of the tile stage: every sample against every triangle of the tile, no
// hierarchy.

#include <algorithm>

#include "rasterizer/internal/shade_reference.h"
#include "rasterizer/internal/shade_setup.h"
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

void rasterizeTriangle(TileContext& tile, const Chunk& chunk, uint32_t triangle) {
    const SetupTriangle t = setupOf(tile.triangles[triangle], chunk, tile.x0, tile.y0);
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
            if (!covered || !(z > tile.depth[i])) {
                continue;
            }
            if (chunk.alpha || tile.forward) {
                prepareTriangle(tile, chunk, triangle);
            }
            if (chunk.alpha && !alphaPasses(tile, tile.shade[triangle], x, y)) {
                continue;
            }
            tile.depth[i] = z;
            tile.visible[i] = triangle;
            if (tile.forward) {
                shadePixel(tile, &tile.shade[triangle], x, y, z);
            }
        }
    }
}

void rasterizeTileReference(TileContext& tile) {
    clearTile(tile);
    if (tile.forward) {
        shadeTileReference(tile);
    }
    for (const TileRun* run = tile.runs; run->chunk != nullptr; ++run) {
        for (uint32_t i = run[0].begin; i < run[1].begin; ++i) {
            rasterizeTriangle(tile, *run->chunk, i);
        }
    }
}

void prepareShadingReference(TileContext& tile) {
    std::fill_n(tile.seen, tile.triangle_count, uint8_t{0});
    for (int y = 0; y < tile.height; ++y) {
        for (int x = 0; x < tile.width; ++x) {
            const uint32_t i = tile.visible[y * kTileSize + x];
            if (i != kNothingVisible) {
                tile.seen[i] = 1;
                ++tile.pixels_shaded;
            }
        }
    }
    for (const TileRun* run = tile.runs; run->chunk != nullptr; ++run) {
        for (uint32_t i = run[0].begin; i < run[1].begin; ++i) {
            if (tile.seen[i] != 0) {
                prepareTriangle(tile, *run->chunk, i);
                tile.features |= tile.frame->surfaces[run->chunk->surface].features;
            }
        }
    }
}

}  // namespace

const RasterKernels& referenceKernels() {
    static constexpr RasterKernels kKernels{rasterizeTileReference, prepareShadingReference,
                                            shadeTileReference};
    return kKernels;
}

}  // namespace still::internal
