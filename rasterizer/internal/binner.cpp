#include "rasterizer/internal/binner.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "rasterizer/fixed.h"
#include "rasterizer/internal/clip.h"
#include "rasterizer/internal/triangle_setup.h"
#include "rasterizer/internal/vertex_reference.h"

namespace still::internal {

namespace {

constexpr int kTileFx8 = kTileSize * kSubpixelOne;

// BinScratch::Entry::source: an index in the batch and how far its tile is from the first one, or
// an index in Chunk::wide.
constexpr uint32_t kSourceMask = 0xFFFF;
constexpr uint32_t kTileRight = 1u << 16, kTileBelow = 1u << 17;
constexpr uint32_t kSourceSeveral = 1u << 18, kSourceWide = 1u << 19;
static_assert(TriangleBatch::kCapacity <= kSourceMask &&
              kChunkTriangles * (kMaxClippedCorners - 2) <= kSourceMask);

/// A tile is left out when one edge has all its samples outside.
bool outsideAnEdge(const SetupTriangle& t, int tile_x0, int tile_y0) {
    for (int k = 0; k < 3; ++k) {
        const Edge e = makeEdge(t, k, tile_x0, tile_y0);
        if (e.c + int64_t{std::max(e.a, 0) + std::max(e.b, 0)} * (kTileSize - 1) < 0) {
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
    TileSort(const FrameView& view, BinScratch& scratch, Chunk& chunk)
        : view_(view), batch_(scratch.batch), scratch_(scratch), chunk_(chunk) {}

    /// Sets the rectangle; false when nothing is visible.
    bool bound() {
        TileRect r{INT16_MAX, INT16_MAX, -1, -1};
        if (batch_.tile_x1 >= 0) {
            r = {int16_t(batch_.tile_x0), int16_t(batch_.tile_y0), int16_t(batch_.tile_x1),
                 int16_t(batch_.tile_y1)};
        }
        for (const SetupTriangle& t : chunk_.wide) {
            const TileRect tiles = tilesOf(pixelBox(t, view_.width, view_.height));
            r = {std::min(r.x0, tiles.x0), std::min(r.y0, tiles.y0), std::max(r.x1, tiles.x1),
                 std::max(r.y1, tiles.y1)};
        }
        chunk_.rect = r.x1 < 0 ? TileRect{} : r;
        return r.x1 >= 0;
    }

    /// Lists which triangle goes to which tile, and counts.
    void listEntries() {
        chunk_.offsets.assign(size_t(chunk_.rect.width()) * size_t(chunk_.rect.height()) + 1, 0);
        uint32_t wide = 0;
        const uint32_t* wide_end = scratch_.wide_ends.data();
        for (uint32_t i = 0; i < batch_.count; ++i) {
            const uint32_t id = batch_.rest[i].id;
            if ((id & (kWide | kSeveralTiles)) == 0) {
                addEntry(firstTile(i), i);
            } else if ((id & kWide) == 0) {
                listSeveral(i);
            } else {
                for (const uint32_t end = *wide_end++; wide < end; ++wide) {
                    listWide(wide);
                }
            }
        }
    }

    void placeRecords() {
        uint32_t sum = 0;
        for (uint32_t& offset : chunk_.offsets) {
            const uint32_t count = offset;
            offset = sum;
            sum += count;
        }
        TileTriangle* records = chunk_.records.reserve(sum);
        for (const BinScratch::Entry& e : scratch_.entries) {
            TileTriangle& record = records[chunk_.offsets[e.tile]++];
            if ((e.source & ~kSourceMask) == 0) {
                record = recordOf(e.source);
            } else {
                record = specialRecord(e);
            }
        }
        // Placing advanced every offset to the start of the next tile: shift back.
        std::memmove(chunk_.offsets.data() + 1, chunk_.offsets.data(),
                     (chunk_.offsets.size() - 1) * sizeof(uint32_t));
        chunk_.offsets[0] = 0;
    }

  private:
    uint32_t firstTile(uint32_t i) const {
        const uint32_t x = batch_.tile[i] & 0xFFFF, y = batch_.tile[i] >> 16;
        return (y - uint32_t(chunk_.rect.y0)) * uint32_t(chunk_.rect.width()) + x -
               uint32_t(chunk_.rect.x0);
    }

    void addEntry(uint32_t tile, uint32_t source) {
        scratch_.entries.push_back({tile, source});
        ++chunk_.offsets[tile];
    }

    TileTriangle recordOf(uint32_t i) const {
        TileTriangle record;
        std::memcpy(static_cast<void*>(&record), batch_.head + i, sizeof(TriangleBatch::Head));
        std::memcpy(reinterpret_cast<char*>(&record) + sizeof(TriangleBatch::Head), batch_.rest + i,
                    sizeof(TriangleBatch::Rest));
        return record;
    }

    /// Relative to the tile `right` and `below` the first one, which it touches.
    TileTriangle severalRecord(uint32_t i, int right, int below) const {
        TileTriangle record = recordOf(i);
        for (Corner16& c : record.corner) {
            c.x_fx8 = int16_t(c.x_fx8 - right * kTileFx8);
            c.y_fx8 = int16_t(c.y_fx8 - below * kTileFx8);
        }
        const auto clampToTile = [](uint8_t& low, uint8_t& high, int tiles) {
            low = tiles > 0 ? 0 : low;
            high = uint8_t(std::min(high - tiles * kTileSize, kTileSize - 1));
        };
        clampToTile(record.x0, record.x1, right);
        clampToTile(record.y0, record.y1, below);
        record.id &= ~kSeveralTiles;
        return record;
    }

    void listSeveral(uint32_t i) {
        const TriangleBatch::Rest& r = batch_.rest[i];
        const int right = r.x1 >> kTileShift, below = r.y1 >> kTileShift;
        const uint32_t tile = firstTile(i);
        for (int y = 0; y <= below; ++y) {
            for (int x = 0; x <= right; ++x) {
                if (right > 0 && below > 0 &&
                    outsideAnEdge(expand(severalRecord(i, x, y), 0, 0), 0, 0)) {
                    continue;
                }
                addEntry(tile + uint32_t(y * chunk_.rect.width() + x),
                         i | kSourceSeveral | (x > 0 ? kTileRight : 0) | (y > 0 ? kTileBelow : 0));
            }
        }
    }

    void listWide(uint32_t i) {
        const SetupTriangle& t = chunk_.wide[i];
        const TileRect tiles = tilesOf(pixelBox(t, view_.width, view_.height));
        const bool test_edges = tiles.x1 > tiles.x0 && tiles.y1 > tiles.y0;
        for (int y = tiles.y0; y <= tiles.y1; ++y) {
            for (int x = tiles.x0; x <= tiles.x1; ++x) {
                if (test_edges && outsideAnEdge(t, x << kTileShift, y << kTileShift)) {
                    continue;
                }
                addEntry(uint32_t((y - chunk_.rect.y0) * chunk_.rect.width() + x - chunk_.rect.x0),
                         i | kSourceWide);
            }
        }
    }

    TileTriangle specialRecord(const BinScratch::Entry& e) const {
        const uint32_t i = e.source & kSourceMask;
        if ((e.source & kSourceWide) == 0) {
            return severalRecord(i, (e.source & kTileRight) != 0, (e.source & kTileBelow) != 0);
        }
        const SetupTriangle& t = chunk_.wide[i];
        const int x = int(e.tile) % chunk_.rect.width() + chunk_.rect.x0;
        const int y = int(e.tile) / chunk_.rect.width() + chunk_.rect.y0;
        const PixelBox box = pixelBox(t, view_.width, view_.height);
        TileTriangle record{};
        record.x0 = uint8_t(std::max(box.x0 - x * kTileSize, 0));
        record.y0 = uint8_t(std::max(box.y0 - y * kTileSize, 0));
        record.x1 = uint8_t(std::min(box.x1 - x * kTileSize, kTileSize - 1));
        record.y1 = uint8_t(std::min(box.y1 - y * kTileSize, kTileSize - 1));
        record.id = i | kWide | (t.swapped != 0 ? kSwapped : 0);
        return record;
    }

    const FrameView& view_;
    const TriangleBatch& batch_;
    BinScratch& scratch_;
    Chunk& chunk_;
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
    if ((batch.flags & kWide) != 0) {
        WideSetup setup(input, view, scratch, chunk);
        for (uint32_t i = 0; i < batch.count; ++i) {
            if ((batch.rest[i].id & kWide) != 0) {
                setup.add(batch.rest[i].id & kTriangleMask);
                scratch.wide_ends.push_back(uint32_t(chunk.wide.size()));
                --compact;
            }
        }
    }
    TileSort sort(view, scratch, chunk);
    if (sort.bound()) {
        sort.listEntries();
        sort.placeRecords();
    }
    scratch.counters.triangles += input.count;
    scratch.counters.binned += compact + chunk.wide.size();
    scratch.counters.tile_refs += scratch.entries.size();
}

}  // namespace still::internal
