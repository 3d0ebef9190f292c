// The plane through the kept samples, at the pixels' centres: fit() in lanes. Frames whose four
// samples all count are the usual case: their moments follow from the two axes' weights, in 16
// bits. Included once per target by taa_simd.cpp.

HWY_BEFORE_NAMESPACE();
namespace still::taa {
namespace HWY_NAMESPACE {

/// Moments of whole frames, / kFrameWeight; yet another kFrameWeight is in w alone.
struct WholeMoments {
    VS w, x, y, xx, xy, yy;
};
struct PartMoments {
    VS w;
    Wide x, y, xx, xy, yy;
};

/// The accepted samples of the group's pixels.
struct Kept {
    struct Frame {
        int slot;
        VS weight[4], behind[4];  ///< behind: all ones where a sample shows what is behind
        VS cx, cy;
        Clusters clusters;
    };
    Frame frame[kMaxRing];
    int frames = 0;
    WholeMoments whole;
    PartMoments part;
    bool any_part = false;
    VS first_weight;  ///< of this frame's samples

    HWY_INLINE void clear() {
        frames = 0;
        whole = {zero(), zero(), zero(), zero(), zero(), zero()};
        part.w = zero();
        for (Wide* wide : {&part.x, &part.y, &part.xx, &part.xy, &part.yy}) {
            wide->clear();
        }
        first_weight = zero();
    }
    HWY_INLINE VS weight() const { return hn::Add(part.w, hn::ShiftLeft<8>(whole.w)); }
};

/// With c = 64 · f and r the right sample's share of kAxisWeight, an axis has Σ w e / kAxisWeight =
/// 4 r − c and Σ w e² / kAxisWeight = c² + 8 r (32 − c).
HWY_INLINE void addWhole(const Site& site, WholeMoments& m) {
    const auto mean = [](VS share, VS c) { return hn::Sub(hn::ShiftLeft<2>(share), c); };
    const auto square = [](VS share, VS c) {
        return hn::Add(hn::Mul(c, c), hn::Mul(hn::ShiftLeft<3>(share), hn::Sub(set(32), c)));
    };
    const auto lanes = [&](VS v) { return hn::IfThenElseZero(site.lanes, v); };
    const VS x = lanes(mean(site.right, site.cx)), y = lanes(mean(site.lower, site.cy));
    m.w = hn::Add(m.w, lanes(set(1)));
    m.x = hn::Add(m.x, x);
    m.y = hn::Add(m.y, y);
    m.xx = hn::Add(m.xx, lanes(square(site.right, site.cx)));
    m.yy = hn::Add(m.yy, lanes(square(site.lower, site.cy)));
    m.xy = hn::Add(m.xy, hn::Mul(x, y));
}

/// Moments::add() of four samples, whose places are −c and 64 − c in each axis.
HWY_NOINLINE void addPart(const Site& site, const VS weight[4], PartMoments& m) {
    const VS right = hn::Add(weight[1], weight[3]), lower = hn::Add(weight[2], weight[3]);
    const VS all = hn::Add(hn::Add(weight[0], weight[2]), right);
    const VS side = set(64), middle = set(32);
    const VS cx = site.cx, cy = site.cy;
    const auto cross = [&](VS c) { return hn::ShiftLeft<7>(hn::Sub(middle, c)); };
    m.w = hn::Add(m.w, all);
    m.x.add(all, right, hn::Neg(cx), side);
    m.y.add(all, lower, hn::Neg(cy), side);
    m.xx.add(all, right, hn::Mul(cx, cx), cross(cx));
    m.yy.add(all, lower, hn::Mul(cy, cy), cross(cy));
    m.xy.add(all, right, hn::Mul(cx, cy), hn::Neg(hn::ShiftLeft<6>(cy)));
    m.xy.add(lower, weight[3], hn::Neg(hn::ShiftLeft<6>(cx)), set(4096));
}

/// Moments as tiltOf() wants them.
struct MomentWords {
    VW w, x, y, xx, xy, yy;
};

/// tiltOf()
HWY_NOINLINE void tiltOf(const MomentWords& m, VW& tilt_x, VW& tilt_y) {
    const DW d;
    const VW ridge = hn::Add(hn::ShiftRight<8>(hn::Mul(m.w, hn::Set(d, kRidge))), hn::Set(d, 16));
    const VW a = hn::Add(hn::ShiftRight<8>(m.xx), ridge);
    const VW b = hn::ShiftRight<8>(m.xy);
    const VW c = hn::Add(hn::ShiftRight<8>(m.yy), ridge);
    const VW x = hn::ShiftRight<4>(m.x), y = hn::ShiftRight<4>(m.y);
    VW det = hn::Sub(hn::Mul(a, c), hn::Mul(b, b));
    VW nx = hn::Sub(hn::Mul(c, x), hn::Mul(b, y));
    VW ny = hn::Sub(hn::Mul(a, y), hn::Mul(b, x));
    const auto normalise = [&](auto shift_tag) {
        constexpr int kShift = decltype(shift_tag)::value;
        const auto small = hn::Lt(det, hn::Set(d, 256 << kShift));
        det = hn::IfThenElse(small, det, hn::ShiftRight<kShift>(det));
        nx = hn::IfThenElse(small, nx, hn::ShiftRight<kShift>(nx));
        ny = hn::IfThenElse(small, ny, hn::ShiftRight<kShift>(ny));
    };
    normalise(std::integral_constant<int, 16>());
    normalise(std::integral_constant<int, 8>());
    normalise(std::integral_constant<int, 4>());
    normalise(std::integral_constant<int, 2>());
    normalise(std::integral_constant<int, 1>());
    const VW reciprocal =
        hn::GatherIndex(d, kSmallReciprocals.data(), hn::Sub(det, hn::Set(d, 256)));
    const auto quotient = [&](VW n) {
        const VW small = hn::Min(hn::Max(n, hn::Set(d, -16384)), hn::Set(d, 16383));
        return hn::ShiftRight<6>(hn::Mul(small, reciprocal));
    };
    tilt_x = quotient(nx);
    tilt_y = quotient(ny);
}

HWY_INLINE void tiltLanes(Kept& kept, VS& tilt_x, VS& tilt_y) {
    const DS d;
    // Whole frames join the others: · kFrameWeight.
    const VS none = zero(), unit = set(kFrameWeight);
    PartMoments& p = kept.part;
    p.x.add(kept.whole.x, none, unit, none);
    p.y.add(kept.whole.y, none, unit, none);
    p.xx.add(kept.whole.xx, none, unit, none);
    p.xy.add(kept.whole.xy, none, unit, none);
    p.yy.add(kept.whole.yy, none, unit, none);
    const DW dw;
    const VS w = kept.weight();
    VW x0, y0, x1, y1;
    tiltOf({hn::BitCast(dw, hn::InterleaveLower(d, w, none)), p.x.lower, p.y.lower, p.xx.lower,
            p.xy.lower, p.yy.lower},
           x0, y0);
    tiltOf({hn::BitCast(dw, hn::InterleaveUpper(d, w, none)), p.x.upper, p.y.upper, p.xx.upper,
            p.xy.upper, p.yy.upper},
           x1, y1);
    tilt_x = narrow(x0, x1);
    tilt_y = narrow(y0, y1);
    for (int i = 0; i < 6; ++i) {
        // |x| + |y| stays below 2^15: each is at most 2^14.
        const MS steep = hn::Gt(hn::Add(hn::Abs(tilt_x), hn::Abs(tilt_y)), set(kMaxTilt));
        if (!any(steep)) {
            return;
        }
        tilt_x = hn::IfThenElse(steep, hn::ShiftRight<1>(tilt_x), tilt_x);
        tilt_y = hn::IfThenElse(steep, hn::ShiftRight<1>(tilt_y), tilt_y);
    }
}

struct Colour {
    VU of[3];
};

/// Σ weight · (colour − kOffset), of even and of odd pixels.
struct ColourSums {
    VW even[3], odd[3];

    HWY_INLINE void add(const SlotIn& slot, ptrdiff_t upper, ptrdiff_t lower, VS w0, VS w1, VS w2,
                        VS w3) {
        const VS even0 = evenPairs(w0, w1), odd0 = oddPairs(w0, w1);
        const VS even1 = evenPairs(w2, w3), odd1 = oddPairs(w2, w3);
        for (int c = 0; c < 3; ++c) {
            const int16_t* plane = slot.colour[c];
            even[c] = addProducts(even[c], load(plane + upper), even0);
            odd[c] = addProducts(odd[c], load(plane + upper + 1), odd0);
            even[c] = addProducts(even[c], load(plane + lower), even1);
            odd[c] = addProducts(odd[c], load(plane + lower + 1), odd1);
        }
    }
};

/// fit(): where it returns false, `colour` stays. `behind` replaces what shows the layer behind.
HWY_NOINLINE MS fitLanes(const Job& job, Kept& kept, const Colour* behind, MS separate,
                         Colour& colour) {
    VS tilt_x, tilt_y;
    tiltLanes(kept, tilt_x, tilt_y);
    const VW none = hn::Zero(DW());
    ColourSums sums{{none, none, none}, {none, none, none}};
    VS total = zero(), replaced = zero();
    const VS x_step = hn::ShiftLeft<6>(tilt_x), y_step = hn::ShiftLeft<6>(tilt_y);
    for (int f = 0; f < kept.frames; ++f) {
        const Kept::Frame& frame = kept.frame[f];
        // w · (1 − tilt · e) = w + w · lift, Q14.
        VS lift[4];
        lift[0] = hn::Add(hn::Mul(tilt_x, frame.cx), hn::Mul(tilt_y, frame.cy));
        lift[1] = hn::Sub(lift[0], x_step);
        lift[2] = hn::Sub(lift[0], y_step);
        lift[3] = hn::Sub(lift[1], y_step);
        VS w[4];
        for (int t = 0; t < 4; ++t) {
            const VS weight = frame.weight[t];
            w[t] = hn::Add(weight, hn::MulFixedPoint15(hn::Add(weight, weight), lift[t]));
            total = hn::Add(total, w[t]);
            if (behind != nullptr) {
                const MS back = hn::And(separate, hn::MaskFromVec(frame.behind[t]));
                replaced = hn::Add(replaced, hn::IfThenElseZero(back, w[t]));
                w[t] = hn::IfThenZeroElse(back, w[t]);
            }
        }
        const SlotIn& slot = job.slot[frame.slot];
        const Clusters& clusters = frame.clusters;
        if (clusters.count == 1) {
            sums.add(slot, clusters.of[0].upper, clusters.of[0].lower, w[0], w[1], w[2], w[3]);
            continue;
        }
        for (int i = 0; i < clusters.count; ++i) {
            const Cluster& c = clusters.of[i];
            const auto of = [&](int t) { return hn::IfThenElseZero(c.lanes, w[t]); };
            sums.add(slot, c.upper, c.lower, of(0), of(1), of(2), of(3));
        }
    }
    const MS fits = hn::And(hn::Gt(kept.weight(), set(1)), hn::Gt(total, set(1)));
    const DWU d;
    const auto evenOf = [&](VS v) { return hn::And(hn::BitCast(d, v), hn::Set(d, 0xFFFF)); };
    const auto oddOf = [&](VS v) { return hn::ShiftRight<16>(hn::BitCast(d, v)); };
    const VWU totals[2] = {evenOf(total), oddOf(total)};
    const VWU replaceds[2] = {evenOf(replaced), oddOf(replaced)};
    VWU reciprocal[2];
    for (int p = 0; p < 2; ++p) {
        reciprocal[p] = hn::GatherIndex(d, kReciprocals.data(), hn::BitCast(DW(), totals[p]));
    }
    for (int c = 0; c < 3; ++c) {
        VWU mean[2];
        for (int p = 0; p < 2; ++p) {
            VWU sum = hn::BitCast(d, p == 0 ? sums.even[c] : sums.odd[c]);
            sum = hn::Add(sum, hn::ShiftRight<1>(totals[p]));
            sum = hn::Add(sum, hn::ShiftLeft<15>(hn::Sub(totals[p], replaceds[p])));
            if (behind != nullptr) {
                const VS b = sign(behind->of[c]);
                sum = hn::Add(sum, hn::Mul(replaceds[p], p == 0 ? evenOf(b) : oddOf(b)));
            }
            mean[p] = highProduct(sum, reciprocal[p]);
        }
        const VU both = hn::BitCast(DU(), hn::Or(mean[0], hn::ShiftLeft<16>(mean[1])));
        colour.of[c] = unsign(hn::IfThenElse(fits, sign(both), sign(colour.of[c])));
    }
    return fits;
}

}  // namespace HWY_NAMESPACE
}  // namespace still::taa
HWY_AFTER_NAMESPACE();
