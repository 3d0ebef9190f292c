#include "rasterizer/internal/overdraw.h"

#include <algorithm>

#include "rasterizer/internal/tile.h"
#include "rasterizer/internal/triangle_setup.h"

namespace still::internal {
namespace {

/// `box` is within the tile, whose first pixel is (x0, y0).
void countTriangle(const SetupTriangle& t, const PixelBox& box, int x0, int y0,
                   ImageView<uint16_t> out) {
    Edge edges[3];
    for (int k = 0; k < 3; ++k) {
        edges[k] = makeEdge(t, k, x0, y0);
    }
    for (int y = box.y0; y <= box.y1; ++y) {
        uint16_t* row = out.row(y);
        for (int x = box.x0; x <= box.x1; ++x) {
            const bool covered = std::all_of(edges, edges + 3, [&](const Edge& e) {
                return e.c + int64_t{e.a} * (x - x0) + int64_t{e.b} * (y - y0) >= 0;
            });
            row[x] = uint16_t(row[x] + (covered && row[x] != 65535 ? 1 : 0));
        }
    }
}

}  // namespace

void countOverdraw(const FrameBins& bins, int tx, int ty, ImageView<uint16_t> out) {
    const int x0 = tx * kTileSize, y0 = ty * kTileSize;
    const int x1 = std::min(x0 + kTileSize, out.width), y1 = std::min(y0 + kTileSize, out.height);
    for (int y = y0; y < y1; ++y) {
        std::fill(out.row(y) + x0, out.row(y) + x1, uint16_t{0});
    }
    for (size_t i = 0; i < bins.count; ++i) {
        if (!bins.rects[i].holds(tx, ty)) {
            continue;
        }
        const Chunk& chunk = bins.chunks[i];
        const Chunk::Range range = chunk.recordsOf(tx, ty);
        for (const TileTriangle* record = range.begin; record != range.end; ++record) {
            const SetupTriangle t = setupOf(*record, chunk, x0, y0);
            PixelBox box = pixelBox(t, x1, y1);
            box.x0 = std::max(box.x0, x0);
            box.y0 = std::max(box.y0, y0);
            countTriangle(t, box, x0, y0, out);
        }
    }
}

}  // namespace still::internal
