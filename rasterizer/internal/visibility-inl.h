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
        LaneTexture c = textureCoordinates(t, p, s);
        if (s.height != nullptr) {
            c = displacedCoordinates(*tile.frame, t, p, s, c);
        }
        alpha = hn::Mul(alpha, sampleAlpha(*s.alpha, c, s.mip_bias_fx8));
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

/// Lower bounds of the depths in each block. Every triangle raises depths, so an old bound stays a
/// bound; it is worth renewing when several triangles have drawn into the block since.
struct BlockBounds {
    float min[kBlocksPerTile * kBlocksPerTile] = {};
    uint8_t draws[kBlocksPerTile * kBlocksPerTile] = {};
};
constexpr int kDrawsBeforeRenewal = 4;

/// One triangle in one tile.
struct TriangleInTile {
    TileContext& tile;
    const uint32_t ref;
    const bool alpha;
    const TilePlane plane;
    const TileEdges& edges;
    BlockBounds& bounds;

    /// Tests the samples of `covered` from (x, y); returns the depths that stand there afterwards.
    HWY_INLINE FVec testLanes(int x, int y, FVec z, hn::Mask<ITag> covered) const {
        const int i = y * kTileSize + x;
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

    /// The rows y0 … y1 of a group of columns from x; `corner` are edge values at (x, y0). Returns
    /// the lane-wise smallest depths.
    template <bool kAllInside>
    HWY_INLINE FVec columns(int x, int y0, int y1, const int32_t corner[3]) const {
        const IVec column = hn::Iota(ITag(), x);
        const auto in_bounds =
            hn::And(hn::Gt(column, splatInt(plane.x0 - 1)), hn::Lt(column, splatInt(plane.x1 + 1)));
        const FVec along =
            hn::Mul(splat(plane.dx), hn::Sub(hn::Iota(FTag(), float(x)), splat(float(plane.x0))));
        IVec e[3];
        for (int k = 0; k < 3 && !kAllInside; ++k) {
            e[k] = hn::Add(splatInt(corner[k]), hn::Mul(hn::Iota(ITag(), 0), splatInt(edges.a[k])));
        }
        FVec lowest = splat(3.0e38f);
        for (int y = y0; y <= y1; ++y) {
            auto covered = in_bounds;
            if constexpr (!kAllInside) {
                const IVec outside = hn::Or(hn::Or(e[0], e[1]), e[2]);
                covered = hn::And(covered, hn::Gt(outside, splatInt(-1)));
                for (int k = 0; k < 3; ++k) {
                    e[k] = hn::Add(e[k], splatInt(edges.b[k]));
                }
            }
            const float row = plane.origin + plane.dy * float(y - plane.y0);
            const FVec z =
                hn::Min(hn::Max(hn::Add(splat(row), along), splat(plane.min)), splat(plane.max));
            lowest = hn::Min(lowest, testLanes(x, y, z, covered));
        }
        return lowest;
    }

    /// The block's samples within the triangle's bounds; `corner` are edge values at (bx, by).
    template <bool kAllInside>
    HWY_INLINE void block(int bx, int by, const int32_t corner[3]) const {
        const int y0 = std::max(by, plane.y0), y1 = std::min(by + kBlockSize - 1, plane.y1);
        FVec lowest = splat(3.0e38f);
        for (int x = bx; x < bx + kBlockSize; x += int(hn::Lanes(FTag()))) {
            int32_t first[3];
            for (int k = 0; k < 3; ++k) {
                first[k] = corner[k] + edges.a[k] * (x - bx) + edges.b[k] * (y0 - by);
            }
            lowest = hn::Min(lowest, columns<kAllInside>(x, y0, y1, first));
        }
        const int b = by / kBlockSize * kBlocksPerTile + bx / kBlockSize;
        if (y1 - y0 == kBlockSize - 1) {
            bounds.min[b] = hn::GetLane(hn::MinOfLanes(FTag(), lowest));
            bounds.draws[b] = 0;
        } else {
            bounds.draws[b] = uint8_t(std::min(bounds.draws[b] + 1, kDrawsBeforeRenewal));
        }
    }

    HWY_INLINE void renewBound(int bx, int by, int b) const {
        FVec lowest = splat(3.0e38f);
        for (int y = by; y < by + kBlockSize; ++y) {
            for (int x = bx; x < bx + kBlockSize; x += int(hn::Lanes(FTag()))) {
                lowest = hn::Min(lowest, hn::Load(FTag(), tile.depth + y * kTileSize + x));
            }
        }
        bounds.min[b] = hn::GetLane(hn::MinOfLanes(FTag(), lowest));
        bounds.draws[b] = 0;
    }

    /// The triangle's largest depth in a block: at the corner that its slopes point to.
    float nearestDepth(int bx, int by) const {
        const int x0 = std::max(bx, plane.x0), x1 = std::min(bx + kBlockSize - 1, plane.x1);
        const int y0 = std::max(by, plane.y0), y1 = std::min(by + kBlockSize - 1, plane.y1);
        return plane.at(plane.dx > 0.0f ? x1 : x0, plane.dy > 0.0f ? y1 : y0);
    }

    HWY_INLINE bool hidden(int bx, int by) const {
        const int b = by / kBlockSize * kBlocksPerTile + bx / kBlockSize;
        const float nearest = nearestDepth(bx, by);
        if (nearest > bounds.min[b] && bounds.draws[b] == kDrawsBeforeRenewal) {
            renewBound(bx, by, b);
        }
        return !(nearest > bounds.min[b]);
    }

    void allBlocks() const {
        constexpr int kLast = kBlockSize - 1;
        for (int by = plane.y0 & ~kLast; by <= plane.y1; by += kBlockSize) {
            for (int bx = plane.x0 & ~kLast; bx <= plane.x1; bx += kBlockSize) {
                if (hidden(bx, by)) {
                    ++tile.blocks_hidden;
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
                if (outside) {
                    ++tile.blocks_outside;
                    continue;
                }
                if (all_inside) {
                    block<true>(bx, by, corner);
                } else {
                    block<false>(bx, by, corner);
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
    BlockBounds bounds;
    clearTile(tile);
    if (tile.forward) {
        shadeTileLevel<0>(tile);  // all background
    }
    for (uint32_t ref = 0; ref < tile.ref_count; ++ref) {
        const SetupTriangle t = setupOf(tile.refs[ref], tile.x0, tile.y0);
        TileEdges edges;
        if (tileEdges(t, tile, edges)) {
            TriangleInTile{tile,  ref,   tile.refs[ref].chunk->alpha, makeTilePlane(t, tile),
                           edges, bounds}
                .allBlocks();
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace still::internal
HWY_AFTER_NAMESPACE();
