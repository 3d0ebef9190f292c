// Coverage and visibility of a tile; see visibility_reference.cpp for the truth.
// Included once per target by kernels_simd.cpp.
//
// A triangle visits the 8 × 8 blocks of its bounds in the tile. A block is skipped when an edge has
// it outside or when the triangle's nearest depth in it is behind everything that is there; edges
// that have it inside are not tested again. What is left goes row by row, 8 samples at a time:
//
//      tile 64 × 64               block 8 × 8
//    ┌──┬──┬──┬──┬┄             ┌────────────┐   e0 | e1 | e2 ≥ 0  → covered
//    │  │▒▒│▓▓│▓▓│              │ · · · ● ● ●│   z > depth         → visible
//    ├──┼──┼──┼──┼┄             │ · · ● ● ● ●│
//    │▒▒│▓▓│▓▓│▒▒│              │ · ● ● ● ● ●│
//    └──┴──┴──┴──┴┄             └────────────┘

HWY_BEFORE_NAMESPACE();
namespace still::internal {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Edge values as 32 bits, relative to the tile: exact, because edges that keep one sign all over
/// the tile are replaced by a constant first.
struct TileEdges {
    int32_t c[3], a[3], b[3];
};

/// False when the whole tile is outside of an edge.
inline bool tileEdges(const SetupTriangle& t, const TileContext& tile, TileEdges& out) {
    for (int k = 0; k < 3; ++k) {
        const Edge e = makeEdge(t, k, tile.x0, tile.y0);
        const int64_t high = int64_t{std::max(e.a, 0)} + std::max(e.b, 0);
        const int64_t low = int64_t{std::min(e.a, 0)} + std::min(e.b, 0);
        if (e.c + high * (kTileSize - 1) < 0) {
            return false;
        }
        const bool inside = e.c + low * (kTileSize - 1) >= 0;
        out.c[k] = inside ? 0 : int32_t(e.c);
        out.a[k] = inside ? 0 : e.a;
        out.b[k] = inside ? 0 : e.b;
    }
    return true;
}

HWY_INLINE FMask alphaMask(const TileContext& tile, const ShadeTriangle& triangle, int x, int y) {
    const Surface& s = tile.frame->surfaces[triangle.surface];
    FVec alpha = splat(s.material->opacity);
    if (s.alpha != nullptr) {
        const LaneTriangles<true> t{&triangle};
        const LaneBarycentrics p = barycentrics(t, hn::Iota(FTag(), float(x)), splat(float(y)));
        alpha = hn::Mul(alpha, sampleAlpha(*s.alpha, textureCoordinates(t, p, s.attributes)));
    }
    if (s.material->alpha_mode == AlphaMode::test) {
        return hn::Ge(alpha, splat(0.5f));
    }
    const UTag du;
    const UVec px = hn::Iota(du, uint32_t(tile.x0 + x));
    const uint32_t row = uint32_t(tile.y0 + y) * kHashY ^ uint32_t(triangle.surface) * kHashSurface;
    UVec h = hn::Xor(hn::Mul(px, hn::Set(du, kHashX)), hn::Set(du, row));
    h = hn::Xor(h, hn::ShiftRight<15>(h));
    h = hn::Mul(h, hn::Set(du, kHashMix));
    h = hn::Xor(h, hn::ShiftRight<12>(h));
    h = hn::Add(h, hn::Set(du, tile.frame->view->sample * kGoldenRatio));
    const FVec draw = hn::ConvertTo(FTag(), hn::BitCast(ITag(), hn::ShiftRight<16>(h)));
    return hn::Lt(draw, hn::Mul(alpha, splat(65536.0f)));
}

/// One triangle in one tile.
struct TriangleInTile {
    TileContext& tile;
    const uint32_t ref;
    const bool alpha;
    const TilePlane plane;
    const TileEdges& edges;
    float* block_min;

    /// Depth of 8 samples; x, y tile-local.
    HWY_INLINE FVec depthAt(int x, float row_depth) const {
        const FVec dx = hn::Sub(hn::Iota(FTag(), float(x)), splat(float(plane.x0)));
        const FVec z = hn::Add(splat(row_depth), hn::Mul(splat(plane.dx), dx));
        return hn::Min(hn::Max(z, splat(plane.min)), splat(plane.max));
    }

    /// Tests `lanes` samples from (x, y); returns the depths that stand there afterwards.
    HWY_INLINE FVec testLanes(int x, int y, float row_depth, hn::Mask<ITag> covered) const {
        const int i = y * kTileSize + x;
        const FVec z = depthAt(x, row_depth);
        const FVec old = hn::Load(FTag(), tile.depth + i);
        FMask pass = hn::And(hn::RebindMask(FTag(), covered), hn::Gt(z, old));
        if (alpha && !hn::AllFalse(FTag(), pass)) {
            pass = hn::And(pass, alphaMask(tile, tile.shade[ref], x, y));
        }
        if (hn::AllFalse(FTag(), pass)) {
            return old;
        }
        const FVec now = hn::IfThenElse(pass, z, old);
        hn::Store(now, FTag(), tile.depth + i);
        uint32_t* visible = tile.visible + i;
        hn::Store(hn::IfThenElse(hn::RebindMask(UTag(), pass), hn::Set(UTag(), ref),
                                 hn::Load(UTag(), visible)),
                  UTag(), visible);
        if (tile.forward) {
            shadeFragments(tile, ref, x, y, now, pass);
        }
        return now;
    }

    /// Samples of the block that lie in [x0, x1] × [y0, y1], the triangle's bounds.
    HWY_INLINE void block(int bx, int by, const int32_t corner[3], bool all_inside) const {
        const int lanes = int(hn::Lanes(FTag()));
        FVec nearest_kept = splat(3.0e38f);
        for (int y = by; y < by + kBlockSize; ++y) {
            const bool row_in_bounds = y >= plane.y0 && y <= plane.y1;
            const float row_depth = plane.origin + plane.dy * float(y - plane.y0);
            for (int x = bx; x < bx + kBlockSize; x += lanes) {
                if (!row_in_bounds) {
                    nearest_kept =
                        hn::Min(nearest_kept, hn::Load(FTag(), tile.depth + y * kTileSize + x));
                    continue;
                }
                const IVec column = hn::Iota(ITag(), x);
                auto covered = hn::And(hn::Gt(column, splatInt(plane.x0 - 1)),
                                       hn::Lt(column, splatInt(plane.x1 + 1)));
                if (!all_inside) {
                    const IVec dx = hn::Iota(ITag(), x - bx);
                    IVec outside = hn::Zero(ITag());
                    for (int k = 0; k < 3; ++k) {
                        const IVec row = splatInt(corner[k] + edges.b[k] * (y - by));
                        outside = hn::Or(outside, hn::Add(row, hn::Mul(dx, splatInt(edges.a[k]))));
                    }
                    covered = hn::And(covered, hn::Gt(outside, splatInt(-1)));
                }
                nearest_kept = hn::Min(nearest_kept, testLanes(x, y, row_depth, covered));
            }
        }
        block_min[by / kBlockSize * kBlocksPerTile + bx / kBlockSize] =
            hn::GetLane(hn::MinOfLanes(FTag(), nearest_kept));
    }

    /// The triangle's largest depth in a block: at the corner that its slopes point to.
    float nearestDepth(int bx, int by) const {
        const int x0 = std::max(bx, plane.x0), x1 = std::min(bx + kBlockSize - 1, plane.x1);
        const int y0 = std::max(by, plane.y0), y1 = std::min(by + kBlockSize - 1, plane.y1);
        return plane.at(plane.dx > 0.0f ? x1 : x0, plane.dy > 0.0f ? y1 : y0);
    }

    void allBlocks() const {
        constexpr int kLast = kBlockSize - 1;
        for (int by = plane.y0 & ~kLast; by <= plane.y1; by += kBlockSize) {
            for (int bx = plane.x0 & ~kLast; bx <= plane.x1; bx += kBlockSize) {
                const int b = by / kBlockSize * kBlocksPerTile + bx / kBlockSize;
                if (!(nearestDepth(bx, by) > block_min[b])) {
                    continue;
                }
                int32_t corner[3];
                bool outside = false, all_inside = true;
                for (int k = 0; k < 3; ++k) {
                    corner[k] = edges.c[k] + edges.a[k] * bx + edges.b[k] * by;
                    const int32_t high = std::max(edges.a[k], 0) + std::max(edges.b[k], 0);
                    const int32_t low = std::min(edges.a[k], 0) + std::min(edges.b[k], 0);
                    outside |= corner[k] + high * kLast < 0;
                    all_inside &= corner[k] + low * kLast >= 0;
                }
                if (!outside) {
                    block(bx, by, corner, all_inside);
                }
            }
        }
    }
};

inline void clearTile(TileContext& tile) {
    for (int i = 0; i < kTilePixels; i += int(hn::Lanes(FTag()))) {
        hn::Store(hn::Zero(FTag()), FTag(), tile.depth + i);
        hn::Store(hn::Set(UTag(), kNothingVisible), UTag(), tile.visible + i);
    }
}

void rasterizeTile(TileContext& tile) {
    float block_min[kBlocksPerTile * kBlocksPerTile] = {};
    clearTile(tile);
    if (tile.forward) {
        shadeTileLevel<0>(tile);  // all background
    }
    for (uint32_t ref = 0; ref < tile.ref_count; ++ref) {
        const SetupTriangle& t = *tile.refs[ref].triangle;
        TileEdges edges;
        if (tileEdges(t, tile, edges)) {
            TriangleInTile{tile, ref, t.alpha != 0, makeTilePlane(t, tile), edges, block_min}
                .allBlocks();
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace still::internal
HWY_AFTER_NAMESPACE();
