// The plane through an output pixel's samples, at its centre: fit() of upscale_reference.cpp in
// lanes. Included once per target by taa_simd.cpp.

HWY_BEFORE_NAMESPACE();
namespace still::taa {
namespace HWY_NAMESPACE {

/// The samples that count for a lane's output pixels.
struct OutputTaps {
    static constexpr int kMost = kMaxRing + 4;
    VS weight[kMost], ex[kMost], ey[kMost], behind[kMost];
    VS colour[3][kMost];
    int count;
};

HWY_NOINLINE void tiltOutput(const OutputTaps& taps, VS& weight, VS& tilt_x, VS& tilt_y) {
    const DS d;
    const VS none = zero(), one = set(1);
    Wide x, y, xx, xy, yy;
    for (Wide* wide : {&x, &y, &xx, &xy, &yy}) {
        wide->clear();
    }
    weight = none;
    for (int i = 0; i < taps.count; i += 2) {
        const bool two = i + 1 < taps.count;
        const VS w0 = taps.weight[i], w1 = two ? taps.weight[i + 1] : none;
        const VS x0 = taps.ex[i], x1 = two ? taps.ex[i + 1] : none;
        const VS y0 = taps.ey[i], y1 = two ? taps.ey[i + 1] : none;
        const VS wx0 = hn::Mul(w0, x0), wx1 = hn::Mul(w1, x1);
        const VS wy0 = hn::Mul(w0, y0), wy1 = hn::Mul(w1, y1);
        weight = hn::Add(weight, hn::Add(w0, w1));
        x.add(wx0, wx1, one, one);
        y.add(wy0, wy1, one, one);
        xx.add(wx0, wx1, x0, x1);
        xy.add(wx0, wx1, y0, y1);
        yy.add(wy0, wy1, y0, y1);
    }
    const DW dw;
    VW x_lower, y_lower, x_upper, y_upper;
    tiltOf({hn::BitCast(dw, hn::InterleaveLower(d, weight, none)), x.lower, y.lower, xx.lower,
            xy.lower, yy.lower},
           x_lower, y_lower);
    tiltOf({hn::BitCast(dw, hn::InterleaveUpper(d, weight, none)), x.upper, y.upper, xx.upper,
            xy.upper, yy.upper},
           x_upper, y_upper);
    tilt_x = narrow(x_lower, x_upper);
    tilt_y = narrow(y_lower, y_upper);
    for (int i = 0; i < 6; ++i) {
        const MS steep = hn::Gt(hn::Add(hn::Abs(tilt_x), hn::Abs(tilt_y)), set(kMaxTilt));
        if (!any(steep)) {
            return;
        }
        tilt_x = hn::IfThenElse(steep, hn::ShiftRight<1>(tilt_x), tilt_x);
        tilt_y = hn::IfThenElse(steep, hn::ShiftRight<1>(tilt_y), tilt_y);
    }
}

/// fit(): `colour` stays where the result is false. `behind` replaces what shows the layer behind.
HWY_NOINLINE MS fitOutput(const OutputTaps& taps, const Colour* behind, MS separate, VS& weight,
                          Colour& colour) {
    const DS d;
    VS tilt_x, tilt_y;
    tiltOutput(taps, weight, tilt_x, tilt_y);
    Wide sums[3];
    for (Wide& sum : sums) {
        sum.clear();
    }
    VS total = zero(), replaced = zero();
    VS last = zero();
    for (int i = 0; i < taps.count; ++i) {
        const VS lift = hn::Neg(hn::Add(hn::Mul(tilt_x, taps.ex[i]), hn::Mul(tilt_y, taps.ey[i])));
        const VS w = taps.weight[i];
        VS tilted = hn::Max(hn::Add(w, hn::MulFixedPoint15(hn::Add(w, w), lift)), zero());
        total = hn::Add(total, tilted);
        if (behind != nullptr) {
            const MS back = hn::And(separate, hn::MaskFromVec(taps.behind[i]));
            replaced = hn::Add(replaced, hn::IfThenElseZero(back, tilted));
            tilted = hn::IfThenZeroElse(back, tilted);
        }
        if ((i & 1) == 0 && i + 1 < taps.count) {
            last = tilted;
            continue;
        }
        const VS first = (i & 1) == 0 ? zero() : last;
        const int before = (i & 1) == 0 ? i : i - 1;
        for (int c = 0; c < 3; ++c) {
            sums[c].add(first, tilted, taps.colour[c][before], taps.colour[c][i]);
        }
    }
    const MS fits = hn::And(hn::Gt(weight, set(1)), hn::Gt(total, set(1)));
    const DWU dwu;
    const auto lower = [&](VS v) { return hn::BitCast(dwu, hn::InterleaveLower(d, v, zero())); };
    const auto upper = [&](VS v) { return hn::BitCast(dwu, hn::InterleaveUpper(d, v, zero())); };
    const VWU totals[2] = {lower(total), upper(total)};
    const VWU replaceds[2] = {lower(replaced), upper(replaced)};
    for (int c = 0; c < 3; ++c) {
        VW mean[2];
        for (int p = 0; p < 2; ++p) {
            const VWU reciprocal =
                hn::GatherIndex(dwu, kReciprocals.data(), hn::BitCast(DW(), totals[p]));
            VWU sum = hn::BitCast(dwu, p == 0 ? sums[c].lower : sums[c].upper);
            sum = hn::Add(sum, hn::ShiftRight<1>(totals[p]));
            sum = hn::Add(sum, hn::ShiftLeft<15>(hn::Sub(totals[p], replaceds[p])));
            if (behind != nullptr) {
                const VS b = sign(behind->of[c]);
                sum = hn::Add(sum, hn::Mul(replaceds[p], p == 0 ? lower(b) : upper(b)));
            }
            mean[p] =
                hn::Sub(hn::BitCast(DW(), highProduct(sum, reciprocal)), hn::Set(DW(), kOffset));
        }
        const VS both = flipTop(narrow(mean[0], mean[1]));
        colour.of[c] = unsign(hn::IfThenElse(fits, both, sign(colour.of[c])));
    }
    return fits;
}

}  // namespace HWY_NAMESPACE
}  // namespace still::taa
HWY_AFTER_NAMESPACE();
