// Samples of a slot for a group of pixels: the 2×2 around each place, loaded in as few pieces as
// they lie in. Included once per target by taa_simd.cpp.

HWY_BEFORE_NAMESPACE();
namespace still::taa {
namespace HWY_NAMESPACE {

/// Words of the four samples around the pixels' places: left and right of the upper row, then of
/// the lower one.
struct Four {
    V32 of[4];
};

/// Where the four samples are. Lanes whose samples lie next to each other as the pixels do form a
/// cluster, which is loaded at once.
struct Site {
    VI32 ix, iy;    ///< of the upper left sample
    V32 fx, fy;     ///< 0 … 255
    V32 weight[4];  ///< 0 outside the picture
    V32 wanted;     ///< sum of the weights
    VI32 ex, ey;    ///< place of the upper left sample, 1/64 pixel
};

/// More clusters than this are gathered.
constexpr int kMaxClusters = 5;

/// Calls load(offset, lanes) for clusters of lanes: sample `index` of lane i is at offset + i. What
/// is left goes to gather(lanes).
template <class Load, class Gather>
HWY_INLINE void forClusters(VI32 index, Mask32 lanes, Load&& load, Gather&& gather) {
    const D32 d;
    const DI32 di;
    const VI32 offset = hn::Sub(index, hn::Iota(di, 0));
    const int32_t first = hn::GetLane(offset);
    if (hn::AllTrue(di, hn::Eq(offset, hn::Set(di, first)))) {
        load(first, lanes);
        return;
    }
    alignas(64) int32_t offsets[kMaxLanes];
    hn::StoreU(offset, di, offsets);
    Mask32 left = lanes;
    for (int cluster = 0; cluster < kMaxClusters; ++cluster) {
        const intptr_t lane = hn::FindFirstTrue(d, left);
        if (lane < 0) {
            return;
        }
        const Mask32 same = hn::And(left, maskOf(hn::Eq(offset, hn::Set(di, offsets[lane]))));
        load(offsets[lane], same);
        left = hn::AndNot(same, left);
    }
    if (!hn::AllFalse(d, left)) {
        gather(left);
    }
}

/// Rows above and below the picture are not memory, so the samples of a site are addressed by rows
/// inside; those outside weigh nothing.
struct Address {
    VI32 upper, lower;  ///< index of the left sample
    Mask32 lanes;       ///< lanes with any weight
};

HWY_INLINE Address addressOf(const Job& job, const Site& site) {
    const DI32 di;
    const VI32 zero = hn::Zero(di);
    const VI32 last = hn::Set(di, job.height - 1);
    const VI32 stride = hn::Set(di, int32_t(job.stride));
    const VI32 y0 = hn::Min(hn::Max(site.iy, zero), last);
    const VI32 y1 = hn::Min(hn::Max(hn::Add(site.iy, hn::Set(di, 1)), zero), last);
    const Mask32 lanes = hn::Ne(site.wanted, hn::Zero(D32()));
    // Lanes without weight follow the first one of the row, whatever they would have read.
    const VI32 x = hn::Min(hn::Max(site.ix, hn::Set(di, -1)), hn::Set(di, job.width - 1));
    return {hn::Add(hn::Mul(y0, stride), x), hn::Add(hn::Mul(y1, stride), x), lanes};
}

HWY_INLINE void fetchRow(const uint32_t* plane, VI32 index, Mask32 lanes, V32& left, V32& right) {
    const D32 d;
    forClusters(
        index, lanes,
        [&](int32_t offset, Mask32 same) {
            left = hn::IfThenElse(same, hn::LoadU(d, plane + offset), left);
            right = hn::IfThenElse(same, hn::LoadU(d, plane + offset + 1), right);
        },
        [&](Mask32 rest) {
            left = hn::IfThenElse(rest, hn::GatherIndex(d, plane, index), left);
            right = hn::IfThenElse(rest, hn::GatherIndex(d, plane + 1, index), right);
        });
}

/// Three planes at once: the clusters are the same.
struct Samples {
    Four red_green, blue_id, depths;
};

HWY_INLINE Four loadFour(const uint32_t* plane, ptrdiff_t upper, ptrdiff_t lower) {
    const D32 d;
    return {{hn::LoadU(d, plane + upper), hn::LoadU(d, plane + upper + 1),
             hn::LoadU(d, plane + lower), hn::LoadU(d, plane + lower + 1)}};
}

HWY_INLINE void takeFour(Mask32 lanes, const uint32_t* plane, ptrdiff_t upper, ptrdiff_t lower,
                         Four& four) {
    const D32 d;
    four.of[0] = choose(lanes, hn::LoadU(d, plane + upper), four.of[0]);
    four.of[1] = choose(lanes, hn::LoadU(d, plane + upper + 1), four.of[1]);
    four.of[2] = choose(lanes, hn::LoadU(d, plane + lower), four.of[2]);
    four.of[3] = choose(lanes, hn::LoadU(d, plane + lower + 1), four.of[3]);
}

HWY_INLINE Samples fetchSamples(const SlotIn& slot, const Address& address) {
    const D32 d;
    const DI32 di;
    const VI32 lane = hn::Iota(di, 0);
    const VI32 upper = hn::Sub(address.upper, lane), lower = hn::Sub(address.lower, lane);
    const ptrdiff_t upper0 = hn::GetLane(upper), lower0 = hn::GetLane(lower);
    Samples s{loadFour(slot.red_green, upper0, lower0), loadFour(slot.blue_id, upper0, lower0),
              loadFour(slot.depths, upper0, lower0)};
    const auto differ = [&](ptrdiff_t u, ptrdiff_t l) {
        const VI32 other = hn::Or(hn::Xor(upper, hn::Set(di, int32_t(u))),
                                  hn::Xor(lower, hn::Set(di, int32_t(l))));
        return hn::Not(maskOf(hn::Eq(other, hn::Zero(di))));
    };
    Mask32 left = hn::And(address.lanes, differ(upper0, lower0));
    if (hn::AllFalse(d, left)) {
        return s;
    }
    alignas(64) int32_t uppers[kMaxLanes], lowers[kMaxLanes];
    hn::Store(upper, di, uppers);
    hn::Store(lower, di, lowers);
    while (!hn::AllFalse(d, left)) {
        const intptr_t first = hn::FindFirstTrue(d, left);
        const ptrdiff_t u = uppers[first], l = lowers[first];
        const Mask32 others = hn::And(left, differ(u, l));
        const Mask32 same = hn::AndNot(others, left);
        takeFour(same, slot.red_green, u, l, s.red_green);
        takeFour(same, slot.blue_id, u, l, s.blue_id);
        takeFour(same, slot.depths, u, l, s.depths);
        left = others;
    }
    return s;
}

HWY_INLINE Four fetchFour(const uint32_t* plane, const Address& address) {
    const V32 zero = hn::Zero(D32());
    Four four{{zero, zero, zero, zero}};
    fetchRow(plane, address.upper, address.lanes, four.of[0], four.of[1]);
    fetchRow(plane, address.lower, address.lanes, four.of[2], four.of[3]);
    return four;
}

}  // namespace HWY_NAMESPACE
}  // namespace still::taa
HWY_AFTER_NAMESPACE();
