#pragma once
// Triangles → per-chunk lists of setup triangles, sorted by tile. A chunk is a constant number of
// consecutive triangles of one instance, so that the cut does not depend on the threads; a tile
// reads the chunks in order and so sees its triangles in submission order.

#include <vector>

#include "rasterizer/internal/kernels.h"
#include "rasterizer/rasterizer.h"

namespace still::internal {

constexpr uint32_t kChunkTriangles = 1024;

/// What is to be binned: triangles [first, first + count) of one mesh part's surface.
struct ChunkInput {
    const Surface* surface = nullptr;
    uint16_t surface_index = 0;
    uint32_t first = 0, count = 0;
    VertexJob projection{};  ///< the instance's; `out` holds its transformed vertices
};

struct Chunk {
    std::vector<SetupTriangle> triangles;
    std::vector<ClipBarycentrics> clips;
    RasterCounters counters;

    /// Items of tile (tx, ty) of the rectangle, or an empty range outside of it.
    struct Range {
        const uint32_t *begin, *end;
    };
    Range itemsOf(int tx, int ty) const {
        const int x = tx - tile_x0, y = ty - tile_y0;
        if (x < 0 || y < 0 || x >= tiles_w || y >= tiles_h) {
            return {nullptr, nullptr};
        }
        const uint32_t* o = offsets.data() + y * tiles_w + x;
        return {items.data() + o[0], items.data() + o[1]};
    }

    int tile_x0 = 0, tile_y0 = 0, tiles_w = 0, tiles_h = 0;  ///< rectangle of touched tiles
    std::vector<uint32_t> offsets;                           ///< tiles_w · tiles_h + 1
    std::vector<uint32_t> items;                             ///< indices into triangles

    // Scratch, kept for its capacity.
    std::vector<uint32_t> pair_tile, pair_triangle;
};

/// Replaces the chunk's contents.
void binChunk(const ChunkInput& input, const FrameView& view, Chunk& chunk);

}  // namespace still::internal
