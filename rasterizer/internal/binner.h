#pragma once
// Triangles → per-chunk lists of records, sorted by tile. A chunk is a constant number of
// consecutive triangles of one surface, so that the cut does not depend on the threads; a tile
// reads the chunks in order and so sees its triangles in submission order.

#include <memory>
#include <vector>

#include "rasterizer/internal/kernels.h"
#include "rasterizer/internal/triangle_setup.h"
#include "rasterizer/rasterizer.h"

namespace still::internal {

/// What is to be binned: triangles [first, first + count) of one mesh part's surface.
struct ChunkInput {
    const Surface* surface = nullptr;
    const VertexJob* projection = nullptr;  ///< the instance's; `out` holds its vertices
    uint32_t first = 0, count = 0;
    uint16_t surface_index = 0;
};

/// Memory that grows and is never initialised.
template <class T>
class Buffer {
  public:
    /// At least `count` elements; what stood there is lost when it has to grow.
    T* reserve(size_t count) {
        if (count > capacity_) {
            reserveExactly(count + count / 4);
        }
        return memory_.get();
    }
    void reserveExactly(size_t count) {
        memory_ = std::make_unique_for_overwrite<T[]>(count);
        capacity_ = count;
    }
    T* data() const { return memory_.get(); }

  private:
    std::unique_ptr<T[]> memory_;
    size_t capacity_ = 0;
};

/// Rectangle of tiles, both ends included; empty when x1 < x0.
struct TileRect {
    int16_t x0 = 0, y0 = 0, x1 = -1, y1 = -1;

    bool holds(int x, int y) const { return x >= x0 && x <= x1 && y >= y0 && y <= y1; }
    int width() const { return x1 - x0 + 1; }
    int height() const { return y1 - y0 + 1; }
};

struct Chunk {
    const ScreenVertex* vertices = nullptr;  ///< of the instance
    uint32_t first = 0;                      ///< triangle in the mesh that has number 0 here
    uint16_t surface = 0;
    bool alpha = false;  ///< the surface is alpha-tested or stochastic

    TileRect rect;                  ///< of touched tiles
    std::vector<uint32_t> offsets;  ///< of each tile's records, row by row; one more than tiles
    Buffer<TileTriangle> records;
    std::vector<SetupTriangle> wide;
    std::vector<ClipBarycentrics> clips;  ///< of clipped wide triangles

    struct Range {
        const TileTriangle *begin, *end;
    };
    /// Records of tile (tx, ty), which is in `rect`.
    Range recordsOf(int tx, int ty) const {
        const uint32_t* o = offsets.data() + (ty - rect.y0) * rect.width() + tx - rect.x0;
        return {records.data() + o[0], records.data() + o[1]};
    }
};

/// The frame's chunks; only the first `count` are in use.
struct FrameBins {
    size_t count = 0;
    std::vector<Chunk> chunks;
    std::vector<TileRect> rects;  ///< Chunk::rect of each once more, to leave out chunks unread
};

/// Scratch of one worker.
struct BinScratch {
    /// A record in a tile of the chunk's rectangle.
    struct Entry {
        uint32_t tile;
        uint32_t source;  ///< in the batch, or from kCapacity on in `special`
    };
    TriangleBatch batch;
    std::vector<Entry> entries;
    std::vector<TileTriangle> special;  ///< records of triangles that touch several tiles
    /// Of Chunk::wide: bounds, and where the triangles of each wide source end.
    std::vector<PixelBox> wide_boxes;
    std::vector<uint32_t> wide_ends;
    RasterCounters counters;  ///< sums over the chunks of this worker
};

/// Replaces the contents of the chunk.
void binChunk(const ChunkInput& input, const FrameView& view, const GeometryKernels& kernels,
              BinScratch& scratch, Chunk& chunk);

}  // namespace still::internal
