#include "rasterizer/internal/tile.h"

#include <bit>

#include "rasterizer/fixed.h"
#include "rasterizer/internal/triangle_setup.h"

namespace still::internal {

SetupTriangle setupOf(const TriangleRef& ref, int tile_x0, int tile_y0) {
    const Chunk& chunk = *ref.chunk;
    const uint32_t number = ref.record->id & kTriangleMask;
    if ((ref.record->id & kWide) != 0) {
        return chunk.wide[number];
    }
    SetupTriangle t = expand(*ref.record, tile_x0, tile_y0);
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

/// +1 when the interpolated normals look towards the eye, −1 when they have to be turned. The
/// side that is seen is the geometric one; which way its normal counts as outward is told by the
/// vertex normals, so that models with inconsistent winding are lit right, too.
float shadingFlip(const Surface& s, const InstanceSetup& instance, const uint32_t index[3],
                  bool counter_clockwise) {
    double p[3][3], n[3] = {0, 0, 0};
    for (int k = 0; k < 3; ++k) {
        p[k][0] = double(s.x[index[k]]);
        p[k][1] = double(s.y[index[k]]);
        p[k][2] = double(s.z[index[k]]);
        for (int i = 0; i < 3; ++i) {
            n[i] += double(s.attributes[size_t(index[k]) * 5 + size_t(i)]);
        }
    }
    double a[3], b[3];
    for (int i = 0; i < 3; ++i) {
        a[i] = p[1][i] - p[0][i];
        b[i] = p[2][i] - p[0][i];
    }
    const double along = ((a[1] * b[2] - a[2] * b[1]) * n[0] + (a[2] * b[0] - a[0] * b[2]) * n[1]) +
                         (a[0] * b[1] - a[1] * b[0]) * n[2];
    const bool winding_side_seen = counter_clockwise != instance.mirrored;
    return winding_side_seen == (along >= 0.0) ? 1.0f : -1.0f;
}

}  // namespace

void makeShadeTriangle(const FrameTables& frame, const TriangleRef& ref, int tile_x0, int tile_y0,
                       ShadeTriangle& out) {
    SetupTriangle t = setupOf(ref, tile_x0, tile_y0);
    const Surface& s = frame.surfaces[ref.chunk->surface];
    const int order[3] = {0, t.swapped != 0 ? 2 : 1, t.swapped != 0 ? 1 : 2};
    const uint32_t* index = s.indices + size_t(t.triangle) * 3;
    if ((ref.record->id & kWide) == 0) {
        for (int k = 0; k < 3; ++k) {
            t.inv_w[k] = ref.chunk->vertices[index[order[k]]].inv_w;
        }
    }
    const int anchor_x =
        std::max(tile_x0, (std::min({t.x_fx8[0], t.x_fx8[1], t.x_fx8[2]}) + 255) >> 8);
    const int anchor_y =
        std::max(tile_y0, (std::min({t.y_fx8[0], t.y_fx8[1], t.y_fx8[2]}) + 255) >> 8);
    double value[3], dx[3], dy[3];  // of p_k = λ_k / w_k, in the setup triangle's vertex order
    double area2 = 0;
    for (int k = 0; k < 3; ++k) {
        const int i = k == 2 ? 0 : k + 1;  // the edge opposite to vertex k runs from i to j
        const int j = i == 2 ? 0 : i + 1;
        const int64_t ex = t.x_fx8[j] - t.x_fx8[i], ey = t.y_fx8[j] - t.y_fx8[i];
        const int64_t e = ex * (anchor_y * kSubpixelOne - t.y_fx8[i]) -
                          ey * (anchor_x * kSubpixelOne - t.x_fx8[i]);
        value[k] = double(e);
        dx[k] = double(-ey * kSubpixelOne);
        dy[k] = double(ex * kSubpixelOne);
        area2 += value[k];
    }
    for (int k = 0; k < 3; ++k) {
        const double scale = double(t.inv_w[k]) / area2;
        value[k] *= scale;
        dx[k] *= scale;
        dy[k] *= scale;
    }
    for (int k = 0; k < 3; ++k) {
        double v = 0, vx = 0, vy = 0;
        for (int c = 0; c < 3; ++c) {
            // Setup corner c is source corner order[c], or a clipped corner between all three.
            const double weight = t.clip >= 0
                                      ? double(ref.chunk->clips[size_t(t.clip)].b[order[c]][k])
                                      : (order[c] == k ? 1.0 : 0.0);
            v += value[c] * weight;
            vx += dx[c] * weight;
            vy += dy[c] * weight;
        }
        out.p[k] = float(v);
        out.p_dx[k] = float(vx);
        out.p_dy[k] = float(vy);
        out.vertex[k] = int32_t(index[k]);
    }
    out.anchor_x = float(anchor_x - tile_x0);
    out.anchor_y = float(anchor_y - tile_y0);
    out.surface = ref.chunk->surface;
    // With y down, the triangles that had to be swapped run counter-clockwise on the screen.
    out.flip = shadingFlip(s, frame.instances[s.instance], index, t.swapped != 0);
}

namespace {

void collectRefs(const FrameBins& bins, int tx, int ty, std::vector<TriangleRef>& refs) {
    refs.clear();
    for (size_t i = 0; i < bins.count; ++i) {
        if (!bins.rects[i].holds(tx, ty)) {
            continue;
        }
        const Chunk& chunk = bins.chunks[i];
        const Chunk::Range range = chunk.recordsOf(tx, ty);
        for (const TileTriangle* record = range.begin; record != range.end; ++record) {
            refs.push_back({record, &chunk});
        }
    }
}

class TileRenderer {
  public:
    TileRenderer(const FrameSetup& setup, TileContext& tile, TileScratch& scratch)
        : setup_(setup), tile_(tile), scratch_(scratch) {
        scratch.shade.resize(scratch.refs.size());
        scratch.shade_ready.assign(scratch.refs.size(), 0);
        tile.shade = scratch.shade.data();
    }

    void prepareBeforeVisibility() {
        for (uint32_t ref = 0; ref < tile_.ref_count; ++ref) {
            if (tile_.forward || tile_.refs[ref].chunk->alpha) {
                prepare(ref);
            }
        }
    }

    void prepareVisible() {
        uint32_t last = kNothingVisible;
        for (int y = 0; y < tile_.height; ++y) {
            for (int x = 0; x < tile_.width; ++x) {
                const uint32_t ref = tile_.visible[y * kTileSize + x];
                scratch_.counters.pixels_shaded += ref != kNothingVisible ? 1 : 0;
                if (ref != last && ref != kNothingVisible) {
                    prepare(ref);
                    tile_.features |= setup_.surfaces[tile_.refs[ref].chunk->surface].features;
                }
                last = ref;
            }
        }
    }

  private:
    void prepare(uint32_t ref) {
        if (scratch_.shade_ready[ref] == 0) {
            scratch_.shade_ready[ref] = 1;
            makeShadeTriangle(setup_.tables, tile_.refs[ref], tile_.x0, tile_.y0, tile_.shade[ref]);
        }
    }

    const FrameSetup& setup_;
    TileContext& tile_;
    TileScratch& scratch_;
};

TilePlanes planesAt(GBuffer& g, int x, int y) {
    const auto at = [&](auto& image) { return image.empty() ? nullptr : image.view().row(y) + x; };
    TilePlanes p;
    p.red = at(g.red);
    p.green = at(g.green);
    p.blue = at(g.blue);
    p.id = at(g.id);
    p.depth = at(g.depth);
    p.normal = at(g.normal);
    p.motion = at(g.motion);
    p.depth_before = at(g.depth_before);
    p.stride = g.red.view().stride;
    return p;
}

/// In a tile in which nothing moved, motion is zero and the expected depth is the depth itself.
/// Called when the tile is shaded; zeros that stand already are left.
void writeStillMotion(const TilePlanes& planes, int width, int height, uint8_t& motion_is_zero) {
    for (int y = 0; y < height; ++y) {
        const ptrdiff_t at = y * planes.stride;
        if (motion_is_zero == 0) {
            std::fill_n(planes.motion + at, width, Motion{});
        }
        for (int x = 0; x < width; ++x) {
            planes.depth_before[at + x] = logDepth16(planes.depth[at + x]);
        }
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

    collectRefs(bins, tx, ty, scratch.refs);
    tile.refs = scratch.refs.data();
    tile.ref_count = uint32_t(scratch.refs.size());

    TileFacts& facts = out.tiles[size_t(ty) * size_t(out.tiles_x) + size_t(tx)];
    facts = {};
    facts.camera_moved = frame.camera_moved;
    facts.moved = setup.moved_tiles[size_t(ty) * size_t(out.tiles_x) + size_t(tx)] != 0;
    const TilePlanes planes = tile.planes;
    const bool still_motion = facts.still() && planes.motion != nullptr;
    uint8_t& motion_is_zero = out.motion_is_zero[size_t(ty) * size_t(out.tiles_x) + size_t(tx)];
    if (still_motion) {
        tile.planes.motion = nullptr;
    } else {
        motion_is_zero = 0;
    }

    const RasterKernels& kernels = kernelsFor(settings.simd);
    TileRenderer renderer(setup, tile, scratch);
    renderer.prepareBeforeVisibility();
    if (tile.forward) {
        tile.features = 0xFF;
    }
    kernels.rasterizeTile(tile);
    const uint64_t visible = now();
    if (!tile.forward) {
        renderer.prepareVisible();
        kernels.shadeTile(tile);
    }
    if (still_motion) {
        writeStillMotion(planes, tile.width, tile.height, motion_is_zero);
    }
    RasterCounters& counters = scratch.counters;
    counters.tiles_empty += tile.ref_count == 0 ? 1 : 0;
    counters.blocks_hidden += tile.blocks_hidden;
    counters.blocks_outside += tile.blocks_outside;
    counters.ticks.visibility += visible - start;
    counters.ticks.shade += now() - visible;
}

}  // namespace still::internal
