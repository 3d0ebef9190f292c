// Windows of a row of pixels in lanes; lab_window.cpp is the truth. Each row of samples is brought
// into working colour and into the space of rectification once, and serves three rows of pixels.

HWY_BEFORE_NAMESPACE();
namespace still::lab {
namespace HWY_NAMESPACE {

/// The columns x0 − kMaxLanes … x0 + kTileSize + kMaxLanes − 1 of a tile.
constexpr int kStripWidth = kTileSize + 2 * kMaxLanes;

struct ColourStrip {
    alignas(64) int32_t rgb[3][kStripWidth];
    alignas(64) int32_t space[3][kStripWidth];
    alignas(64) int32_t square[3][kStripWidth];  ///< of `space`
};

/// Whether rectification looks at other numbers than the sample filter.
HWY_INLINE bool hasOwnSpace(const TaaPolicy& p) {
    return p.rectification != Rectification::off &&
           (p.space == ColourSpace::ycocg || usesStatistics(p));
}

HWY_INLINE void repeatBorder(int32_t* row, bool left, bool right, int columns) {
    row[kMaxLanes - 1] = left ? row[kMaxLanes] : row[kMaxLanes - 1];
    row[kMaxLanes + columns] = right ? row[kMaxLanes + columns - 1] : row[kMaxLanes + columns];
}

template <class Source>
STILL_LAB_PHASE void fillSpace(const ResolveJob& job, const Colours& colour, ColourStrip& strip,
                               int i) {
    const TaaPolicy& p = Source::of(job);
    Colours held = colour;
    if (usesStatistics(p)) {
        for (VI32& v : held.v) {
            v = hn::Min(v, all(kStatisticsMax));
        }
    }
    held = toSpace(p, held);
    for (int c = 0; c < 3; ++c) {
        store(held.v[c], strip.space[c] + i);
        if (usesStatistics(p)) {
            store(hn::Mul(held.v[c], held.v[c]), strip.square[c] + i);
        }
    }
}

/// Row y, or the picture's last one beyond its border.
template <class Source>
STILL_LAB_PHASE void fillColours(const ResolveJob& job, const TileRect& tile, int y,
                                 ColourStrip& strip) {
    const TaaPolicy& p = Source::of(job);
    const int lanes = int(hn::Lanes(D32())), columns = tile.x1 - tile.x0;
    const ptrdiff_t row = std::clamp(y, 0, job.height - 1) * job.stride + tile.x0 - kMaxLanes;
    for (int i = kMaxLanes - lanes; i < kMaxLanes + columns + 1; i += lanes) {
        Colours colour;
        for (int c = 0; c < 3; ++c) {
            colour.v[c] = load(job.now.colour[c] + row + i);
        }
        colour = p.tone == Tone::reinhard ? toneIn(colour) : colour;
        for (int c = 0; c < 3; ++c) {
            store(colour.v[c], strip.rgb[c] + i);
        }
        if (hasOwnSpace(p)) {
            fillSpace<Source>(job, colour, strip, i);
        }
    }
    const bool left = tile.x0 == 0, right = tile.x1 == job.width;
    for (int c = 0; c < 3 && (left || right); ++c) {
        for (int32_t* line : {strip.rgb[c], strip.space[c], strip.square[c]}) {
            repeatBorder(line, left, right, columns);
        }
    }
}

/// Three rows of samples around a row of pixels.
struct Rows {
    const ColourStrip* strip[3];
};

template <class Source>
STILL_LAB_PHASE Colours filteredSample_w24(const ResolveJob& job, const Rows& rows, int i) {
    Colours result;
    for (int c = 0; c < 3; ++c) {
        if (Source::of(job).sample == SampleFilter::box) {
            result.v[c] = hn::ShiftLeft<kFractionBits>(load(rows.strip[1]->rgb[c] + i));
            continue;
        }
        VI32 sum = zero();
        for (int k = 0; k < 9; ++k) {
            const VI32 weight = all(job.constants.sample_weight_q12[k]);
            sum = hn::Add(sum, hn::Mul(weight, load(rows.strip[k / 3]->rgb[c] + i + k % 3 - 1)));
        }
        result.v[c] = clamped(roundShift<12 - kFractionBits>(sum), zero(), all(kWorkingMax_w24));
    }
    return result;
}

struct Range {
    VI32 low, high;
};
HWY_INLINE Range spanning(Range a, Range b) {
    return {hn::Min(a.low, b.low), hn::Max(a.high, b.high)};
}
HWY_INLINE Range pointAt(const int32_t* p) {
    const VI32 v = load(p);
    return {v, v};
}

/// Smallest and largest of a channel; with `round_corners`, the mean of those of the 3×3 and of the
/// plus-shaped window.
HWY_INLINE Range extent(const int32_t* top, const int32_t* middle, const int32_t* bottom,
                        bool round_corners) {
    Range plus = pointAt(middle);
    for (const int32_t* p : {top, bottom, middle - 1, middle + 1}) {
        plus = spanning(plus, pointAt(p));
    }
    Range square = plus;
    for (const int32_t* p : {top - 1, top + 1, bottom - 1, bottom + 1}) {
        square = spanning(square, pointAt(p));
    }
    if (!round_corners) {
        return square;
    }
    return {hn::ShiftRight<1>(hn::Add(square.low, plus.low)),
            roundShift<1>(hn::Add(square.high, plus.high))};
}

struct Boxes {
    VI32 low[3], high[3], middle[3], half[3];
};

template <class Source>
STILL_LAB_PHASE Boxes extentBox(const ResolveJob& job, const Rows& rows, int i) {
    const TaaPolicy& p = Source::of(job);
    const bool round_corners = p.rectification == Rectification::rounded_clip;
    Boxes box;
    for (int c = 0; c < 3; ++c) {
        const bool own = hasOwnSpace(p);
        const int32_t* at[3];
        for (int k = 0; k < 3; ++k) {
            at[k] = (own ? rows.strip[k]->space[c] : rows.strip[k]->rgb[c]) + i;
        }
        const Range range = extent(at[0], at[1], at[2], round_corners);
        box.low[c] = range.low;
        box.high[c] = range.high;
        box.middle[c] = roundShift<1>(hn::Add(range.low, range.high));
        box.half[c] = roundShift<1>(hn::Sub(range.high, range.low));
    }
    return box;
}

template <class Source>
HWY_INLINE VI32 sigmaAt(const ResolveJob& job, VI32 speed_fx8) {
    const FrameConstants& k = job.constants;
    if (Source::of(job).sigma_still_fx8 == 0) {
        return all(int32_t(k.sigma_q12));
    }
    const VI32 slow = hn::Min(speed_fx8, all(k.speed_limit_fx8));
    const VI32 rest =
        hn::Sub(all(256), shiftUnsigned<16>(hn::Mul(slow, all(int32_t(k.inverse_speed)))));
    const VI32 wider = all(int32_t(k.sigma_still_q12) - int32_t(k.sigma_q12));
    const VI32 square = hn::ShiftRight<8>(hn::Mul(rest, rest));
    return hn::Add(all(int32_t(k.sigma_q12)), hn::ShiftRight<8>(hn::Mul(wider, square)));
}

HWY_INLINE VI32 sumOfNine(const int32_t* top, const int32_t* middle, const int32_t* bottom) {
    VI32 sum = zero();
    for (const int32_t* row : {top, middle, bottom}) {
        sum = hn::Add(sum, hn::Add(hn::Add(load(row - 1), load(row)), load(row + 1)));
    }
    return sum;
}

template <class Source>
STILL_LAB_PHASE Boxes statisticsBox(const ResolveJob& job, const Rows& rows, int i,
                                    VI32 speed_fx8) {
    const VI32 sigma = sigmaAt<Source>(job, speed_fx8);
    Boxes box;
    for (int c = 0; c < 3; ++c) {
        const auto& [top, mid, low] = rows.strip;
        const VI32 sum = sumOfNine(top->space[c] + i, mid->space[c] + i, low->space[c] + i);
        const VI32 squares = sumOfNine(top->square[c] + i, mid->square[c] + i, low->square[c] + i);
        const VI32 centre = load(mid->space[c] + i);
        const VI32 nine = all(9);
        const VI32 away = hn::Mul(hn::Sub(sum, hn::Mul(centre, nine)), all(3641));
        const VI32 mean = hn::Add(centre, roundShift<15>(away));
        const VI32 twice = hn::Sub(hn::Add(sum, sum), hn::Mul(mean, nine));
        const VI32 deviation = hn::Sub(squares, hn::Mul(mean, twice));
        const VI32 width = hn::Add(hn::Mul(rootOf(deviation), sigma), all(16384));
        box.middle[c] = mean;
        box.half[c] = hn::Min(shiftUnsigned<15>(width), all(65535));
        box.low[c] = hn::Sub(mean, box.half[c]);
        box.high[c] = hn::Add(mean, box.half[c]);
    }
    return box;
}

HWY_INLINE MaskI clampTo(const Boxes& box, Colours& colour) {
    MaskI changed = noLanes();
    for (int c = 0; c < 3; ++c) {
        const VI32 old = colour.v[c];
        colour.v[c] = clamped(old, box.low[c], box.high[c]);
        changed = hn::Or(changed, hn::Ne(colour.v[c], old));
    }
    return changed;
}

STILL_LAB_PHASE MaskI clipTo(const Boxes& box, Colours& colour) {
    VI32 half = all(1), distance = all(1);
    for (int c = 0; c < 3; ++c) {
        const VI32 away = hn::Min(hn::Abs(hn::Sub(colour.v[c], box.middle[c])), all(kWorkingMax));
        const V32 mine = asUnsigned(hn::Mul(box.half[c], distance));
        const MaskI farther = hn::RebindMask(DI32(), hn::Lt(mine, asUnsigned(hn::Mul(half, away))));
        half = choose(farther, box.half[c], half);
        distance = choose(farther, away, distance);
    }
    const MaskI outside = hn::Lt(half, distance);
    if (any(outside)) {
        const VI32 share = quotient<12>(half, distance);
        for (int c = 0; c < 3; ++c) {
            const VI32 d = hn::Sub(colour.v[c], box.middle[c]);
            const VI32 moved = hn::Add(box.middle[c], roundShift<12>(hn::Mul(d, share)));
            colour.v[c] = choose(outside, moved, colour.v[c]);
        }
    }
    return outside;
}

/// Rectifies in place; returns the changed lanes.
template <class Source>
STILL_LAB_PHASE MaskI rectify(const ResolveJob& job, const Rows& rows, int i, VI32 speed_fx8,
                              Colours& history) {
    const TaaPolicy& p = Source::of(job);
    if (p.rectification == Rectification::off) {
        return noLanes();
    }
    const Boxes box = usesStatistics(p) ? statisticsBox<Source>(job, rows, i, speed_fx8)
                                        : extentBox<Source>(job, rows, i);
    Colours colour = toSpace(p, history);
    const MaskI changed = clips(p) ? clipTo(box, colour) : clampTo(box, colour);
    if (any(changed)) {
        const Colours held = fromSpace(p, colour);
        for (int c = 0; c < 3; ++c) {
            history.v[c] = choose(changed, held.v[c], history.v[c]);
        }
    }
    return changed;
}

}  // namespace HWY_NAMESPACE
}  // namespace still::lab
HWY_AFTER_NAMESPACE();
