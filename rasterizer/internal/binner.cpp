#include "rasterizer/internal/binner.h"

#include <algorithm>
#include <cmath>

#include "rasterizer/fixed.h"
#include "rasterizer/internal/clip.h"
#include "rasterizer/internal/triangle_setup.h"

namespace still::internal {

namespace {

constexpr int kTileShift = 6;
static_assert(1 << kTileShift == kTileSize);

class ChunkBuilder {
  public:
    ChunkBuilder(const ChunkInput& input, const FrameView& view, Chunk& chunk)
        : input_(input),
          view_(view),
          chunk_(chunk),
          sample_x_fx8_(kSubpixelHalf + view.jitter_x_fx8),
          sample_y_fx8_(kSubpixelHalf + view.jitter_y_fx8) {}

    void addTriangle(uint32_t triangle) {
        const ScreenVertices& screen = input_.projection.out;
        const uint32_t* index = input_.surface->indices + size_t(triangle) * 3;
        const uint8_t c0 = screen.outcode[index[0]], c1 = screen.outcode[index[1]],
                      c2 = screen.outcode[index[2]];
        constexpr uint8_t kReject =
            kOutNear | kOutLeft | kOutRight | kOutTop | kOutBottom | kOutFar;
        if ((c0 & c1 & c2 & kReject) != 0 || ((c0 | c1 | c2) & kOutInvalid) != 0) {
            return;
        }
        if (((c0 | c1 | c2) & (kOutNear | kOutGuard)) != 0) {
            addClipped(triangle, index);
            return;
        }
        const ScreenVertex v[3] = {snappedVertex(index[0]), snappedVertex(index[1]),
                                   snappedVertex(index[2])};
        add(v, triangle, -1);
    }

    void sortByTile() {
        chunk_.pair_tile.clear();
        chunk_.pair_triangle.clear();
        chunk_.tile_x0 = chunk_.tile_y0 = chunk_.tiles_w = chunk_.tiles_h = 0;
        if (!chunk_.triangles.empty()) {
            chunk_.tile_x0 = box_.x0 >> kTileShift;
            chunk_.tile_y0 = box_.y0 >> kTileShift;
            chunk_.tiles_w = (box_.x1 >> kTileShift) - chunk_.tile_x0 + 1;
            chunk_.tiles_h = (box_.y1 >> kTileShift) - chunk_.tile_y0 + 1;
        }
        for (uint32_t i = 0; i < chunk_.triangles.size(); ++i) {
            listTiles(i);
        }
        countingSort();
        chunk_.counters.binned = chunk_.triangles.size();
        chunk_.counters.tile_refs = chunk_.items.size();
    }

  private:
    /// As the vertex stage left it.
    ScreenVertex snappedVertex(uint32_t i) const {
        const ScreenVertices& screen = input_.projection.out;
        return {screen.x_fx8[i], screen.y_fx8[i], screen.z[i], screen.inv_w[i], 0};
    }

    void add(const ScreenVertex v[3], uint32_t triangle, int32_t clip) {
        SetupTriangle t;
        if (!setupTriangle(v, sample_x_fx8_, sample_y_fx8_, view_.width, view_.height, t)) {
            return;
        }
        t.triangle = triangle;
        t.clip = clip;
        t.surface = input_.surface_index;
        t.alpha = input_.surface->material->alpha_mode != AlphaMode::opaque;
        const PixelBox box = pixelBox(t, view_.width, view_.height);
        box_ = {std::min(box_.x0, box.x0), std::min(box_.y0, box.y0), std::max(box_.x1, box.x1),
                std::max(box_.y1, box.y1)};
        chunk_.triangles.push_back(t);
    }

    void addClipped(uint32_t triangle, const uint32_t index[3]) {
        const VertexJob& job = input_.projection;
        ClipVertex corners[3];
        for (int k = 0; k < 3; ++k) {
            const uint32_t i = index[k];
            corners[k] = transformVertex(job.clip, job.x[i], job.y[i], job.z[i]);
        }
        ClippedVertex polygon[kMaxClippedCorners];
        const double guard_x = double(job.guard_fx8) / double(job.scale_x_fx8);
        const double guard_y = -double(job.guard_fx8) / double(job.scale_y_fx8);
        const int count = clipTriangle(corners, guard_x, guard_y, polygon);
        ++chunk_.counters.clipped;
        ScreenVertex screen[kMaxClippedCorners];
        for (int k = 0; k < count; ++k) {
            // A corner that clipping did not make must be where an unclipped neighbour has it.
            const int source = polygon[k].source;
            const bool snapped =
                source >= 0 && (job.out.outcode[index[source]] & (kOutNear | kOutGuard)) == 0;
            screen[k] = snapped ? snappedVertex(index[source]) : projectClipped(polygon[k]);
        }
        for (int k = 2; k < count; ++k) {
            const int fan[3] = {0, k - 1, k};
            ScreenVertex v[3];
            ClipBarycentrics b;
            for (int j = 0; j < 3; ++j) {
                v[j] = screen[fan[j]];
                std::transform(polygon[fan[j]].b, polygon[fan[j]].b + 3, b.b[j],
                               [](double v) { return float(v); });
            }
            chunk_.clips.push_back(b);
            add(v, triangle, int32_t(chunk_.clips.size()) - 1);
        }
    }

    /// As projectVertex(), but in double, and a corner that rounding left a hair outside is taken.
    ScreenVertex projectClipped(const ClippedVertex& p) const {
        const VertexJob& job = input_.projection;
        const double r = 1.0 / std::max(p.w, 1e-20);
        const double limit = double(job.guard_fx8) + kSubpixelOne;
        const auto snap = [&](double v, float scale) {
            return int32_t(std::floor(std::clamp(v * r * double(scale), -limit, limit) + 0.5));
        };
        return {snap(p.x, job.scale_x_fx8) + job.centre_x_fx8,
                snap(p.y, job.scale_y_fx8) + job.centre_y_fx8, std::min(float(p.z * r), 1.0f),
                float(r), 0};
    }

    /// A tile is left out when one edge has all its samples outside.
    void listTiles(uint32_t i) {
        const SetupTriangle& t = chunk_.triangles[i];
        const PixelBox box = pixelBox(t, view_.width, view_.height);
        const int x0 = box.x0 >> kTileShift, x1 = box.x1 >> kTileShift;
        const int y0 = box.y0 >> kTileShift, y1 = box.y1 >> kTileShift;
        const bool test_edges = x1 > x0 && y1 > y0;
        for (int ty = y0; ty <= y1; ++ty) {
            for (int tx = x0; tx <= x1; ++tx) {
                if (test_edges && outsideAnEdge(t, tx << kTileShift, ty << kTileShift)) {
                    continue;
                }
                chunk_.pair_tile.push_back(
                    uint32_t((ty - chunk_.tile_y0) * chunk_.tiles_w + tx - chunk_.tile_x0));
                chunk_.pair_triangle.push_back(i);
            }
        }
    }

    static bool outsideAnEdge(const SetupTriangle& t, int x, int y) {
        for (int k = 0; k < 3; ++k) {
            const Edge e = makeEdge(t, k, x, y);
            const int64_t best =
                e.c + int64_t{std::max(e.a, 0) + std::max(e.b, 0)} * (kTileSize - 1);
            if (best < 0) {
                return true;
            }
        }
        return false;
    }

    void countingSort() {
        const size_t tiles = size_t(chunk_.tiles_w) * size_t(chunk_.tiles_h);
        chunk_.offsets.assign(tiles + 1, 0);
        for (uint32_t tile : chunk_.pair_tile) {
            ++chunk_.offsets[tile + 1];
        }
        for (size_t i = 1; i <= tiles; ++i) {
            chunk_.offsets[i] += chunk_.offsets[i - 1];
        }
        chunk_.items.resize(chunk_.pair_tile.size());
        for (size_t i = 0; i < chunk_.pair_tile.size(); ++i) {
            chunk_.items[chunk_.offsets[chunk_.pair_tile[i]]++] = chunk_.pair_triangle[i];
        }
        // Placing advanced every offset to the start of the next tile: shift back.
        for (size_t i = tiles; i > 0; --i) {
            chunk_.offsets[i] = chunk_.offsets[i - 1];
        }
        chunk_.offsets[0] = 0;
    }

    const ChunkInput& input_;
    const FrameView& view_;
    Chunk& chunk_;
    int sample_x_fx8_, sample_y_fx8_;
    PixelBox box_{INT32_MAX, INT32_MAX, INT32_MIN, INT32_MIN};
};

}  // namespace

void binChunk(const ChunkInput& input, const FrameView& view, Chunk& chunk) {
    chunk.triangles.clear();
    chunk.clips.clear();
    chunk.counters = {};
    chunk.counters.triangles = input.count;
    ChunkBuilder builder(input, view, chunk);
    for (uint32_t i = 0; i < input.count; ++i) {
        builder.addTriangle(input.first + i);
    }
    builder.sortByTile();
}

}  // namespace still::internal
