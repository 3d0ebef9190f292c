// One pass of the filter in lanes; filterReference() is the truth. Whole vectors reach into the
// rows' padding. Included once per target by denoise_simd.cpp.

HWY_BEFORE_NAMESPACE();
namespace still::denoising {
namespace HWY_NAMESPACE {

/// smoothVariance(). `edge`: some columns beside the group lie outside.
HWY_INLINE VF smoothVarianceLanes(const Job& job, const float* variance, int x, int y, bool edge) {
    const ptrdiff_t at = y * job.stride + x;
    const float* rows[3] = {variance + (y > 0 ? at - job.stride : at), variance + at,
                            variance + (y + 1 < job.height ? at + job.stride : at)};
    VF sum = hn::Zero(DF());
    for (int j = 0; j < 3; ++j) {
        const VF middle = load(rows[j]);
        VF left = load(rows[j] - 1), right = load(rows[j] + 1);
        if (edge) {
            left = hn::IfThenElse(lanesWithin(x, 1, job.width), left, middle);
            right = hn::IfThenElse(lanesWithin(x, 0, job.width - 1), right, middle);
        }
        sum = multiplyAdd(sum, set(kSmooth[0] * kSmooth[j]), left);
        sum = multiplyAdd(sum, set(kSmooth[1] * kSmooth[j]), middle);
        sum = multiplyAdd(sum, set(kSmooth[2] * kSmooth[j]), right);
    }
    return sum;
}

struct FilterLanes {
    VF here[kParts], scale[kParts], total[kParts], square[kParts], sum[kChannels];
};

template <bool kEdge>
HWY_INLINE void addTapLanes(const Job& job, const FilterPlanes& in, ptrdiff_t at, ptrdiff_t from,
                            VF expected, VF plane_scale, float window, MF inside, int parts,
                            FilterLanes& f) {
    const VF dx = hn::Sub(load(job.now.normal[0] + at), load(job.now.normal[0] + from));
    const VF dy = hn::Sub(load(job.now.normal[1] + at), load(job.now.normal[1] + from));
    const VF dz = hn::Sub(load(job.now.normal[2] + at), load(job.now.normal[2] + from));
    const VF turn = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
    const VF off = hn::Abs(hn::Sub(loadDepth(job.depth + from), expected));
    VF shape = hn::Mul(hn::Mul(set(window), fallOffLanes(hn::Mul(turn, set(1.0f / kNormalReach)))),
                       fallOffLanes(hn::Mul(off, plane_scale)));
    if (kEdge) {
        shape = hn::IfThenElseZero(inside, shape);
    }
    for (int p = 0; p < kParts; ++p) {
        if (!filters(parts, p)) {
            continue;
        }
        const VF red = loadLight(in.light[3 * p] + from);
        const VF green = loadLight(in.light[3 * p + 1] + from);
        const VF blue = loadLight(in.light[3 * p + 2] + from);
        const VF difference = hn::Abs(hn::Sub(luminanceLanes(red, green, blue), f.here[p]));
        const VF weight = hn::Mul(shape, fallOffLanes(hn::Mul(difference, f.scale[p])));
        VF variance = load(in.variance[p] + from);
        if (kEdge) {
            variance = hn::IfThenElseZero(inside, variance);
        }
        f.total[p] = hn::Add(f.total[p], weight);
        f.square[p] = multiplyAdd(f.square[p], hn::Mul(weight, weight), variance);
        f.sum[3 * p] = multiplyAdd(f.sum[3 * p], weight, red);
        f.sum[3 * p + 1] = multiplyAdd(f.sum[3 * p + 1], weight, green);
        f.sum[3 * p + 2] = multiplyAdd(f.sum[3 * p + 2], weight, blue);
    }
}

/// filterPixel(), for a group. `parts`: a bit for each part that is filtered.
template <bool kEdge>
HWY_INLINE void filterGroup(const Job& job, const FilterPlanes& in, const FilterPlanes& out,
                            int stride, int parts, int x, int y) {
    const ptrdiff_t at = y * job.stride + x;
    const VF depth = loadDepth(job.depth + at);
    const VF reach = set(float(stride));
    const VF step_x = hn::Mul(load(job.step[0] + at), reach);
    const VF step_y = hn::Mul(load(job.step[1] + at), reach);
    const VF slope = hn::Mul(hn::Add(hn::Abs(step_x), hn::Abs(step_y)), set(kSlopeReach));
    const VF span = hn::Add(hn::Mul(depth, set(kPlaneReach * float(stride))), slope);
    const VF plane_scale = div(set(1.0f), hn::Add(span, set(1e-12f)));
    FilterLanes f;
    for (int p = 0; p < kParts; ++p) {
        if (!filters(parts, p)) {
            continue;
        }
        const VF red = loadLight(in.light[3 * p] + at);
        const VF green = loadLight(in.light[3 * p + 1] + at);
        const VF blue = loadLight(in.light[3 * p + 2] + at);
        f.here[p] = luminanceLanes(red, green, blue);
        const VF sigma = squareRoot(smoothVarianceLanes(job, in.variance[p], x, y, kEdge));
        f.scale[p] = div(set(1.0f), multiplyAdd(set(kLeastSpan), set(kSigmas[p]), sigma));
        f.total[p] = set(kCentre);
        f.square[p] = hn::Mul(set(kCentre * kCentre), load(in.variance[p] + at));
        f.sum[3 * p] = hn::Mul(set(kCentre), red);
        f.sum[3 * p + 1] = hn::Mul(set(kCentre), green);
        f.sum[3 * p + 2] = hn::Mul(set(kCentre), blue);
    }
    const MF everywhere = hn::Eq(depth, depth);
    MF inside[3] = {everywhere, everywhere, everywhere};
    if (kEdge) {
        inside[0] = lanesWithin(x, stride, job.width + stride);
        inside[1] = lanesWithin(x, 0, job.width);
        inside[2] = lanesWithin(x, -stride, job.width - stride);
    }
    for (int j = -1; j <= 1; ++j) {
        if (y + j * stride < 0 || y + j * stride >= job.height) {
            continue;
        }
        for (int i = -1; i <= 1; ++i) {
            if (i == 0 && j == 0) {
                continue;
            }
            const VF across = hn::Mul(set(float(i)), step_x);
            const VF down = hn::Mul(set(float(j)), step_y);
            const VF expected = hn::Add(hn::Add(depth, across), down);
            addTapLanes<kEdge>(job, in, at, at + j * stride * job.stride + i * stride, expected,
                               plane_scale, kWindow[i + 1] * kWindow[j + 1], inside[i + 1], parts,
                               f);
        }
    }
    for (int p = 0; p < kParts; ++p) {
        if (!filters(parts, p)) {
            continue;
        }
        const VF share = div(set(1.0f), f.total[p]);
        store(hn::Mul(f.square[p], hn::Mul(share, share)), out.variance[p] + at);
        for (int c = 3 * p; c < 3 * p + 3; ++c) {
            storeLight(hn::Mul(f.sum[c], share), out.light[c] + at);
        }
    }
}

HWY_ATTR void filterTile(const Job& job, const FilterPlanes& in, const FilterPlanes& out, int pass,
                         int parts, const TileRect& tile) noexcept {
    const int stride = 1 << pass, lanes = laneCount();
    for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; x += lanes) {
            if (x < stride || x + lanes + stride > job.width) {
                filterGroup<true>(job, in, out, stride, parts, x, y);
            } else {
                filterGroup<false>(job, in, out, stride, parts, x, y);
            }
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace still::denoising
HWY_AFTER_NAMESPACE();
