#include "rasterizer/internal/tile.h"

#include <bit>

#include "rasterizer/fixed.h"
#include "rasterizer/internal/triangle_setup.h"

namespace still::internal {

SetupTriangle setupOf(const TileTriangle& record, const Chunk& chunk, int tile_x0, int tile_y0) {
    const uint32_t number = record.id & kTriangleMask;
    if ((record.id & kWide) != 0) {
        return chunk.wide[number];
    }
    SetupTriangle t = expand(record, tile_x0, tile_y0);
    t.triangle = chunk.first + number;
    return t;
}

TilePlane makeTilePlane(const SetupTriangle& t, const TileContext& tile) {
    const PixelBox box = pixelBox(t, tile.x0 + tile.width, tile.y0 + tile.height);
    TilePlane p;
    p.x0 = std::max(box.x0 - tile.x0, 0);
    p.y0 = std::max(box.y0 - tile.y0, 0);
    p.x1 = box.x1 - tile.x0;
    p.y1 = box.y1 - tile.y0;
    const DepthPlane z = depthPlane(t);
    p.origin = float(z.origin + (z.dx * (tile.x0 + p.x0) + z.dy * (tile.y0 + p.y0)));
    p.dx = float(z.dx);
    p.dy = float(z.dy);
    p.min = std::min({t.z[0], t.z[1], t.z[2]});
    p.max = std::max({t.z[0], t.z[1], t.z[2]});
    return p;
}

namespace {

/// Copies the records of all chunks one behind the other, so that kernels take as many at once as
/// they have lanes.
void collectTriangles(const FrameBins& bins, int tx, int ty, TileContext& tile,
                      TileScratch& scratch) {
    scratch.runs.clear();
    uint32_t count = 0;
    for (size_t i = 0; i < bins.count; ++i) {
        if (!bins.rects[i].holds(tx, ty)) {
            continue;
        }
        const Chunk& chunk = bins.chunks[i];
        const Chunk::Range range = chunk.recordsOf(tx, ty);
        if (range.begin != range.end) {
            scratch.runs.push_back({count, &chunk});
            count += uint32_t(range.end - range.begin);
        }
    }
    scratch.runs.push_back({count, nullptr});
    TileTriangle* triangles = scratch.triangles.reserve(count + kMaxBatch);
    for (const TileRun* run = scratch.runs.data(); run->chunk != nullptr; ++run) {
        const Chunk::Range range = run->chunk->recordsOf(tx, ty);
        std::copy(range.begin, range.end, triangles + run->begin);
    }
    std::fill_n(triangles + count, kMaxBatch, TileTriangle{});
    tile.triangles = triangles;
    tile.triangle_count = count;
    tile.runs = scratch.runs.data();
    tile.run_count = uint32_t(scratch.runs.size()) - 1;
    tile.shade = scratch.shade.reserve(count + 1);
    tile.shade_ready = scratch.shade_ready.reserve(count);
    std::fill_n(tile.shade_ready, count, uint8_t{0});
    tile.seen = scratch.seen.reserve(count + 1);
}

TilePlanes planesAt(GBuffer& g, int x, int y) {
    const auto at = [&](auto& image) { return image.empty() ? nullptr : image.view().row(y) + x; };
    TilePlanes p;
    p.red = at(g.red);
    p.green = at(g.green);
    p.blue = at(g.blue);
    p.albedo_red = at(g.albedo_red);
    p.albedo_green = at(g.albedo_green);
    p.albedo_blue = at(g.albedo_blue);
    p.id = at(g.id);
    p.depth = at(g.depth);
    p.normal = at(g.normal);
    p.motion = at(g.motion);
    p.depth_before = at(g.depth_before);
    p.stride = g.red.view().stride;
    return p;
}

/// In a tile in which nothing moved motion is zero. Called when the tile is shaded; zeros that
/// stand already are left.
void writeStillMotion(const TilePlanes& planes, int width, int height, uint8_t& motion_is_zero) {
    for (int y = 0; y < height && motion_is_zero == 0; ++y) {
        std::fill_n(planes.motion + y * planes.stride, width, Motion{});
    }
    motion_is_zero = 1;
}

}  // namespace

void renderTile(const FrameSetup& setup, const FrameBins& bins, const RasterSettings& settings,
                int tx, int ty, GBuffer& out, TileScratch& scratch) {
    const auto now = [&] { return settings.ticks != nullptr ? settings.ticks() : 0; };
    const uint64_t start = now();
    const FrameTables& frame = setup.tables;
    TileContext tile;
    tile.frame = &frame;
    tile.x0 = tx * kTileSize;
    tile.y0 = ty * kTileSize;
    tile.width = std::min(kTileSize, frame.view->width - tile.x0);
    tile.height = std::min(kTileSize, frame.view->height - tile.y0);
    tile.forward = settings.shading == Shading::forward;
    tile.depth = scratch.depth;
    tile.visible = scratch.visible;
    tile.planes = planesAt(out, tile.x0, tile.y0);
    tile.reproject = tileReprojection(frame, tile.x0, tile.y0);

    collectTriangles(bins, tx, ty, tile, scratch);

    const TileFacts& facts = setup.facts[size_t(ty) * size_t(out.tiles_x) + size_t(tx)];
    const TilePlanes planes = tile.planes;
    const bool still_motion = facts.still() && planes.motion != nullptr;
    uint8_t& motion_is_zero = out.motion_is_zero[size_t(ty) * size_t(out.tiles_x) + size_t(tx)];
    if (still_motion) {
        tile.planes.motion = nullptr;
    } else {
        motion_is_zero = 0;
    }

    const RasterKernels& kernels = kernelsFor(settings.simd);
    kernels.rasterizeTile(tile);
    const uint64_t visible = now();
    if (!tile.forward) {
        kernels.prepareShading(tile);
        kernels.shadeTile(tile);
    }
    if (still_motion) {
        writeStillMotion(planes, tile.width, tile.height, motion_is_zero);
    }
    RasterCounters& counters = scratch.counters;
    ++counters.tiles;
    counters.tiles_empty += tile.triangle_count == 0 ? 1 : 0;
    counters.blocks_hidden += tile.blocks_hidden;
    counters.blocks_outside += tile.blocks_outside;
    counters.pixels_shaded += tile.pixels_shaded;
    counters.ticks.visibility += visible - start;
    counters.ticks.shade += now() - visible;
}

}  // namespace still::internal
