#pragma once
// One tile from bins to planes: collects its triangles, runs visibility and shading, and notes the
// facts that later passes use.

#include <algorithm>
#include <vector>

#include "rasterizer/internal/binner.h"
#include "rasterizer/internal/frame_setup.h"

namespace still::internal {

/// Depth of a triangle inside a tile: at(x, y) is monotonic in x and in y (each rounding is), so
/// the corner of a block gives the exact bound of its samples. The origin is the first pixel of the
/// triangle's bounds in the tile, not the tile's corner: slivers with steep planes stay exact.
struct TilePlane {
    int x0, y0, x1, y1;  ///< tile-local bounds, inclusive
    float origin, dx, dy;
    float min, max;  ///< of the triangle's vertices: rounding never leaves this range

    float at(int x, int y) const {
        const float z = (origin + dy * float(y - y0)) + dx * float(x - x0);
        return std::min(std::max(z, min), max);
    }
};

/// The triangle with the picture's coordinates; of narrow ones inv_w is left out.
SetupTriangle setupOf(const TileTriangle& record, const Chunk& chunk, int tile_x0, int tile_y0);

TilePlane makeTilePlane(const SetupTriangle& t, const TileContext& tile);

/// Scratch of one worker.
struct TileScratch {
    std::vector<TileRun> runs;
    Buffer<TileTriangle> triangles;
    Buffer<ShadeTriangle> shade;
    Buffer<uint8_t> shade_ready, seen;
    alignas(64) float depth[kTilePixels + kTileSlack];
    alignas(64) uint32_t visible[kTilePixels + kTileSlack];
    RasterCounters counters;  ///< what this worker adds to the frame's
};

/// Renders tile (tx, ty).
void renderTile(const FrameSetup& setup, const FrameBins& bins, const RasterSettings& settings,
                int tx, int ty, GBuffer& out, TileScratch& scratch);

}  // namespace still::internal
