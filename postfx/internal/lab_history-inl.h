// Guides and history of a row of pixels in lanes; lab_history.cpp is the truth. Lanes whose history
// lies side by side, as their pixels do, are loaded with whole vectors; others lane by lane.

HWY_BEFORE_NAMESPACE();
namespace still::lab {
namespace HWY_NAMESPACE {

struct Guides {
    VI32 key, motion, depth, expected, surface, normal;
};

struct GuideStrip {
    alignas(64) int32_t key[kStripWidth];
    alignas(64) int32_t motion[kStripWidth];
    alignas(64) int32_t depth[kStripWidth];
    alignas(64) int32_t expected[kStripWidth];
    alignas(64) int32_t surface[kStripWidth];
    alignas(64) int32_t normal[kStripWidth];
};

HWY_INLINE VI32 guideKey(const TaaPolicy& p, const Current& now, ptrdiff_t at, VI32 motion) {
    if (p.dilation == Dilation::nearest_depth) {
        return load(now.depth + at);
    }
    const VI32 x = motionX(motion), y = motionY(motion);
    const VI32 square = shiftUnsigned<1>(hn::Add(hn::Mul(x, x), hn::Mul(y, y)));
    return choose(hn::Eq(x, all(kNoHistory)), all(-1), square);
}

HWY_INLINE Guides guidesAt(const TaaPolicy& p, const Current& now, ptrdiff_t at) {
    Guides g{zero(), load(now.motion + at), zero(), zero(), zero(), zero()};
    if (p.dilation != Dilation::centre) {
        g.key = guideKey(p, now, at, g.motion);
    }
    if (needsDepth(p)) {
        g.depth = load(now.depth + at);
        g.expected = load(now.depth_before + at);
    }
    if (p.id_reject) {
        g.surface = load(now.id + at);
    }
    if (needsNormal(p)) {
        g.normal = load(now.normal + at);
    }
    return g;
}

HWY_INLINE void takeLarger(const TaaPolicy& p, Guides& best, const Guides& other) {
    const MaskI larger = hn::Gt(other.key, best.key);
    best.key = choose(larger, other.key, best.key);
    best.motion = choose(larger, other.motion, best.motion);
    if (needsDepth(p)) {
        best.depth = choose(larger, other.depth, best.depth);
        best.expected = choose(larger, other.expected, best.expected);
    }
    if (p.id_reject) {
        best.surface = choose(larger, other.surface, best.surface);
    }
    if (needsNormal(p)) {
        best.normal = choose(larger, other.normal, best.normal);
    }
}

HWY_INLINE void storeStrip(const TaaPolicy& p, const Guides& g, GuideStrip& strip, int i) {
    store(g.key, strip.key + i);
    store(g.motion, strip.motion + i);
    if (needsDepth(p)) {
        store(g.depth, strip.depth + i);
        store(g.expected, strip.expected + i);
    }
    if (p.id_reject) {
        store(g.surface, strip.surface + i);
    }
    if (needsNormal(p)) {
        store(g.normal, strip.normal + i);
    }
}

HWY_INLINE Guides loadStrip(const GuideStrip& strip, int i) {
    return {load(strip.key + i),      load(strip.motion + i),  load(strip.depth + i),
            load(strip.expected + i), load(strip.surface + i), load(strip.normal + i)};
}

/// The best of each column of three. Columns outside the picture never win.
template <class Source>
STILL_LAB_PHASE void fillGuides(const ResolveJob& job, const TileRect& tile, int y,
                                GuideStrip& strip) {
    const TaaPolicy& p = Source::of(job);
    const int lanes = int(hn::Lanes(D32())), columns = tile.x1 - tile.x0;
    for (int i = kMaxLanes - lanes; i < kMaxLanes + columns + 1; i += lanes) {
        const ptrdiff_t at = y * job.stride + tile.x0 - kMaxLanes + i;
        Guides best = guidesAt(p, job.now, at);
        if (y > 0) {
            takeLarger(p, best, guidesAt(p, job.now, at - job.stride));
        }
        if (y + 1 < job.height) {
            takeLarger(p, best, guidesAt(p, job.now, at + job.stride));
        }
        storeStrip(p, best, strip, i);
    }
    if (tile.x0 == 0) {
        strip.key[kMaxLanes - 1] = INT32_MIN;
    }
    if (tile.x1 == job.width) {
        strip.key[kMaxLanes + columns] = INT32_MIN;
    }
}

HWY_INLINE VI32 clampedLogDepth(VI32 bits) {
    constexpr int32_t kTop = int32_t(0x3F800000u >> 12) - 65535;
    return clamped(hn::Sub(shiftUnsigned<12>(bits), all(kTop)), zero(), all(65535));
}

HWY_INLINE VI32 compactNormal(VI32 packed) {
    return hn::Or(hn::And(shiftUnsigned<8>(packed), all(0x00FF)),
                  hn::And(shiftUnsigned<16>(packed), all(0xFF00)));
}

/// Guides of the pixels at x …, in the forms that history keeps.
template <class Source>
STILL_LAB_PHASE Guides findGuide(const ResolveJob& job, const TileRect& tile,
                                 const GuideStrip& strip, int x, int y) {
    const TaaPolicy& p = Source::of(job);
    Guides g;
    if (p.dilation == Dilation::centre) {
        g = guidesAt(p, job.now, y * job.stride + x);
    } else {
        const int i = kMaxLanes + x - tile.x0;
        g = loadStrip(strip, i);
        takeLarger(p, g, loadStrip(strip, i - 1));
        takeLarger(p, g, loadStrip(strip, i + 1));
    }
    g.depth = clampedLogDepth(g.depth);
    g.surface = hn::And(g.surface, all(kSurfaceMask));
    g.normal = compactNormal(g.normal);
    return g;
}

/// Where a vector of pixels finds one tap each: side by side, or anywhere.
template <bool kTogether>
struct Spot;
template <>
struct Spot<true> {
    ptrdiff_t at;
    Spot moved(ptrdiff_t offset) const { return {at + offset}; }
};
template <>
struct Spot<false> {
    alignas(64) int32_t index[kMaxLanes];
    ptrdiff_t offset = 0;
    Spot moved(ptrdiff_t by) const {
        Spot other = *this;
        other.offset += by;
        return other;
    }
};

template <class T>
HWY_INLINE VI32 tapAt(const Spot<true>& spot, const T* plane, ptrdiff_t offset) {
    return load(plane + spot.at + offset);
}
HWY_INLINE VI32 tapAt(const Spot<false>& spot, const uint32_t* plane, ptrdiff_t offset) {
    return lookUp(plane + spot.offset + offset, hn::Load(DI32(), spot.index));
}
/// Planes of narrow elements have no gather.
template <class T>
HWY_INLINE VI32 tapAt(const Spot<false>& spot, const T* plane, ptrdiff_t offset) {
    alignas(64) T picked[kMaxLanes] = {};
    for (int lane = 0; lane < int(hn::Lanes(DI32())); ++lane) {
        picked[lane] = plane[spot.index[lane] + spot.offset + offset];
    }
    return load(picked);
}

/// Places in history of a vector of pixels; all inside the planes, `found` or not.
struct Places {
    MaskI found;
    VI32 column, row;  ///< of the first tap, −1 … width − 1
    VI32 fx, fy;
    VI32 near_column, near_row;  ///< of the nearest pixel
};

template <class Source>
STILL_LAB_PHASE Places findPlaces(const ResolveJob& job, const Guides& guides, int x, int y) {
    const VI32 x0 = hn::ShiftLeft<8>(hn::Iota(DI32(), x));
    const VI32 motion_x = motionX(guides.motion);
    const VI32 px = hn::Add(x0, motion_x), py = hn::Add(all(y * 256), motionY(guides.motion));
    const VI32 low = all(-128);
    const VI32 last_x = all(job.width * 256 - 129), last_y = all(job.height * 256 - 129);
    const VI32 inside_x = clamped(px, low, last_x), inside_y = clamped(py, low, last_y);
    const MaskI found = hn::And(hn::And(hn::Eq(px, inside_x), hn::Eq(py, inside_y)),
                                hn::Ne(motion_x, all(kNoHistory)));
    return {found,
            hn::ShiftRight<8>(inside_x),
            hn::ShiftRight<8>(inside_y),
            hn::And(inside_x, all(255)),
            hn::And(inside_y, all(255)),
            roundShift<8>(inside_x),
            roundShift<8>(inside_y)};
}

HWY_INLINE uint32_t bitsOf(MaskI mask) {
    uint8_t bytes[8] = {};
    hn::StoreMaskBits(DI32(), mask, bytes);
    return uint32_t{bytes[0]} | uint32_t{bytes[1]} << 8;
}

/// Calls task(spot) for the pixels (column, row); `found` is not empty. Lanes that are not found
/// get any value: what lies around the found ones exists.
template <class Task>
HWY_INLINE void atSpot(const ResolveJob& job, MaskI found, VI32 column, VI32 row, Task&& task) {
    const int lane = std::countr_zero(bitsOf(found));
    alignas(64) int32_t columns[kMaxLanes], rows[kMaxLanes];
    hn::Store(hn::Sub(column, hn::Iota(DI32(), 0)), DI32(), columns);
    hn::Store(row, DI32(), rows);
    const MaskI together = hn::And(hn::Eq(hn::Load(DI32(), columns), all(columns[lane])),
                                   hn::Eq(row, all(rows[lane])));
    if (!any(hn::AndNot(together, found))) {
        task(Spot<true>{rows[lane] * job.history_stride + columns[lane]});
        return;
    }
    Spot<false> spot;
    const VI32 index = hn::Add(hn::Mul(row, all(int32_t(job.history_stride))), column);
    hn::Store(index, DI32(), spot.index);
    task(spot);
}

/// How many of the tests of depth, normal and surface fail at one tap.
template <class Source, class S>
STILL_LAB_PHASE VI32 failedTests(const ResolveJob& job, const Guides& guides, const S& spot,
                                 ptrdiff_t offset) {
    const TaaPolicy& p = Source::of(job);
    VI32 failed = zero();
    if (needsDepth(p)) {
        const VI32 depth = tapAt(spot, job.before.depth, offset);
        failed = oneWhere(differentDepths(depth, guides.expected, p.depth_reject_q15));
    }
    if (needsNormal(p)) {
        const VI32 normal = tapAt(spot, job.before.normal, offset);
        if (!hn::AllTrue(DI32(), hn::Eq(normal, guides.normal))) {
            const MaskI other =
                differentNormals(normal, guides.normal, job.constants.normal_square_q15);
            failed = hn::Add(failed, oneWhere(other));
        }
    }
    if (p.id_reject) {
        const VI32 surface = tapAt(spot, job.before.surface, offset);
        failed = hn::Add(failed, oneWhere(hn::Ne(surface, guides.surface)));
    }
    return failed;
}

template <class S>
STILL_LAB_PHASE VI32 bilinear(const uint32_t* plane, ptrdiff_t stride, const S& spot,
                              const Places& places) {
    const VI32 one = all(256), half = all(128);
    VI32 row[2];
    for (int j = 0; j < 2; ++j) {
        const VI32 left = tapAt(spot, plane, j * stride);
        const VI32 right = tapAt(spot, plane, j * stride + 1);
        const VI32 sum = hn::Add(hn::Mul(left, hn::Sub(one, places.fx)), hn::Mul(right, places.fx));
        row[j] = shiftUnsigned<8>(hn::Add(sum, half));
    }
    const VI32 sum = hn::Add(hn::Mul(row[0], hn::Sub(one, places.fy)), hn::Mul(row[1], places.fy));
    return shiftUnsigned<8>(hn::Add(sum, half));
}

template <class S>
STILL_LAB_PHASE VI32 catmullRom(const TaaPolicy& p, const uint32_t* plane, ptrdiff_t stride,
                                const S& spot, const Cubic& wx, const Cubic& wy) {
    const bool corners = p.history == HistoryFilter::catmull_rom16;
    VI32 sum = zero(), low = all(INT32_MAX), high = zero();
    for (int j = 0; j < 4; ++j) {
        VI32 row = zero();
        const bool inner_row = j == 1 || j == 2;
        for (int i = 0; i < 4; ++i) {
            const bool inner_column = i == 1 || i == 2;
            if (!corners && !inner_column && !inner_row) {
                continue;
            }
            const VI32 tap = tapAt(spot, plane, (j - 1) * stride + i - 1);
            row = hn::Add(row, hn::Mul(wx.w[i], roundShift<kTapShift>(tap)));
            if (p.dering && inner_column && inner_row) {
                low = hn::Min(low, tap);
                high = hn::Max(high, tap);
            }
        }
        sum = hn::Add(sum, hn::Mul(wy.w[j], roundShift<kCubicBits>(row)));
    }
    VI32 value = roundShift<kCubicColumnShift>(sum);
    if (!corners) {
        const VI32 gain = hn::Mul(roundShift<kTapShift>(value), cornerGain(wx, wy));
        value = hn::Add(value, roundShift<16 - kTapShift>(gain));
    }
    return p.dering ? clamped(value, low, high) : clamped(value, zero(), all(kWorkingMax_w24));
}

/// Filters that read a fixed set of taps.
template <class Source, class S>
STILL_LAB_PHASE Colours filtered(const ResolveJob& job, const S& spot, const Places& places) {
    const TaaPolicy& p = Source::of(job);
    Colours colour;
    const VI32 fraction = hn::Or(places.fx, places.fy);
    const MaskI whole = hn::Eq(fraction, zero());
    if (p.history == HistoryFilter::nearest || !any(hn::And(places.found, hn::Not(whole)))) {
        for (int c = 0; c < 3; ++c) {
            colour.v[c] = tapAt(spot, job.before.colour_w24[c], 0);
        }
        return colour;
    }
    const ptrdiff_t stride = job.history_stride;
    if (p.history == HistoryFilter::bilinear) {
        for (int c = 0; c < 3; ++c) {
            colour.v[c] = bilinear(job.before.colour_w24[c], stride, spot, places);
        }
        return colour;
    }
    const Cubic wx = cubicWeights(places.fx), wy = cubicWeights(places.fy);
    for (int c = 0; c < 3; ++c) {
        const uint32_t* plane = job.before.colour_w24[c];
        colour.v[c] =
            choose(whole, tapAt(spot, plane, 0), catmullRom(p, plane, stride, spot, wx, wy));
    }
    return colour;
}

struct TapSums {
    VI32 colour[3], weight;
};

template <class Source, class S>
STILL_LAB_PHASE void addTap(const ResolveJob& job, const Guides& guides, const S& spot, VI32 column,
                            VI32 row, int i, int j, VI32 weight, TapSums& sums) {
    const VI32 x = hn::Add(column, all(i)), y = hn::Add(row, all(j));
    const MaskI inside = hn::And(hn::Eq(x, clamped(x, zero(), all(job.width - 1))),
                                 hn::Eq(y, clamped(y, zero(), all(job.height - 1))));
    const ptrdiff_t offset = j * job.history_stride + i;
    const VI32 failed = failedTests<Source>(job, guides, spot, offset);
    const VI32 counts = hn::IfThenElseZero(hn::And(inside, hn::Eq(failed, zero())), weight);
    sums.weight = hn::Add(sums.weight, counts);
    for (int c = 0; c < 3; ++c) {
        const VI32 tap = tapAt(spot, job.before.colour_w24[c], offset);
        sums.colour[c] = hn::Add(sums.colour[c], hn::Mul(counts, tap));
    }
}

template <class Source, class S>
STILL_LAB_PHASE void addFour(const ResolveJob& job, const Guides& guides, const S& spot,
                             const Places& places, TapSums& sums) {
    const VI32 one = all(256);
    for (int k = 0; k < 4; ++k) {
        const int i = k & 1, j = k >> 1;
        const VI32 weight_x = i != 0 ? places.fx : hn::Sub(one, places.fx);
        const VI32 weight_y = j != 0 ? places.fy : hn::Sub(one, places.fy);
        const VI32 weight = hn::ShiftRight<8>(hn::Mul(weight_x, weight_y));
        if (any(hn::Ne(weight, zero()))) {
            addTap<Source>(job, guides, spot, places.column, places.row, i, j, weight, sums);
        }
    }
}

/// HistoryFilter::validated; lanes without any tap are no longer found.
template <class Source>
STILL_LAB_PHASE Colours validated(const ResolveJob& job, const Guides& guides, Places& places) {
    TapSums sums{{zero(), zero(), zero()}, zero()};
    atSpot(job, places.found, places.column, places.row,
           [&](const auto& spot) HWY_ATTR { addFour<Source>(job, guides, spot, places, sums); });
    const MaskI widen = hn::And(places.found, hn::Eq(sums.weight, zero()));
    if (any(widen)) {
        const VI32 weight = oneWhere(widen);
        atSpot(job, widen, places.near_column, places.near_row, [&](const auto& spot) HWY_ATTR {
            for (int k = 0; k < 9; ++k) {
                addTap<Source>(job, guides, spot, places.near_column, places.near_row, k % 3 - 1,
                               k / 3 - 1, weight, sums);
            }
        });
    }
    places.found = hn::And(places.found, hn::Gt(sums.weight, zero()));
    const VI32 reciprocal = lookUpAlike(kReciprocals.of, sums.weight);
    return {{highProduct(sums.colour[0], reciprocal), highProduct(sums.colour[1], reciprocal),
             highProduct(sums.colour[2], reciprocal)}};
}

/// History of a vector of pixels.
struct Pasts {
    MaskI found;
    Colours colour_w24;
    VI32 memory, failed;
};

/// What is read at the pixel nearest to the place.
template <class Source, class S>
STILL_LAB_PHASE void readNearest(const ResolveJob& job, const Guides& guides, const S& spot,
                                 Pasts& past) {
    const TaaPolicy& p = Source::of(job);
    if (p.history != HistoryFilter::validated) {
        past.failed = failedTests<Source>(job, guides, spot, 0);
    }
    if (needsMotion(p)) {
        const VI32 old = tapAt(spot, job.before.motion, 0);
        const MaskI other =
            differentMotions(hn::Sub(motionX(guides.motion), motionX(old)),
                             hn::Sub(motionY(guides.motion), motionY(old)), p.velocity_reject_fx8);
        past.failed = hn::Add(past.failed, oneWhere(other));
    }
    if (needsMemory(p)) {
        past.memory = tapAt(spot, job.before.memory, 0);
    }
    if (p.history == HistoryFilter::nearest) {
        for (int c = 0; c < 3; ++c) {
            past.colour_w24.v[c] = tapAt(spot, job.before.colour_w24[c], 0);
        }
    }
}

template <class Source>
STILL_LAB_PHASE Pasts findPast(const ResolveJob& job, const Guides& guides, MaskI pixels, int x,
                               int y) {
    const TaaPolicy& p = Source::of(job);
    Pasts past{noLanes(), {{zero(), zero(), zero()}}, zero(), zero()};
    Places places = findPlaces<Source>(job, guides, x, y);
    places.found = hn::And(places.found, pixels);
    if (!job.has_history || !any(places.found)) {
        return past;
    }
    const MaskI near_picture = places.found;
    if (p.history == HistoryFilter::validated) {
        past.colour_w24 = validated<Source>(job, guides, places);
    } else if (p.history != HistoryFilter::nearest) {
        atSpot(job, places.found, places.column, places.row, [&](const auto& spot) HWY_ATTR {
            past.colour_w24 = filtered<Source>(job, spot, places);
        });
    }
    const bool tested = needsDepth(p) || needsNormal(p) || p.id_reject;
    if (needsMotion(p) || needsMemory(p) || p.history == HistoryFilter::nearest ||
        (tested && p.history != HistoryFilter::validated)) {
        atSpot(job, near_picture, places.near_column, places.near_row,
               [&](const auto& spot) HWY_ATTR { readNearest<Source>(job, guides, spot, past); });
    }
    past.found = places.found;
    return past;
}

}  // namespace HWY_NAMESPACE
}  // namespace still::lab
HWY_AFTER_NAMESPACE();
