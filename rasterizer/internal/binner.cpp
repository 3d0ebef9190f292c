#include "rasterizer/internal/binner.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "rasterizer/fixed.h"
#include "rasterizer/internal/clip.h"
#include "rasterizer/internal/triangle_setup.h"
#include "rasterizer/internal/vertex_reference.h"

namespace still::internal {

namespace {

constexpr int kTileFx8 = kTileSize * kSubpixelOne;

/// A tile is left out when one edge has all its samples outside.
bool outsideAnEdge(const SetupTriangle& t, int tile_x0, int tile_y0) {
    for (int k = 0; k < 3; ++k) {
        const Edge e = makeEdge(t, k, tile_x0, tile_y0);
        if (e.c + int64_t{std::max<int32_t>(e.a, 0) + std::max<int32_t>(e.b, 0)} * (kTileSize - 1) <
            0) {
            return true;
        }
    }
    return false;
}

TileRect tilesOf(const PixelBox& box) {
    return {int16_t(box.x0 >> kTileShift), int16_t(box.y0 >> kTileShift),
            int16_t(box.x1 >> kTileShift), int16_t(box.y1 >> kTileShift)};
}

/// Triangles that the batch kernel leaves alone: large ones, and those that need clipping.
class WideSetup {
  public:
    WideSetup(const ChunkInput& input, const FrameView& view, BinScratch& scratch, Chunk& chunk)
        : input_(input), view_(view), scratch_(scratch), chunk_(chunk) {}

    /// Number `triangle` of the chunk.
    void add(uint32_t triangle) {
        const uint32_t* index = input_.surface->indices + size_t(input_.first + triangle) * 3;
        const ScreenVertex v[3] = {chunk_.vertices[index[0]], chunk_.vertices[index[1]],
                                   chunk_.vertices[index[2]]};
        if (v[0].placed() && v[1].placed() && v[2].placed()) {
            addPlaced(v, triangle, -1);
        } else {
            addClipped(v, index, triangle);
        }
    }

  private:
    void addPlaced(const ScreenVertex v[3], uint32_t triangle, int32_t clip) {
        SetupTriangle t;
        if (!setupTriangle(v, kSubpixelHalf + view_.jitter_x_fx8,
                           kSubpixelHalf + view_.jitter_y_fx8, view_.width, view_.height, t)) {
            return;
        }
        t.triangle = input_.first + triangle;
        t.clip = clip;
        chunk_.wide.push_back(t);
        scratch_.wide_boxes.push_back(pixelBox(t, view_.width, view_.height));
    }

    void addClipped(const ScreenVertex v[3], const uint32_t index[3], uint32_t triangle) {
        const VertexJob& job = *input_.projection;
        ClipVertex corners[3];
        for (int k = 0; k < 3; ++k) {
            const uint32_t i = index[k];
            corners[k] = transformVertex(job.clip, job.x[i], job.y[i], job.z[i]);
        }
        ClippedVertex polygon[kMaxClippedCorners];
        const double guard_x = double(job.guard_fx8) / double(job.scale_x_fx8);
        const double guard_y = -double(job.guard_fx8) / double(job.scale_y_fx8);
        const int count = clipTriangle(corners, guard_x, guard_y, polygon);
        ++scratch_.counters.clipped;
        ScreenVertex screen[kMaxClippedCorners];
        for (int k = 0; k < count; ++k) {
            // A corner that clipping did not make must be where an unclipped neighbour has it.
            const int source = polygon[k].source;
            screen[k] = source >= 0 && v[source].placed() ? v[source] : project(polygon[k]);
        }
        for (int k = 2; k < count; ++k) {
            const int fan[3] = {0, k - 1, k};
            ScreenVertex part[3];
            ClipBarycentrics b;
            for (int j = 0; j < 3; ++j) {
                part[j] = screen[fan[j]];
                std::transform(polygon[fan[j]].b, polygon[fan[j]].b + 3, b.b[j],
                               [](double weight) { return float(weight); });
            }
            chunk_.clips.push_back(b);
            addPlaced(part, triangle, int32_t(chunk_.clips.size()) - 1);
        }
    }

    /// As projectVertex(), but in double, and a corner that rounding left a hair outside is taken.
    ScreenVertex project(const ClippedVertex& p) const {
        const VertexJob& job = *input_.projection;
        const double r = 1.0 / std::max(p.w, 1e-20);
        const double limit = double(job.guard_fx8) + kSubpixelOne;
        const auto snap = [&](double v, float scale) {
            return int32_t(std::floor(std::clamp(v * r * double(scale), -limit, limit) + 0.5));
        };
        return {snap(p.x, job.scale_x_fx8) + job.centre_x_fx8,
                snap(p.y, job.scale_y_fx8) + job.centre_y_fx8, std::min(float(p.z * r), 1.0f),
                float(r)};
    }

    const ChunkInput& input_;
    const FrameView& view_;
    BinScratch& scratch_;
    Chunk& chunk_;
};

/// Batch and wide triangles → records by tile.
class TileSort {
  public:
    TileSort(BinScratch& scratch, Chunk& chunk)
        : batch_(scratch.batch), scratch_(scratch), chunk_(chunk) {}

    /// Sets the rectangle; false when nothing is visible.
    bool bound() {
        TileRect r{INT16_MAX, INT16_MAX, -1, -1};
        if (batch_.tile_x1 >= 0) {
            r = {int16_t(batch_.tile_x0), int16_t(batch_.tile_y0), int16_t(batch_.tile_x1),
                 int16_t(batch_.tile_y1)};
        }
        for (const PixelBox& box : scratch_.wide_boxes) {
            const TileRect tiles = tilesOf(box);
            r = {std::min(r.x0, tiles.x0), std::min(r.y0, tiles.y0), std::max(r.x1, tiles.x1),
                 std::max(r.y1, tiles.y1)};
        }
        chunk_.rect = r.x1 < 0 ? TileRect{} : r;
        width_ = uint32_t(chunk_.rect.width());
        first_ = uint32_t(chunk_.rect.y0) * width_ + uint32_t(chunk_.rect.x0);
        return r.x1 >= 0;
    }

    /// Lists which record goes to which tile, in submission order, and counts those of each tile.
    void list() {
        chunk_.offsets.assign(size_t(width_) * size_t(chunk_.rect.height()) + 1, 0);
        uint32_t wide = 0;
        const uint32_t* wide_end = scratch_.wide_ends.data();
        for (uint32_t i = 0; i < batch_.count; ++i) {
            const uint32_t place = batch_.place[i];
            if (place <= 0xFFFF) {
                add(tileOf(place), i);
            } else if ((place & TriangleBatch::kWidePlace) == 0) {
                addSeveral(i, tileOf(place & 0xFFFF));
            } else {
                for (const uint32_t end = *wide_end++; wide < end; ++wide) {
                    addWide(wide);
                }
            }
        }
    }

    void placeRecords() {
        uint32_t sum = 0;
        uint32_t* const offsets = chunk_.offsets.data();
        for (size_t i = 0; i < chunk_.offsets.size(); ++i) {
            sum += std::exchange(offsets[i], sum);
        }
        TileTriangle* const records = chunk_.records.reserve(sum);
        const TileTriangle* const special = scratch_.special.data();
        for (const BinScratch::Entry& e : scratch_.entries) {
            constexpr uint32_t kSpecial = TriangleBatch::kCapacity;
            records[offsets[e.tile]++] =
                e.source < kSpecial ? batch_.records[e.source] : special[e.source - kSpecial];
        }
        // Placing advanced every offset to the start of the next tile: shift back.
        std::memmove(offsets + 1, offsets, (chunk_.offsets.size() - 1) * sizeof(uint32_t));
        offsets[0] = 0;
    }

  private:
    uint32_t tileOf(uint32_t place) const {
        return (place >> 8) * width_ + (place & 0xFF) - first_;
    }

    void add(uint32_t tile, uint32_t source) {
        scratch_.entries.push_back({tile, source});
        ++chunk_.offsets[tile];
    }

    TileTriangle& addSpecial(uint32_t tile) {
        add(tile, TriangleBatch::kCapacity + uint32_t(scratch_.special.size()));
        return scratch_.special.emplace_back();
    }

    /// `tile` is the first one of those that the triangle touches, two in a row at most.
    void addSeveral(uint32_t i, uint32_t tile) {
        const TileTriangle& t = batch_.records[i];
        const int right = t.x1 >> kTileShift, below = t.y1 >> kTileShift;
        const bool test_edges = right > 0 && below > 0;
        for (int y = 0; y <= below; ++y) {
            for (int x = 0; x <= right; ++x) {
                if (test_edges && outsideAnEdge(expand(t, 0, 0), x * kTileSize, y * kTileSize)) {
                    continue;
                }
                TileTriangle& record = addSpecial(tile + uint32_t(y) * width_ + uint32_t(x));
                record = t;
                for (Corner16& c : record.corner) {
                    c.x_fx8 = int16_t(c.x_fx8 - x * kTileFx8);
                    c.y_fx8 = int16_t(c.y_fx8 - y * kTileFx8);
                }
                record.x0 = x > 0 ? 0 : t.x0;
                record.y0 = y > 0 ? 0 : t.y0;
                record.x1 = uint8_t(std::min(t.x1 - x * kTileSize, kTileSize - 1));
                record.y1 = uint8_t(std::min(t.y1 - y * kTileSize, kTileSize - 1));
            }
        }
    }

    void addWide(uint32_t i) {
        const SetupTriangle& t = chunk_.wide[i];
        const PixelBox box = scratch_.wide_boxes[i];
        const TileRect tiles = tilesOf(box);
        const bool test_edges = tiles.x1 > tiles.x0 && tiles.y1 > tiles.y0;
        for (int y = tiles.y0; y <= tiles.y1; ++y) {
            for (int x = tiles.x0; x <= tiles.x1; ++x) {
                if (test_edges && outsideAnEdge(t, x * kTileSize, y * kTileSize)) {
                    continue;
                }
                TileTriangle& record = addSpecial(uint32_t(y) * width_ + uint32_t(x) - first_);
                record.x0 = uint8_t(std::max(box.x0 - x * kTileSize, 0));
                record.y0 = uint8_t(std::max(box.y0 - y * kTileSize, 0));
                record.x1 = uint8_t(std::min(box.x1 - x * kTileSize, kTileSize - 1));
                record.y1 = uint8_t(std::min(box.y1 - y * kTileSize, kTileSize - 1));
                record.id = i | kWide | (t.swapped != 0 ? kSwapped : 0);
            }
        }
    }

    const TriangleBatch& batch_;
    BinScratch& scratch_;
    Chunk& chunk_;
    uint32_t width_ = 0, first_ = 0;  ///< of the rectangle; tile (0, 0) would be number −first_
};

}  // namespace

void binChunk(const ChunkInput& input, const FrameView& view, const GeometryKernels& kernels,
              BinScratch& scratch, Chunk& chunk) {
    chunk.vertices = input.projection->out;
    chunk.first = input.first;
    chunk.surface = input.surface_index;
    chunk.alpha = input.surface->material->alpha_mode != AlphaMode::opaque;
    chunk.wide.clear();
    chunk.clips.clear();
    scratch.entries.clear();
    scratch.special.clear();
    scratch.wide_boxes.clear();
    scratch.wide_ends.clear();

    TriangleBatch& batch = scratch.batch;
    kernels.cullTriangles({.indices = input.surface->indices + size_t(input.first) * 3,
                           .vertices = chunk.vertices,
                           .count = input.count,
                           .sample_x_fx8 = kSubpixelHalf + view.jitter_x_fx8,
                           .sample_y_fx8 = kSubpixelHalf + view.jitter_y_fx8,
                           .width = view.width,
                           .height = view.height},
                          batch);
    uint32_t compact = batch.count;
    if ((batch.flags & TriangleBatch::kWidePlace) != 0) {
        WideSetup setup(input, view, scratch, chunk);
        for (uint32_t i = 0; i < batch.count; ++i) {
            if ((batch.place[i] & TriangleBatch::kWidePlace) != 0) {
                setup.add(batch.records[i].id & kTriangleMask);
                scratch.wide_ends.push_back(uint32_t(chunk.wide.size()));
                --compact;
            }
        }
    }
    TileSort sort(scratch, chunk);
    if (sort.bound()) {
        sort.list();
        sort.placeRecords();
    }
    scratch.counters.triangles += input.count;
    scratch.counters.binned += compact + chunk.wide.size();
    scratch.counters.tile_refs += scratch.entries.size();
}

}  // namespace still::internal
