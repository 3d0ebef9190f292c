// Output pixels in lanes, a group of a row: what they share with the frame's pixels that hold them,
// and samples of a slot for them. Included once per target by taa_simd.cpp.

HWY_BEFORE_NAMESPACE();
namespace still::taa {
namespace HWY_NAMESPACE {

/// Vectors are handled in blocks of 128 bits, 8 lanes: neighbouring output pixels lie closer than
/// neighbouring samples, so that a block finds all of its samples among 8 of a row.
constexpr int kBlockLanes = 8;
constexpr int kBlocks = kHalves / kBlockLanes;

template <class D>
HWY_INLINE hn::Vec<D> fromBlocks(D d, const int16_t* const* blocks) {
    if constexpr (hn::MaxLanes(D()) <= kBlockLanes) {
        return hn::LoadU(d, blocks[0]);
    } else {
        const hn::Half<D> half;
        return hn::Combine(d, fromBlocks(half, blocks + hn::MaxLanes(half) / kBlockLanes),
                           fromBlocks(half, blocks));
    }
}
/// Lanes of each block by their numbers 0 … 7.
HWY_INLINE VS lanesOf(VS blocks, VS numbers) {
    const hn::Repartition<uint8_t, DS> d8;
    const VS bytes = hn::Add(hn::Mul(numbers, set(0x0202)), set(0x0100));
    return hn::BitCast(DS(), hn::TableLookupBytes(hn::BitCast(d8, blocks), hn::BitCast(d8, bytes)));
}

/// Samples of a plane at places that differ from lane to lane.
class Samples {
  public:
    /// `column` and `row` lie in the picture where `lanes`.
    HWY_INLINE Samples(VS column, VS row, MS lanes, int width, int height, ptrdiff_t stride) {
        const DS d;
        column = hn::Min(hn::Max(column, zero()), set(width - 1));
        row = hn::Min(hn::Max(row, zero()), set(height - 1));
        numbers_ = hn::Sub(column, lanesOf(column, zero()));
        const VS off =
            hn::Or(hn::AndNot(set(kBlockLanes - 1), numbers_), hn::Xor(row, lanesOf(row, zero())));
        close_ = !any(hn::And(lanes, hn::Ne(off, zero())));
        alignas(64) int16_t columns[kHalves], rows[kHalves];
        hn::Store(column, d, columns);
        hn::Store(row, d, rows);
        const int step = close_ ? kBlockLanes : 1;
        for (int i = 0, n = 0; i < kHalves; i += step, ++n) {
            at_[n] = rows[i] * stride + columns[i];
        }
    }
    HWY_INLINE VS of(const int16_t* plane) const {
        if (HWY_LIKELY(close_)) {
            const int16_t* blocks[kBlocks];
            for (int b = 0; b < kBlocks; ++b) {
                blocks[b] = plane + at_[b];
            }
            return lanesOf(fromBlocks(DS(), blocks), numbers_);
        }
        return gather(plane);
    }

  private:
    HWY_NOINLINE VS gather(const int16_t* plane) const {
        alignas(64) int16_t found[kHalves];
        for (int i = 0; i < kHalves; ++i) {
            found[i] = plane[at_[i]];
        }
        return hn::Load(DS(), found);
    }

    VS numbers_;             ///< lanes of their block, from its first one's sample on
    bool close_;             ///< all of each block's lie within 8 samples of a row
    ptrdiff_t at_[kHalves];  ///< of each block's first lane; or of each lane
};

/// The output pixels of a tile's columns.
struct OutputColumns {
    static constexpr int kMost = (kMaxUpscale * (kTileSize + 1) + kMaxHalves + 8) / 8 * 8;
    int first = 0, end = 0;
    alignas(64) int16_t number[kMost];  ///< of the frame's pixel, from its block's first one on
    alignas(64) int16_t offset[kMost];  ///< from that pixel's centre, 1/256 pixel of the frame
    int16_t base[kMost / kBlockLanes];  ///< of a block's first one: the frame's pixel in the tile

    OutputColumns(const upscale::Job& job, int tile_x0, int first_output, int end_output)
        : first(first_output), end(end_output) {
        for (int i = 0; i < kMost; ++i) {
            const int x = std::min(first + i, end - 1);
            const int pixel = job.x.pixelOf(x);
            if (i % kBlockLanes == 0) {
                base[i / kBlockLanes] = int16_t(pixel - tile_x0);
            }
            number[i] = int16_t(pixel - tile_x0 - base[i / kBlockLanes]);
            offset[i] = int16_t(job.x.toFrame(job.x.offsetOf(x, pixel)));
            if (first + i > end + kMaxHalves) {
                break;
            }
        }
    }
};

/// Values of a row of the frame's pixels in a tile.
struct PixelRow {
    alignas(64) int16_t of[kTileSize + kMaxHalves];

    HWY_INLINE void store(int i, VS v) { hn::Store(v, DS(), of + i); }
};

/// A group of a row's output pixels, `i` from the tile's first one on.
struct OutputGroup {
    const OutputColumns& columns;
    int i;
    VS number;

    HWY_INLINE OutputGroup(const OutputColumns& c, int first) : columns(c), i(first) {
        number = hn::LoadU(DS(), columns.number + i);
    }
    /// The values of the pixels that hold them.
    HWY_INLINE VS spread(const PixelRow& row) const {
        const int16_t* blocks[kBlocks];
        for (int b = 0; b < kBlocks; ++b) {
            blocks[b] = row.of + columns.base[i / kBlockLanes + b];
        }
        return lanesOf(fromBlocks(DS(), blocks), number);
    }
    HWY_INLINE MS spreadMask(const PixelRow& row) const { return hn::Ne(spread(row), zero()); }
    /// The first and last of those pixels.
    int firstPixel() const { return columns.base[i / kBlockLanes]; }
    int lastPixel() const {
        const int last = i + kHalves - 1;
        return columns.base[last / kBlockLanes] + columns.number[last];
    }
};

}  // namespace HWY_NAMESPACE
}  // namespace still::taa
HWY_AFTER_NAMESPACE();
