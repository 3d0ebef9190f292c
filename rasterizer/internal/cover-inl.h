// Edges, coverage of small triangles and depth planes, one triangle per lane; see
// visibility_reference.cpp, depthPlane() and makeTilePlane() for the truth. Included once per
// target by kernels_simd.cpp.

HWY_BEFORE_NAMESPACE();
namespace still::internal {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Lanes of samples, at most a row of a block.
using FTag = hn::CappedTag<float, kBlockSize>;
using ITag = hn::RebindToSigned<FTag>;
using UTag = hn::RebindToUnsigned<FTag>;
using FVec = hn::Vec<FTag>;
using IVec = hn::Vec<ITag>;
using UVec = hn::Vec<UTag>;
using FMask = hn::Mask<FTag>;

HWY_INLINE FVec splat(float v) {
    return hn::Set(FTag(), v);
}

HWY_INLINE IVec splatInt(int32_t v) {
    return hn::Set(ITag(), v);
}

#if HWY_TARGET != HWY_SCALAR  // which has no blocks of lanes

using BTag = hn::CappedTag<int32_t, kMaxBatch>;  ///< a batch
using BFTag = hn::RebindToFloat<BTag>;
using BHalf = hn::Half<BTag>;
using BDTag = hn::Rebind<double, BHalf>;  ///< half a batch
using BVec = hn::Vec<BTag>;
using BDVec = DoubleVec<BDTag>;
constexpr int kBatch = int(hn::MaxLanes(BTag()));

constexpr int kTriangleWords = sizeof(TileTriangle) / sizeof(int32_t);

/// Samples of a small triangle's mask in a row and in a column.
constexpr int kSmallSize = 4;

/// Up to kBatch consecutive triangles of a tile. Those that are wide have an id and nothing else.
struct alignas(64) CoverBatch {
    int32_t x0[kBatch], y0[kBatch], x1[kBatch], y1[kBatch];  ///< tile-local box, inclusive
    /// Edges as makeEdge() has them, for the box's first sample.
    int32_t c[3][kBatch], a[3][kBatch], b[3][kBatch];
    /// Bit 4·j + i: sample (x0 + i, y0 + j) is covered. Of boxes that fit only.
    int32_t samples[kBatch];
    float origin[kBatch], dx[kBatch], dy[kBatch], min[kBatch], max[kBatch];  ///< as TilePlane
    uint32_t alive;  ///< bit per lane: may cover a sample
    uint32_t small;  ///< its box fits the mask
    uint32_t wide;
};

/// Four words of the triangles `lane`, `lane` + 4, …, one block of lanes each. `at` tells where a
/// triangle's words stand.
template <class D, class At>
HWY_INLINE hn::Vec<D> loadBlocks(D d, int lane, const At& at) {
    constexpr int kLanes = int(hn::MaxLanes(D()));
    if constexpr (kLanes == 4) {
        return hn::LoadU(d, at(lane));
    } else {
        const hn::Half<D> half;
        return hn::Combine(d, loadBlocks(half, lane + kLanes / 2, at), loadBlocks(half, lane, at));
    }
}

template <class D, class At>
HWY_INLINE void storeBlocks(D d, hn::Vec<D> v, int lane, const At& at) {
    constexpr int kLanes = int(hn::MaxLanes(D()));
    if constexpr (kLanes == 4) {
        hn::StoreU(v, d, at(lane));
    } else {
        const hn::Half<D> half;
        storeBlocks(half, hn::LowerHalf(half, v), lane, at);
        storeBlocks(half, hn::UpperHalf(half, v), lane + kLanes / 2, at);
    }
}

/// Rows and columns of the 4 × 4 words in each block of lanes change places.
HWY_INLINE void transpose(BVec v[4]) {
    const BTag d;
    const hn::Repartition<uint64_t, BTag> d64;
    const auto low01 = hn::BitCast(d64, hn::InterleaveLower(d, v[0], v[1]));
    const auto low23 = hn::BitCast(d64, hn::InterleaveLower(d, v[2], v[3]));
    const auto high01 = hn::BitCast(d64, hn::InterleaveUpper(d, v[0], v[1]));
    const auto high23 = hn::BitCast(d64, hn::InterleaveUpper(d, v[2], v[3]));
    v[0] = hn::BitCast(d, hn::InterleaveLower(d64, low01, low23));
    v[1] = hn::BitCast(d, hn::InterleaveUpper(d64, low01, low23));
    v[2] = hn::BitCast(d, hn::InterleaveLower(d64, high01, high23));
    v[3] = hn::BitCast(d, hn::InterleaveUpper(d64, high01, high23));
}

/// Four consecutive words of each triangle as one vector each.
template <class At>
HWY_INLINE void loadTransposed(const At& at, BVec out[4]) {
    for (int row = 0; row < 4; ++row) {
        out[row] = loadBlocks(BTag(), row, at);
    }
    transpose(out);
}

/// The reverse.
template <class At>
HWY_INLINE void storeTransposed(BVec v[4], const At& at) {
    transpose(v);
    for (int row = 0; row < 4; ++row) {
        storeBlocks(BTag(), v[row], row, at);
    }
}

template <class D>
HWY_INLINE uint32_t maskBits(D d, hn::Mask<D> mask) {
    uint8_t bits[8] = {};
    hn::StoreMaskBits(d, mask, bits);
    return uint32_t(bits[0]) | uint32_t(bits[1]) << 8;
}

/// The depth planes of half a batch; steps and order as in depthPlane() and makeTilePlane().
template <class Half>
HWY_INLINE void depthPlanes(Half half, const BVec x[3], const BVec y[3], const BVec z_bits[3],
                            BVec area2, BVec x0, BVec y0, const TileContext& tile, CoverBatch& out,
                            int at) {
    const BDTag d;
    const hn::Rebind<float, BDTag> df;
    const auto wide = [&](BVec v) { return toDoubles(d, half(v)); };
    const auto wide_float = [&](BVec v) { return toDoubles(d, hn::BitCast(df, half(v))); };
    const BDVec x1 = wide(hn::Sub(x[1], x[0])), x2 = wide(hn::Sub(x[2], x[0]));
    const BDVec y1 = wide(hn::Sub(y[1], y[0])), y2 = wide(hn::Sub(y[2], y[0]));
    const BDVec z0 = wide_float(z_bits[0]);
    const BDVec z1 = sub(wide_float(z_bits[1]), z0), z2 = sub(wide_float(z_bits[2]), z0);
    const BDVec per_pixel = div(doubles(d, double(kSubpixelOne)), wide(area2));
    const BDVec dx = mul(sub(mul(z1, y2), mul(z2, y1)), per_pixel);
    const BDVec dy = mul(sub(mul(z2, x1), mul(z1, x2)), per_pixel);
    const auto absolute = [&](BVec v, int tile_at, double scale) {
        return mul(wide(hn::Add(v, hn::Set(BTag(), tile_at))), doubles(d, scale));
    };
    constexpr double kPixel = 1.0 / kSubpixelOne;
    const BDVec px = absolute(x[0], tile.x0 * kSubpixelOne, kPixel);
    const BDVec py = absolute(y[0], tile.y0 * kSubpixelOne, kPixel);
    const BDVec origin = sub(z0, add(mul(dx, px), mul(dy, py)));
    const BDVec at_box =
        add(origin, add(mul(dx, absolute(x0, tile.x0, 1.0)), mul(dy, absolute(y0, tile.y0, 1.0))));
    hn::Store(toFloats(df, at_box), df, out.origin + at);
    hn::Store(toFloats(df, dx), df, out.dx + at);
    hn::Store(toFloats(df, dy), df, out.dy + at);
}

/// The masks of samples; `e` are the edges at the first one.
HWY_INLINE BVec coverSmall(const BVec c[3], const BVec a[3], const BVec b[3]) {
    const BTag d;
    BVec outside = hn::Zero(d);  // bits are shifted in from the last sample to the first
    BVec row[3];
    for (int k = 0; k < 3; ++k) {
        const BVec last = hn::Add(hn::ShiftLeft<2>(a[k]), hn::ShiftLeft<2>(b[k]));
        row[k] = hn::Sub(hn::Add(c[k], last), hn::Add(a[k], b[k]));
    }
    for (int j = 0; j < kSmallSize; ++j) {
        BVec e[3] = {row[0], row[1], row[2]};
        for (int i = 0; i < kSmallSize; ++i) {
            const BVec any = hn::Or(hn::Or(e[0], e[1]), e[2]);
            outside = hn::Add(
                hn::Add(outside, outside),
                hn::BitCast(d, hn::ShiftRight<31>(hn::BitCast(hn::RebindToUnsigned<BTag>(), any))));
            for (int k = 0; k < 3; ++k) {
                e[k] = hn::Sub(e[k], a[k]);
            }
        }
        for (int k = 0; k < 3; ++k) {
            row[k] = hn::Sub(row[k], b[k]);
        }
    }
    return hn::Xor(outside, hn::Set(d, 0xFFFF));
}

/// Sets up `count` triangles of the tile; there are kBatch to read.
HWY_INLINE void setUpBatch(const TileContext& tile, const TileTriangle* triangles, int count,
                           CoverBatch& out) {
    const BTag d;
    const BFTag df;
    BVec word[8];
    const int32_t* words = reinterpret_cast<const int32_t*>(triangles);
    loadTransposed([words](int lane) { return words + lane * kTriangleWords; }, word);
    loadTransposed([words](int lane) { return words + lane * kTriangleWords + 4; }, word + 4);

    BVec x[3], y[3];
    for (int k = 0; k < 3; ++k) {
        x[k] = hn::ShiftRight<16>(hn::ShiftLeft<16>(word[k]));
        y[k] = hn::ShiftRight<16>(word[k]);
    }
    const BVec byte = hn::Set(d, 0xFF);
    const auto unsignedShift = [&](BVec v) {
        return hn::BitCast(d, hn::ShiftRight<24>(hn::BitCast(hn::RebindToUnsigned<BTag>(), v)));
    };
    const BVec x0 = hn::And(word[6], byte), y0 = hn::And(hn::ShiftRight<8>(word[6]), byte);
    const BVec x1 = hn::And(hn::ShiftRight<16>(word[6]), byte), y1 = unsignedShift(word[6]);

    BVec c[3], a[3], b[3];
    const BVec corner_x = hn::ShiftLeft<kSubpixelBits>(x0);
    const BVec corner_y = hn::ShiftLeft<kSubpixelBits>(y0);
    for (int k = 0; k < 3; ++k) {
        const int next = k == 2 ? 0 : k + 1;
        b[k] = hn::Sub(x[next], x[k]);
        const BVec dy = hn::Sub(y[next], y[k]);
        a[k] = hn::Neg(dy);
        const BVec at_corner =
            hn::Sub(hn::Mul(b[k], hn::Sub(corner_y, y[k])), hn::Mul(dy, hn::Sub(corner_x, x[k])));
        const auto top_left = hn::Or(hn::Lt(dy, hn::Zero(d)),
                                     hn::And(hn::Eq(dy, hn::Zero(d)), hn::Gt(b[k], hn::Zero(d))));
        c[k] = hn::ShiftRight<kSubpixelBits>(
            hn::Add(at_corner, hn::IfThenZeroElse(top_left, hn::Set(d, -1))));
        hn::Store(c[k], d, out.c[k]);
        hn::Store(a[k], d, out.a[k]);
        hn::Store(b[k], d, out.b[k]);
    }
    hn::Store(x0, d, out.x0);
    hn::Store(y0, d, out.y0);
    hn::Store(x1, d, out.x1);
    hn::Store(y1, d, out.y1);

    const BVec extent = hn::Max(hn::Sub(x1, x0), hn::Sub(y1, y0));
    const uint32_t valid = uint32_t((1u << count) - 1u);
    out.wide =
        maskBits(d, hn::Ne(hn::And(word[7], hn::Set(d, int32_t{kWide})), hn::Zero(d))) & valid;
    out.small = maskBits(d, hn::Lt(extent, hn::Set(d, kSmallSize))) & valid & ~out.wide;
    out.alive = valid;
    if (out.small != 0) {
        const BVec samples = coverSmall(c, a, b);
        hn::Store(samples, d, out.samples);
        out.alive &= ~(out.small & maskBits(d, hn::Eq(samples, hn::Zero(d))));
    }
    if ((out.alive & ~out.wide) == 0) {
        return;
    }
    const BVec area2 = hn::Sub(hn::Mul(b[0], hn::Sub(y[2], y[0])),
                               hn::Mul(hn::Sub(x[2], x[0]), hn::Sub(y[1], y[0])));
    constexpr int kHalf = kBatch / 2;
    depthPlanes([](BVec v) { return hn::LowerHalf(BHalf(), v); }, x, y, word + 3, area2, x0, y0,
                tile, out, 0);
    depthPlanes([](BVec v) { return hn::UpperHalf(BHalf(), v); }, x, y, word + 3, area2, x0, y0,
                tile, out, kHalf);
    const auto z0 = hn::BitCast(df, word[3]), z1 = hn::BitCast(df, word[4]),
               z2 = hn::BitCast(df, word[5]);
    hn::Store(hn::Min(hn::Min(z0, z1), z2), df, out.min);
    hn::Store(hn::Max(hn::Max(z0, z1), z2), df, out.max);
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace still::internal
HWY_AFTER_NAMESPACE();
