// Triangle stage, one triangle per lane; see triangles_reference.cpp for the truth.
// Included once per target by geometry_simd.cpp.
//
//     3 × 16 bytes per triangle, transposed      x y z of corner 0, 1, 2
//       → box of samples empty? no area? → out
//       → orient, make relative to the first tile
//       → the lanes that are left, packed together (compress), as records

HWY_BEFORE_NAMESPACE();
namespace still::internal {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR  // has neither blocks nor lanes to pack

void cullTriangles(const TriangleJob& job, TriangleBatch& batch) {
    cullTrianglesReference(job, batch);
}

#else

using TriTag = hn::CappedTag<int32_t, 16>;
using TriFloat = hn::RebindToFloat<TriTag>;
using TriVec = hn::Vec<TriTag>;
using TriMask = hn::Mask<TriTag>;

HWY_INLINE TriVec all(int32_t v) {
    return hn::Set(TriTag(), v);
}

/// Corner `k` of the triangles of a group.
struct CornerLanes {
    TriVec x, y, z;  ///< z: the bits of a float
};

/// Vertices of lanes first, first + 4, … as blocks of one vector.
template <class D>
HWY_INLINE hn::Vec<D> vertexBlocks(D d, const ScreenVertex* vertices, const uint32_t* index,
                                   int first) {
    if constexpr (hn::MaxLanes(D()) == 4) {
        return hn::Load(d, reinterpret_cast<const int32_t*>(vertices + index[first * 3]));
    } else {
        const hn::Half<D> half;
        return hn::Combine(d, vertexBlocks(half, vertices, index, first + int(hn::MaxLanes(half))),
                           vertexBlocks(half, vertices, index, first));
    }
}

/// `index` points to corner k of the group's first triangle.
HWY_INLINE CornerLanes loadCorners(const ScreenVertex* vertices, const uint32_t* index) {
    const TriTag d;
    const hn::RepartitionToWide<TriTag> dw;
    const TriVec v0 = vertexBlocks(d, vertices, index, 0);
    const TriVec v1 = vertexBlocks(d, vertices, index, 1);
    const TriVec v2 = vertexBlocks(d, vertices, index, 2);
    const TriVec v3 = vertexBlocks(d, vertices, index, 3);
    const auto xy01 = hn::BitCast(dw, hn::InterleaveLower(d, v0, v1));  // x0 x1 y0 y1
    const auto xy23 = hn::BitCast(dw, hn::InterleaveLower(d, v2, v3));
    const auto zw01 = hn::BitCast(dw, hn::InterleaveUpper(d, v0, v1));
    const auto zw23 = hn::BitCast(dw, hn::InterleaveUpper(d, v2, v3));
    return {hn::BitCast(d, hn::InterleaveLower(dw, xy01, xy23)),
            hn::BitCast(d, hn::InterleaveUpper(dw, xy01, xy23)),
            hn::BitCast(d, hn::InterleaveLower(dw, zw01, zw23))};
}

HWY_INLINE TriVec min3(TriVec a, TriVec b, TriVec c) {
    return hn::Min(hn::Min(a, b), c);
}
HWY_INLINE TriVec max3(TriVec a, TriVec b, TriVec c) {
    return hn::Max(hn::Max(a, b), c);
}

/// outcodeOf().
HWY_INLINE TriVec outcodeLanes(const TriangleJob& job, const CornerLanes& c) {
    const auto bit = [](TriMask mask, int value) { return hn::IfThenElseZero(mask, all(value)); };
    TriVec code = bit(hn::Lt(c.x, all(-kSubpixelOne)), kOutLeft);
    code = hn::Or(code, bit(hn::Gt(c.x, all((job.width + 1) * kSubpixelOne)), kOutRight));
    code = hn::Or(code, bit(hn::Lt(c.y, all(-kSubpixelOne)), kOutTop));
    code = hn::Or(code, bit(hn::Gt(c.y, all((job.height + 1) * kSubpixelOne)), kOutBottom));
    const TriFloat df;
    const auto far = hn::Lt(hn::BitCast(df, c.z), hn::Zero(df));
    code = hn::Or(code, bit(hn::RebindMask(TriTag(), far), kOutFar));
    return hn::IfThenElse(hn::Eq(c.x, all(kNoPosition)), c.y, code);
}

/// Moves the lanes of a mask to the front. Its own table, because Highway 1.0.3 copies that of
/// Compress to the stack on every call (AVX2: 36 instead of 9.5 ms for a million triangles).
struct LanePacking {
    static constexpr bool kNative = hn::MaxLanes(TriTag()) == 16;
    TriMask mask;
    decltype(hn::IndicesFromVec(TriTag(), TriVec())) indices;

    HWY_INLINE explicit LanePacking(TriMask kept) : mask(kept) {
        if constexpr (!kNative) {
            const TriTag d;
            const hn::Rebind<uint8_t, TriTag> d8;
            uint8_t bits[8] = {};
            hn::StoreMaskBits(d, kept, bits);
            const auto lanes = hn::LoadU(d8, kPackedLanes[bits[0]].data());
            indices = hn::IndicesFromVec(d, hn::PromoteTo(d, lanes));
        }
    }
    HWY_INLINE TriVec operator()(TriVec v) const {
        if constexpr (kNative) {
            return hn::Compress(v, mask);
        } else {
            return hn::TableLookupLanes(v, indices);
        }
    }
};

class BatchLanes {
  public:
    BatchLanes(const TriangleJob& job, TriangleBatch& batch) : job_(job), batch_(batch) {}

    /// Triangles `first` … of which `valid` exist; `index` holds their vertices.
    HWY_INLINE void add(const uint32_t* index, uint32_t first, TriMask valid) {
        const TriTag d;
        CornerLanes c[3];
        for (int k = 0; k < 3; ++k) {
            c[k] = loadCorners(job_.vertices, index + k);
        }
        const TriVec nowhere = all(kNoPosition);
        const TriMask unplaced = hn::Or(hn::Or(hn::Eq(c[0].x, nowhere), hn::Eq(c[1].x, nowhere)),
                                        hn::Eq(c[2].x, nowhere));
        const TriFloat df;
        // The sign bits of all three depths: beyond the far plane. −0 counts as nearer.
        const auto beyond =
            hn::RebindMask(d, hn::And(hn::And(hn::Lt(hn::BitCast(df, c[0].z), hn::Zero(df)),
                                              hn::Lt(hn::BitCast(df, c[1].z), hn::Zero(df))),
                                      hn::Lt(hn::BitCast(df, c[2].z), hn::Zero(df))));
        TriMask wide = hn::And(unplaced, valid);
        if (!hn::AllFalse(d, wide)) {
            wide = hn::And(wide, worthClipping(c));
        }
        const TriMask placed = hn::AndNot(hn::Or(unplaced, beyond), valid);

        for (int k = 0; k < 3; ++k) {
            c[k].x = hn::Sub(c[k].x, all(job_.sample_x_fx8));
            c[k].y = hn::Sub(c[k].y, all(job_.sample_y_fx8));
        }
        const TriVec min_x = min3(c[0].x, c[1].x, c[2].x), max_x = max3(c[0].x, c[1].x, c[2].x);
        const TriVec min_y = min3(c[0].y, c[1].y, c[2].y), max_y = max3(c[0].y, c[1].y, c[2].y);
        const TriVec round_up = all(kSubpixelOne - 1);
        const TriVec x0 =
            hn::Max(hn::Zero(d), hn::ShiftRight<kSubpixelBits>(hn::Add(min_x, round_up)));
        const TriVec y0 =
            hn::Max(hn::Zero(d), hn::ShiftRight<kSubpixelBits>(hn::Add(min_y, round_up)));
        const TriVec x1 = hn::Min(all(job_.width - 1), hn::ShiftRight<kSubpixelBits>(max_x));
        const TriVec y1 = hn::Min(all(job_.height - 1), hn::ShiftRight<kSubpixelBits>(max_y));
        const TriMask empty = hn::Or(hn::Gt(x0, x1), hn::Gt(y0, y1));
        const TriMask in_picture = hn::AndNot(empty, placed);
        const TriVec extent = hn::Max(hn::Sub(max_x, min_x), hn::Sub(max_y, min_y));
        const TriMask large = hn::Gt(extent, all(kCompactExtentFx8));
        wide = hn::Or(wide, hn::And(in_picture, large));

        const TriVec dx1 = hn::Sub(c[1].x, c[0].x), dy1 = hn::Sub(c[1].y, c[0].y);
        const TriVec dx2 = hn::Sub(c[2].x, c[0].x), dy2 = hn::Sub(c[2].y, c[0].y);
        const TriVec area2 = hn::Sub(hn::Mul(dx1, dy2), hn::Mul(dx2, dy1));
        const TriMask compact = hn::AndNot(hn::Or(large, hn::Eq(area2, hn::Zero(d))), in_picture);
        const TriMask kept = hn::Or(compact, wide);
        if (hn::AllFalse(d, kept)) {
            return;
        }

        const TriMask swapped = hn::And(hn::Lt(area2, hn::Zero(d)), compact);
        const CornerLanes c1 = c[1];
        c[1] = select(swapped, c[2], c1);
        c[2] = select(swapped, c1, c[2]);
        const TriVec tx = hn::ShiftRight<kTileShift>(x0), ty = hn::ShiftRight<kTileShift>(y0);
        const TriVec tx1 = hn::ShiftRight<kTileShift>(x1), ty1 = hn::ShiftRight<kTileShift>(y1);
        const TriMask several = hn::And(hn::Or(hn::Ne(tx, tx1), hn::Ne(ty, ty1)), compact);
        TriVec id = hn::Iota(d, int32_t(first));
        id = hn::Or(id, hn::IfThenElseZero(swapped, all(int32_t{kSwapped})));
        id = hn::Or(id, hn::IfThenElseZero(wide, all(int32_t{kWide})));

        constexpr int kTileFx8 = kTileShift + kSubpixelBits;
        const TriVec left = hn::ShiftLeft<kTileFx8>(tx), top = hn::ShiftLeft<kTileFx8>(ty);
        TriVec word[8];
        for (int k = 0; k < 3; ++k) {
            const TriVec x = hn::And(hn::Sub(c[k].x, left), all(0xFFFF));
            word[k] = hn::Or(x, hn::ShiftLeft<16>(hn::Sub(c[k].y, top)));
        }
        word[3] = c[0].z;
        word[4] = c[1].z;
        word[5] = c[2].z;
        const TriVec px = hn::ShiftLeft<kTileShift>(tx), py = hn::ShiftLeft<kTileShift>(ty);
        word[6] =
            hn::Or(hn::Or(hn::Sub(x0, px), hn::ShiftLeft<8>(hn::Sub(y0, py))),
                   hn::Or(hn::ShiftLeft<16>(hn::Sub(x1, px)), hn::ShiftLeft<24>(hn::Sub(y1, py))));
        word[7] = id;
        TriVec place = hn::Or(tx, hn::ShiftLeft<8>(ty));
        place =
            hn::Or(place, hn::IfThenElseZero(several, all(int32_t{TriangleBatch::kSeveralTiles})));
        place = hn::IfThenElse(wide, all(int32_t{TriangleBatch::kWidePlace}), place);
        store(word, place, kept);

        flags_ = hn::Or(flags_, hn::IfThenElseZero(kept, place));
        const TriVec most = all(INT32_MAX), least = all(-1);
        tile_x0_ = hn::Min(tile_x0_, hn::IfThenElse(compact, tx, most));
        tile_y0_ = hn::Min(tile_y0_, hn::IfThenElse(compact, ty, most));
        tile_x1_ = hn::Max(tile_x1_, hn::IfThenElse(compact, tx1, least));
        tile_y1_ = hn::Max(tile_y1_, hn::IfThenElse(compact, ty1, least));
    }

    HWY_INLINE void finish() {
        const TriTag d;
        uint32_t lanes[hn::MaxLanes(TriTag())];
        hn::StoreU(flags_, d, reinterpret_cast<int32_t*>(lanes));
        batch_.count = count_;
        batch_.flags = 0;
        for (uint32_t flags : lanes) {
            batch_.flags |= flags & ~0xFFFFu;
        }
        batch_.tile_x0 = hn::GetLane(hn::MinOfLanes(d, tile_x0_));
        batch_.tile_y0 = hn::GetLane(hn::MinOfLanes(d, tile_y0_));
        batch_.tile_x1 = hn::GetLane(hn::MaxOfLanes(d, tile_x1_));
        batch_.tile_y1 = hn::GetLane(hn::MaxOfLanes(d, tile_y1_));
    }

  private:
    /// Of lanes with a vertex that has no position: not outside of the frustum as a whole.
    HWY_INLINE TriMask worthClipping(const CornerLanes c[3]) const {
        const TriVec o0 = outcodeLanes(job_, c[0]), o1 = outcodeLanes(job_, c[1]),
                     o2 = outcodeLanes(job_, c[2]);
        const TriVec outside = hn::And(hn::And(o0, o1), hn::And(o2, all(kOutFrustum)));
        const TriVec invalid = hn::And(hn::Or(hn::Or(o0, o1), o2), all(kOutInvalid));
        return hn::Eq(hn::Or(outside, invalid), hn::Zero(TriTag()));
    }

    static HWY_INLINE CornerLanes select(TriMask mask, const CornerLanes& a, const CornerLanes& b) {
        return {hn::IfThenElse(mask, a.x, b.x), hn::IfThenElse(mask, a.y, b.y),
                hn::IfThenElse(mask, a.z, b.z)};
    }

    HWY_INLINE void store(const TriVec word[8], TriVec place, TriMask kept) {
        const TriTag d;
        const LanePacking pack(kept);
        storeHalves(pack(word[0]), pack(word[1]), pack(word[2]), pack(word[3]), 0);
        storeHalves(pack(word[4]), pack(word[5]), pack(word[6]), pack(word[7]), 16);
        hn::StoreU(pack(place), d, reinterpret_cast<int32_t*>(batch_.place + count_));
        count_ += uint32_t(hn::CountTrue(d, kept));
    }

    /// Four words of each record, `offset` bytes from its start.
    HWY_INLINE void storeHalves(TriVec w0, TriVec w1, TriVec w2, TriVec w3, size_t offset) {
        const TriTag d;
        const hn::RepartitionToWide<TriTag> dw;
        const auto low01 = hn::BitCast(dw, hn::InterleaveLower(d, w0, w1));
        const auto low23 = hn::BitCast(dw, hn::InterleaveLower(d, w2, w3));
        const auto high01 = hn::BitCast(dw, hn::InterleaveUpper(d, w0, w1));
        const auto high23 = hn::BitCast(dw, hn::InterleaveUpper(d, w2, w3));
        char* to = reinterpret_cast<char*>(batch_.records + count_) + offset;
        constexpr size_t kStep = sizeof(TileTriangle);
        storeBlocks(d, hn::BitCast(d, hn::InterleaveLower(dw, low01, low23)), to);
        storeBlocks(d, hn::BitCast(d, hn::InterleaveUpper(dw, low01, low23)), to + kStep);
        storeBlocks(d, hn::BitCast(d, hn::InterleaveLower(dw, high01, high23)), to + 2 * kStep);
        storeBlocks(d, hn::BitCast(d, hn::InterleaveUpper(dw, high01, high23)), to + 3 * kStep);
    }

    /// Blocks of 16 bytes into every fourth record.
    template <class D>
    static HWY_INLINE void storeBlocks(D d, hn::Vec<D> v, char* to) {
        if constexpr (hn::MaxLanes(D()) == 4) {
            hn::StoreU(v, d, reinterpret_cast<int32_t*>(to));
        } else {
            const hn::Half<D> half;
            storeBlocks(half, hn::LowerHalf(half, v), to);
            storeBlocks(half, hn::UpperHalf(half, v),
                        to + hn::MaxLanes(half) * sizeof(TileTriangle));
        }
    }

    const TriangleJob& job_;
    TriangleBatch& batch_;
    uint32_t count_ = 0;
    TriVec flags_ = hn::Zero(TriTag());
    TriVec tile_x0_ = all(INT32_MAX), tile_y0_ = all(INT32_MAX);
    TriVec tile_x1_ = all(-1), tile_y1_ = all(-1);
};

void cullTriangles(const TriangleJob& job, TriangleBatch& batch) {
    const TriTag d;
    constexpr uint32_t kLanes = uint32_t(hn::MaxLanes(TriTag()));
    BatchLanes lanes(job, batch);
    uint32_t i = 0;
    for (; i + kLanes <= job.count; i += kLanes) {
        lanes.add(job.indices + size_t(i) * 3, i, hn::FirstN(d, kLanes));
    }
    if (i < job.count) {
        // The rest, padded with its first triangle.
        uint32_t index[kLanes * 3];
        for (uint32_t j = 0; j < kLanes * 3; ++j) {
            const uint32_t at = i * 3 + j;
            index[j] = job.indices[at < job.count * 3 ? at : i * 3];
        }
        lanes.add(index, i, hn::FirstN(d, job.count - i));
    }
    lanes.finish();
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace still::internal
HWY_AFTER_NAMESPACE();
