// Visibility of a tile: which triangle is nearest at each sample; see visibility_reference.cpp for
// the truth. Included once per target by kernels_simd.cpp.
//
// Triangles are set up many at once (cover-inl.h), then drawn one after the other by the size of
// their boxes: up to 4 × 4 samples by the mask of covered ones; up to 16 × 16 row by row; the rest
// by the 8 × 8 blocks of the tile, of which a row is tested at once. A block is left out when an
// edge has it outside or when the triangle's nearest depth in it is behind everything that is
// there; where all edges have it inside they are not tested again:
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

#if HWY_TARGET == HWY_SCALAR

void rasterizeTile(TileContext& tile) {
    referenceKernels().rasterizeTile(tile);
}

#else

/// Edges as 32 bits from the sample (x, y) of the tile. Exact: edges that keep one sign all over
/// the tile are replaced by a constant where that is needed.
struct TileEdges {
    int x, y;
    int32_t c[3], a[3], b[3];
};

/// False when the whole tile is outside of an edge.
inline bool tileEdges(const SetupTriangle& t, const TileContext& tile, TileEdges& out) {
    out.x = out.y = 0;
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

/// Lower bounds of the depths in each block. Every triangle raises depths, so an old bound stays a
/// bound; it is worth renewing when as many samples as a block has have been drawn since.
struct BlockBounds {
    alignas(64) float min[kBlocksPerTile * kBlocksPerTile] = {};
    uint32_t drawn[kBlocksPerTile * kBlocksPerTile] = {};
};
constexpr uint32_t kDrawnBeforeRenewal = kBlockSize * kBlockSize;
constexpr int kLastInBlock = kBlockSize - 1;

HWY_INLINE int blockAt(int x, int y) {
    return y / kBlockSize * kBlocksPerTile + x / kBlockSize;
}

inline void renewBound(const TileContext& tile, BlockBounds& bounds, int b) {
    const float* depth =
        tile.depth + b / kBlocksPerTile * kBlockSize * kTileSize + b % kBlocksPerTile * kBlockSize;
    FVec lowest = splat(3.0e38f);
    for (int y = 0; y < kBlockSize; ++y) {
        for (int x = 0; x < kBlockSize; x += int(hn::Lanes(FTag()))) {
            lowest = hn::Min(lowest, hn::Load(FTag(), depth + y * kTileSize + x));
        }
    }
    bounds.min[b] = hn::GetLane(hn::MinOfLanes(FTag(), lowest));
    bounds.drawn[b] = 0;
}

/// Samples that are tested at once: 8 columns, or as many as there are lanes, of one row or two.
using SampleTag = shading::FTag;
using SampleIntTag = hn::RebindToSigned<SampleTag>;
using SampleVec = hn::Vec<SampleTag>;
using SampleMask = hn::Mask<SampleTag>;
constexpr int kColumnsAtOnce = std::min(kBlockSize, int(hn::MaxLanes(SampleTag())));
constexpr int kRowsAtOnce = int(hn::MaxLanes(SampleTag())) / kColumnsAtOnce;

HWY_INLINE hn::Vec<SampleIntTag> laneX() {
    const SampleIntTag d;
    return hn::And(hn::Iota(d, 0), hn::Set(d, kColumnsAtOnce - 1));
}

HWY_INLINE hn::Vec<SampleIntTag> laneY() {
    const SampleIntTag d;
    return kRowsAtOnce == 1 ? hn::Zero(d) : hn::ShiftRight<3>(hn::Iota(d, 0));
}

template <class T, class D = hn::Rebind<T, SampleTag>>
HWY_INLINE hn::Vec<D> loadSamples(const T* from) {
    if constexpr (kRowsAtOnce == 1) {
        return hn::LoadU(D(), from);
    } else {
        const hn::Half<D> half;
        return hn::Combine(D(), hn::LoadU(half, from + kTileSize), hn::LoadU(half, from));
    }
}

template <class T, class D = hn::Rebind<T, SampleTag>>
HWY_INLINE void storeSamples(hn::Vec<D> v, T* to) {
    if constexpr (kRowsAtOnce == 1) {
        hn::StoreU(v, D(), to);
    } else {
        const hn::Half<D> half;
        hn::StoreU(hn::LowerHalf(half, v), half, to);
        hn::StoreU(hn::UpperHalf(half, v), half, to + kTileSize);
    }
}

/// One triangle in one tile. kTested: each sample that passes is tested for alpha or shaded, too.
/// Such triangles come late, so that as few samples as possible are left; at equal depth they go
/// before those that were submitted after them.
template <bool kTested>
struct TriangleInTile {
    TileContext& tile;
    BlockBounds& bounds;
    const uint32_t index;
    const Chunk& chunk;
    const TilePlane plane;
    const TileEdges& edges;

    int32_t* visible() const { return reinterpret_cast<int32_t*>(tile.visible); }

    bool reaches(float nearest, float bound) const {
        return kTested ? nearest >= bound : nearest > bound;
    }

    /// The samples of `pass` that are drawn, and those of `equal` if they go before what is there.
    HWY_INLINE SampleMask tested(int x, int y, SampleMask pass, SampleMask equal) const {
        const SampleTag d;
        const SampleIntTag di;
        const auto later =
            hn::Gt(loadSamples(visible() + y * kTileSize + x), hn::Set(di, int32_t(index)));
        pass = hn::Or(pass, hn::And(equal, hn::RebindMask(d, later)));
        // Where forward shading must not write.
        const auto column = hn::Add(laneX(), hn::Set(di, x)),
                   row = hn::Add(laneY(), hn::Set(di, y));
        const auto beyond =
            hn::Or(hn::Gt(column, hn::Set(di, plane.x1)), hn::Gt(row, hn::Set(di, plane.y1)));
        pass = hn::AndNot(hn::RebindMask(d, beyond), pass);
        if (hn::AllFalse(d, pass)) {
            return pass;
        }
        prepareTriangle(tile, chunk, index);
        return chunk.alpha ? hn::And(pass, shading::alphaMask(tile, tile.shade[index], column, row))
                           : pass;
    }

    HWY_INLINE void shadePassed(int x, int y, SampleMask pass) const {
        const uint32_t bits = maskBits(SampleTag(), pass);
        constexpr uint32_t kRow = (1u << kColumnsAtOnce) - 1u;
        for (int row = 0; row < kRowsAtOnce; ++row) {
            if ((bits >> row * kColumnsAtOnce & kRow) != 0) {
                shading::shadeFragments(tile, index, x, y + row,
                                        bits >> row * kColumnsAtOnce & kRow);
            }
        }
    }

    /// The rows from y0 to y1 or one more of a group of columns from x. Returns the lane-wise
    /// smallest depths. Samples beyond the picture may be written; clearBeyond() takes them back.
    template <bool kAllInside>
    HWY_INLINE SampleVec columns(int x, int y0, int y1) const {
        const SampleTag d;
        const SampleIntTag di;
        const SampleVec along = hn::Mul(
            hn::Set(d, plane.dx), hn::ConvertTo(d, hn::Add(laneX(), hn::Set(di, x - plane.x0))));
        SampleVec down = hn::ConvertTo(d, hn::Add(laneY(), hn::Set(di, y0 - plane.y0)));
        hn::Vec<SampleIntTag> e[3];
        for (int k = 0; k < 3 && !kAllInside; ++k) {
            const int32_t c = edges.c[k] + edges.a[k] * (x - edges.x) + edges.b[k] * (y0 - edges.y);
            e[k] = hn::Add(hn::Set(di, c), hn::Add(hn::Mul(laneX(), hn::Set(di, edges.a[k])),
                                                   hn::Mul(laneY(), hn::Set(di, edges.b[k]))));
        }
        SampleVec lowest = hn::Set(d, 3.0e38f);
        for (int y = y0; y <= y1; y += kRowsAtOnce) {
            const int i = y * kTileSize + x;
            const SampleVec row =
                hn::Add(hn::Set(d, plane.origin), hn::Mul(hn::Set(d, plane.dy), down));
            const SampleVec z =
                hn::Min(hn::Max(hn::Add(row, along), hn::Set(d, plane.min)), hn::Set(d, plane.max));
            const SampleVec old = loadSamples(tile.depth + i);
            SampleMask pass = hn::Gt(z, old), equal = hn::Eq(z, old);
            if constexpr (!kAllInside) {
                const auto outside = hn::Or(hn::Or(e[0], e[1]), e[2]);
                const SampleMask covered = hn::RebindMask(d, hn::Gt(outside, hn::Set(di, -1)));
                pass = hn::And(pass, covered);
                equal = hn::And(equal, covered);
                for (int k = 0; k < 3; ++k) {
                    e[k] = hn::Add(e[k], hn::Set(di, edges.b[k] * kRowsAtOnce));
                }
            }
            down = hn::Add(down, hn::Set(d, float(kRowsAtOnce)));
            if constexpr (kTested) {
                pass = tested(x, y, pass, equal);
            }
            if (hn::AllFalse(d, pass)) {
                lowest = hn::Min(lowest, old);
                continue;
            }
            const SampleVec now = hn::IfThenElse(pass, z, old);
            lowest = hn::Min(lowest, now);
            storeSamples(now, tile.depth + i);
            storeSamples(hn::IfThenElse(hn::RebindMask(di, pass), hn::Set(di, int32_t(index)),
                                        loadSamples(visible() + i)),
                         visible() + i);
            if (kTested && tile.forward) {
                shadePassed(x, y, pass);
            }
        }
        return lowest;
    }

    /// All rows of the box; every block it touches.
    HWY_INLINE void rows() const {
        const int bx0 = plane.x0 / kBlockSize, bx1 = plane.x1 / kBlockSize;
        const int by0 = plane.y0 / kBlockSize, by1 = plane.y1 / kBlockSize;
        const float nearest =
            plane.at(plane.dx > 0.0f ? plane.x1 : plane.x0, plane.dy > 0.0f ? plane.y1 : plane.y0);
        bool hidden = true;
        for (int by = by0; by <= by1; ++by) {
            for (int bx = bx0; bx <= bx1; ++bx) {
                const int b = by * kBlocksPerTile + bx;
                if (reaches(nearest, bounds.min[b]) && bounds.drawn[b] >= kDrawnBeforeRenewal) {
                    renewBound(tile, bounds, b);
                }
                hidden &= !reaches(nearest, bounds.min[b]);
            }
        }
        if (hidden) {
            ++tile.blocks_hidden;
            return;
        }
        for (int x = plane.x0; x <= plane.x1; x += kColumnsAtOnce) {
            // Testing some samples twice does no harm, reaching beyond the tile does.
            columns<false>(std::min(x, kTileSize - kColumnsAtOnce), plane.y0, plane.y1);
        }
        const uint32_t samples = uint32_t((plane.x1 - plane.x0 + 1) * (plane.y1 - plane.y0 + 1));
        for (int by = by0; by <= by1; ++by) {
            for (int bx = bx0; bx <= bx1; ++bx) {
                bounds.drawn[by * kBlocksPerTile + bx] += std::min(samples, 32u);
            }
        }
    }

    /// The block's samples within the triangle's bounds.
    template <bool kAllInside>
    HWY_INLINE void block(int bx, int by) const {
        const int y0 = std::max(by, plane.y0), y1 = std::min(by + kLastInBlock, plane.y1);
        float lowest = 3.0e38f;
        for (int x = bx; x < bx + kBlockSize; x += kColumnsAtOnce) {
            const SampleVec depths = columns<kAllInside>(x, y0, y1);
            lowest = std::min(lowest, hn::GetLane(hn::MinOfLanes(SampleTag(), depths)));
        }
        const int b = blockAt(bx, by);
        if (y1 - y0 == kLastInBlock) {
            bounds.min[b] = lowest;
            bounds.drawn[b] = 0;
        } else {
            bounds.drawn[b] += uint32_t(y1 - y0 + 1) * kBlockSize;
        }
    }

    /// Lanes are blocks of a row.
    struct BlockSteps {
        IVec x, first_x, last_x;  ///< the first sample; bounded by the box
        FVec along;               ///< plane.dx · distance of the nearest sample
        IVec edge[3];             ///< a · x
        int32_t high[3], low[3];  ///< the farthest that an edge grows and falls in a block
    };

    HWY_INLINE BlockSteps blockSteps(int first_block) const {
        BlockSteps s;
        s.x = hn::ShiftLeft<3>(hn::Iota(ITag(), first_block));
        s.first_x = hn::Max(s.x, splatInt(plane.x0));
        s.last_x = hn::Min(hn::Add(s.x, splatInt(kLastInBlock)), splatInt(plane.x1));
        const IVec nearest_x = plane.dx > 0.0f ? s.last_x : s.first_x;
        s.along =
            hn::Mul(splat(plane.dx), hn::ConvertTo(FTag(), hn::Sub(nearest_x, splatInt(plane.x0))));
        for (int k = 0; k < 3; ++k) {
            s.edge[k] = hn::Mul(splatInt(edges.a[k]), s.x);
            s.high[k] = (std::max(edges.a[k], 0) + std::max(edges.b[k], 0)) * kLastInBlock;
            s.low[k] = (std::min(edges.a[k], 0) + std::min(edges.b[k], 0)) * kLastInBlock;
        }
        return s;
    }

    HWY_INLINE void blockRow(const BlockSteps& s, int first_block, int by) const {
        constexpr uint32_t kLanes = (1u << hn::MaxLanes(ITag())) - 1u;
        const int y0 = std::max(by, plane.y0), y1 = std::min(by + kLastInBlock, plane.y1);
        const float row = plane.origin + plane.dy * float((plane.dy > 0.0f ? y1 : y0) - plane.y0);
        const FVec nearest =
            hn::Min(hn::Max(hn::Add(splat(row), s.along), splat(plane.min)), splat(plane.max));
        const int first = by / kBlockSize * kBlocksPerTile + first_block;
        const uint32_t boxed = ~maskBits(ITag(), hn::Gt(s.first_x, s.last_x)) & kLanes;
        const FVec bound = hn::LoadU(FTag(), bounds.min + first);
        const FMask reached = kTested ? hn::Ge(nearest, bound) : hn::Gt(nearest, bound);
        const uint32_t near = maskBits(FTag(), reached);
        tile.blocks_hidden += uint32_t(std::popcount(boxed & ~near));
        if ((boxed & near) == 0) {
            return;
        }
        IVec highest = splatInt(0), lowest = splatInt(0);
        for (int k = 0; k < 3; ++k) {
            const int32_t c = edges.c[k] + edges.b[k] * (by - edges.y) - edges.a[k] * edges.x;
            highest = hn::Or(highest, hn::Add(s.edge[k], splatInt(c + s.high[k])));
            lowest = hn::Or(lowest, hn::Add(s.edge[k], splatInt(c + s.low[k])));
        }
        const uint32_t outside = maskBits(ITag(), hn::Lt(highest, splatInt(0)));
        const uint32_t crossed = maskBits(ITag(), hn::Lt(lowest, splatInt(0)));
        tile.blocks_outside += uint32_t(std::popcount(boxed & near & outside));
        alignas(64) float nearest_of[hn::MaxLanes(FTag())];
        hn::Store(nearest, FTag(), nearest_of);
        for (uint32_t left = boxed & near & ~outside; left != 0; left &= left - 1) {
            const int lane = std::countr_zero(left);
            const int b = first + lane;
            if (bounds.drawn[b] >= kDrawnBeforeRenewal) {
                renewBound(tile, bounds, b);
                if (!reaches(nearest_of[lane], bounds.min[b])) {
                    ++tile.blocks_hidden;
                    continue;
                }
            }
            const int bx = (first_block + lane) * kBlockSize;
            if ((crossed >> lane & 1u) != 0) {
                block<false>(bx, by);
            } else {
                block<true>(bx, by);
            }
        }
    }

    void blocks() const {
        constexpr int kLanes = int(hn::MaxLanes(FTag()));
        for (int first = plane.x0 / kBlockSize & ~(kLanes - 1); first * kBlockSize <= plane.x1;
             first += kLanes) {
            const BlockSteps steps = blockSteps(first);
            for (int by = plane.y0 & ~kLastInBlock; by <= plane.y1; by += kBlockSize) {
                blockRow(steps, first, by);
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

/// The samples of a small triangle's mask that lie in the tile.
HWY_INLINE uint32_t smallSamples(const CoverBatch& batch, int lane) {
    constexpr uint32_t kColumns[kSmallSize] = {0x1111, 0x3333, 0x7777, 0xFFFF};
    return uint32_t(batch.samples[lane]) & kColumns[batch.x1[lane] - batch.x0[lane]] &
           ((0x10000u >> (4 * (3 - (batch.y1[lane] - batch.y0[lane])))) - 1u);
}

HWY_INLINE void drawSmall(TileContext& tile, BlockBounds& bounds, const CoverBatch& batch, int lane,
                          uint32_t index) {
    const float origin = batch.origin[lane], dx = batch.dx[lane], dy = batch.dy[lane];
    const float min = batch.min[lane], max = batch.max[lane];
    const int first = batch.y0[lane] * kTileSize + batch.x0[lane];
    const uint32_t samples = smallSamples(batch, lane);
    for (uint32_t left = samples; left != 0; left &= left - 1) {
        const int bit = std::countr_zero(left);
        const int i = bit & 3, j = bit >> 2;
        const float z = std::min(std::max((origin + dy * float(j)) + dx * float(i), min), max);
        const int at = first + j * kTileSize + i;
        if (z > tile.depth[at]) {
            tile.depth[at] = z;
            tile.visible[at] = index;
        }
    }
    bounds.drawn[blockAt(batch.x0[lane], batch.y0[lane])] += uint32_t(std::popcount(samples));
}

template <bool kTested>
HWY_NOINLINE void drawOne(TileContext& tile, BlockBounds& bounds, const CoverBatch& batch, int lane,
                          uint32_t i, const Chunk& chunk) {
    TileEdges edges;
    TilePlane plane;
    if ((batch.wide >> lane & 1u) != 0) {
        const SetupTriangle& t = chunk.wide[tile.triangles[i].id & kTriangleMask];
        if (!tileEdges(t, tile, edges)) {
            return;
        }
        plane = makeTilePlane(t, tile);
    } else {
        plane = {batch.x0[lane], batch.y0[lane],     batch.x1[lane],
                 batch.y1[lane], batch.origin[lane], batch.dx[lane],
                 batch.dy[lane], batch.min[lane],    batch.max[lane]};
        edges.x = plane.x0;
        edges.y = plane.y0;
        for (int k = 0; k < 3; ++k) {
            edges.c[k] = batch.c[k][lane];
            edges.a[k] = batch.a[k][lane];
            edges.b[k] = batch.b[k][lane];
        }
    }
    const TriangleInTile<kTested> t{tile, bounds, i, chunk, plane, edges};
    const int width = plane.x1 - plane.x0, height = plane.y1 - plane.y0;
    const bool narrow = width < kBlockSize || (width < 2 * kBlockSize && height < 2 * kBlockSize);
    // Rows may reach beyond the tile, where forward shading must not write.
    if (narrow && !(kTested && tile.forward)) {
        t.rows();
    } else {
        t.blocks();
    }
}

/// The triangles from `run` on, up to the first run whose surface is alpha-tested or not as that of
/// `run`. Returns the run that it stopped at.
template <bool kTested>
const TileRun* drawRuns(TileContext& tile, BlockBounds& bounds, const TileRun* run) {
    const TileRun* last = run;
    while (last->chunk != nullptr && last->chunk->alpha == run->chunk->alpha) {
        ++last;
    }
    CoverBatch batch;
    for (uint32_t first = run->begin; first < last->begin; first += kBatch) {
        const int count = int(std::min(last->begin - first, uint32_t(kBatch)));
        setUpBatch(tile, tile.triangles + first, count, batch);
        for (uint32_t left = batch.alive; left != 0; left &= left - 1) {
            const int lane = std::countr_zero(left);
            const uint32_t i = first + uint32_t(lane);
            while (i >= run[1].begin) {
                ++run;
            }
            if (!kTested && (batch.small >> lane & 1u) != 0) {
                drawSmall(tile, bounds, batch, lane, i);
            } else {
                drawOne<kTested>(tile, bounds, batch, lane, i, *run->chunk);
            }
        }
    }
    return last;
}

/// Shading reads whole vectors of a row, beyond the picture, too: nothing must be seen there.
inline void clearBeyond(TileContext& tile) {
    for (int y = 0; y < tile.height && tile.width < kTileSize; ++y) {
        const int first = y * kTileSize + tile.width;
        std::fill_n(tile.depth + first, kTileSize - tile.width, 0.0f);
        std::fill_n(tile.visible + first, kTileSize - tile.width, kNothingVisible);
    }
}

void rasterizeTile(TileContext& tile) {
    BlockBounds bounds;
    clearTile(tile);
    if (tile.forward) {
        shading::shadeTileLevel<0>(tile);  // all background
    }
    for (const bool tested : {false, true}) {
        const TileRun* run = tile.runs;
        while (run->chunk != nullptr) {
            if ((run->chunk->alpha || tile.forward) != tested) {
                ++run;
            } else {
                run =
                    tested ? drawRuns<true>(tile, bounds, run) : drawRuns<false>(tile, bounds, run);
            }
        }
    }
    clearBeyond(tile);
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace still::internal
HWY_AFTER_NAMESPACE();
