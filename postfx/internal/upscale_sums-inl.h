// Sums of a row of output pixels in lanes of 32 bits. Included once per target by
// upscale_sums_simd.cpp. What is written beyond the tile's pixels would be another task's, so only
// whole vectors are.

HWY_BEFORE_NAMESPACE();
namespace still::upscale {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DU = hn::CappedTag<uint32_t, kRowLanes>;
using DI = hn::RebindToSigned<DU>;
using D16 = hn::Rebind<uint16_t, DU>;
using D8 = hn::Rebind<uint8_t, DU>;
using VU = hn::Vec<DU>;
using VI = hn::Vec<DI>;
using MI = hn::Mask<DI>;

HWY_INLINE VI load16(const uint16_t* p) {
    return hn::PromoteTo(DI(), hn::LoadU(D16(), p));
}
HWY_INLINE void store16(VI v, uint16_t* p) {
    hn::StoreU(hn::DemoteTo(D16(), v), D16(), p);
}
HWY_INLINE VI set(int v) {
    return hn::Set(DI(), v);
}

/// (a · b) >> 32
HWY_INLINE VU mulHigh(VU a, VU b) {
    const DU d;
    const auto even = hn::MulEven(a, b);
    const auto odd = hn::MulEven(
        hn::BitCast(d, hn::ShiftRight<32>(hn::BitCast(hn::RepartitionToWide<DU>(), a))),
        hn::BitCast(d, hn::ShiftRight<32>(hn::BitCast(hn::RepartitionToWide<DU>(), b))));
    return hn::OddEven(hn::BitCast(d, odd), hn::BitCast(d, hn::ShiftRight<32>(even)));
}

HWY_ATTR int sumRow(SumRow& row) {
    const DI d;
    const int lanes = int(hn::Lanes(d));
    MI changed = hn::FirstN(d, 0);
    int x = 0;
    for (; x + lanes <= row.width; x += lanes) {
        const VI frames = load16(row.frames + x), count = load16(row.count + x);
        const VI pixel = hn::LoadU(d, row.pixel + x);
        const MI open = hn::Lt(frames, set(row.sample_cap));
        const MI takes = hn::And(open, hn::Gt(pixel, set(-1)));
        const VI grown = hn::Add(count, hn::IfThenElseZero(takes, set(1)));
        if (!hn::AllFalse(d, hn::And(takes, hn::Gt(grown, set(255))))) {
            break;
        }
        if (hn::AllFalse(d, takes)) {
            continue;
        }
        changed = hn::Or(changed, takes);
        const int first = row.next[x];
        const auto places = hn::IndicesFromVec(d, hn::Max(hn::Sub(pixel, set(first)), set(0)));
        const MI begun = hn::Gt(count, set(0));
        const MI shows = hn::AndNot(hn::Lt(grown, set(row.settled)), takes);
        const bool any_shows = !hn::AllFalse(d, shows);
        const VU reciprocal =
            hn::GatherIndex(DU(), kRowReciprocals.data(), hn::Min(grown, set(255)));
        const VI half = hn::ShiftRight<1>(grown);
        for (int c = 0; c < 3; ++c) {
            const VI sample = hn::TableLookupLanes(load16(row.samples[c] + first), places);
            int32_t* sums = reinterpret_cast<int32_t*>(row.colour[c] + x);
            const VI past = hn::LoadU(d, sums);
            const VI sum = hn::Add(hn::IfThenElseZero(begun, past), sample);
            hn::StoreU(hn::IfThenElse(takes, sum, past), d, sums);
            if (any_shows) {
                const VU mean = mulHigh(hn::BitCast(DU(), hn::Add(sum, half)), reciprocal);
                store16(hn::IfThenElse(shows, hn::BitCast(d, mean), load16(row.shown[c] + x)),
                        row.shown[c] + x);
            }
        }
        store16(grown, row.count + x);
        if (any_shows) {
            const VI before = hn::PromoteTo(d, hn::LoadU(D8(), row.shown_count + x));
            hn::StoreU(hn::DemoteTo(D8(), hn::IfThenElse(shows, grown, before)), D8(),
                       row.shown_count + x);
        }
    }
    row.changed = !hn::AllFalse(d, changed);
    return x;
}

HWY_ATTR int ageRow(AgeRow& row) {
    const hn::CappedTag<int16_t, 16> d;
    const int lanes = int(hn::Lanes(d));
    const auto cap = hn::Set(d, int16_t(row.sample_cap)), one = hn::Set(d, 1);
    auto least_frames = hn::Set(d, 32767), least_count = least_frames;
    int x = 0;
    for (; x + lanes <= row.width; x += lanes) {
        int16_t* at = reinterpret_cast<int16_t*>(row.frames + x);
        const auto before = hn::LoadU(d, at);
        const auto frames = hn::Add(before, hn::IfThenElseZero(hn::Lt(before, cap), one));
        hn::StoreU(frames, d, at);
        least_frames = hn::Min(least_frames, frames);
        least_count =
            hn::Min(least_count, hn::LoadU(d, reinterpret_cast<const int16_t*>(row.count + x)));
    }
    alignas(32) int16_t all[2][16];
    hn::Store(least_frames, d, all[0]);
    hn::Store(least_count, d, all[1]);
    for (int i = 0; i < lanes; ++i) {
        row.least_frames = std::min<int>(row.least_frames, all[0][i]);
        row.least_count = std::min<int>(row.least_count, all[1][i]);
    }
    return x;
}

}  // namespace HWY_NAMESPACE
}  // namespace still::upscale
HWY_AFTER_NAMESPACE();
