// Rows of enlarged pictures in lanes. Included once per target by spatial_upscale_simd.cpp; the
// same operations in the same order as spatial_upscale_reference.cpp.

HWY_BEFORE_NAMESPACE();
namespace still::enlarging {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using internal::HWY_NAMESPACE::div;
using internal::HWY_NAMESPACE::squareRoot;

using F = hn::CappedTag<float, 16>;
using I = hn::RebindToSigned<F>;
using D16 = hn::Rebind<uint16_t, F>;
using VF = hn::Vec<F>;
using VI = hn::Vec<I>;

HWY_INLINE VF set(float v) {
    return hn::Set(F(), v);
}
HWY_INLINE VF taken(const float* row, VI columns, int offset) {
    return hn::GatherIndex(F(), row + offset, columns);
}

HWY_INLINE void storeLight(VF root, uint16_t* out) {
    const VF held = hn::Min(hn::Max(root, hn::Zero(F())), set(255.998f));
    const VI light = hn::ConvertTo(I(), hn::Add(hn::Mul(held, held), set(0.5f)));
    hn::StoreU(hn::DemoteTo(D16(), light), D16(), out);
}

HWY_INLINE void weigh4(VF t, VF w[4]) {
    w[0] = hn::Mul(hn::Sub(hn::Mul(hn::Add(hn::Mul(set(-0.5f), t), set(1.0f)), t), set(0.5f)), t);
    w[1] = hn::Add(hn::Mul(hn::Mul(hn::Sub(hn::Mul(set(1.5f), t), set(2.5f)), t), t), set(1.0f));
    w[2] = hn::Mul(hn::Add(hn::Mul(hn::Add(hn::Mul(set(-1.5f), t), set(2.0f)), t), set(0.5f)), t);
    w[3] = hn::Mul(hn::Mul(hn::Sub(hn::Mul(set(0.5f), t), set(0.5f)), t), t);
}

HWY_ATTR void bicubicRow(const Row& row) {
    const Weights4<float> wy = catmullRom(row.part_y);
    for (int x = 0; x < row.width; x += int(hn::Lanes(F()))) {
        const VI columns = hn::LoadU(I(), row.column + x);
        VF wx[4];
        weigh4(hn::LoadU(F(), row.part_x + x), wx);
        for (int c = 0; c < 3; ++c) {
            VF sum = hn::Zero(F());
            for (int k = 0; k < 4; ++k) {
                VF column = hn::Mul(taken(row.root[c][0], columns, k), set(wy.w[0]));
                for (int j = 1; j < 4; ++j) {
                    column =
                        hn::Add(column, hn::Mul(taken(row.root[c][j], columns, k), set(wy.w[j])));
                }
                sum = hn::Add(sum, hn::Mul(column, wx[k]));
            }
            storeLight(sum, row.out[c] + x);
        }
    }
}

/// Edge::axis()
HWY_INLINE VF slopeOf(VF share, VF before, VF middle, VF after, VF& length) {
    const VF slope = hn::Sub(after, before);
    const VF steepest = hn::Max(hn::Abs(hn::Sub(after, middle)), hn::Abs(hn::Sub(middle, before)));
    const VF ratio = hn::Min(div(hn::Abs(slope), hn::Max(steepest, set(kNoEdge))), set(1.0f));
    length = hn::Add(length, hn::Mul(hn::Mul(ratio, ratio), share));
    return hn::Mul(slope, share);
}

struct Shapes {
    VF along_x, along_y, stretch_across, stretch_along, lobe, reach;
};

HWY_INLINE Shapes shapesOf(VF edge_x, VF edge_y, VF length) {
    const VF one = set(1.0f);
    const VF square = hn::Add(hn::Mul(edge_x, edge_x), hn::Mul(edge_y, edge_y));
    const auto none = hn::Lt(square, set(kNoEdge));
    const VF size = squareRoot(hn::Max(square, set(kNoEdge)));
    const VF along_x = hn::IfThenElse(none, one, div(edge_x, size));
    const VF along_y = hn::IfThenZeroElse(none, div(edge_y, size));
    const VF half = hn::Mul(length, set(0.5f));
    const VF sharp = hn::Mul(half, half);
    const VF longer = hn::Max(hn::Abs(along_x), hn::Abs(along_y));
    const VF diagonal = div(hn::Add(hn::Mul(along_x, along_x), hn::Mul(along_y, along_y)), longer);
    const VF lobe = hn::Sub(set(0.5f), hn::Mul(set(0.29f), sharp));
    return {along_x,
            along_y,
            hn::Add(one, hn::Mul(hn::Sub(diagonal, one), sharp)),
            hn::Sub(one, hn::Mul(set(0.5f), sharp)),
            lobe,
            div(one, lobe)};
}

HWY_INLINE VF weightsAt(const Shapes& s, VF x, VF y) {
    const VF u = hn::Mul(hn::Add(hn::Mul(x, s.along_x), hn::Mul(y, s.along_y)), s.stretch_across);
    const VF v = hn::Mul(hn::Sub(hn::Mul(y, s.along_x), hn::Mul(x, s.along_y)), s.stretch_along);
    const VF d = hn::Min(hn::Add(hn::Mul(u, u), hn::Mul(v, v)), s.reach);
    const VF base = hn::Sub(hn::Mul(set(0.4f), d), set(1.0f));
    const VF window = hn::Sub(hn::Mul(s.lobe, d), set(1.0f));
    return hn::Mul(hn::Sub(hn::Mul(set(1.5625f), hn::Mul(base, base)), set(0.5625f)),
                   hn::Mul(window, window));
}

HWY_INLINE Shapes shapesAt(const Row& row, VI columns, VF part_x) {
    const VF zero = hn::Zero(F());
    VF at[4][4] = {{zero, zero, zero, zero},
                   {zero, zero, zero, zero},
                   {zero, zero, zero, zero},
                   {zero, zero, zero, zero}};
    for (const Tap& tap : kTaps) {
        at[tap.row][tap.column] = taken(row.brightness[tap.row], columns, tap.column);
    }
    VF x = zero, y = zero, length = zero;
    for (int j = 1; j <= 2; ++j) {
        for (int k = 1; k <= 2; ++k) {
            const VF share_y = set(j == 1 ? 1.0f - row.part_y : row.part_y);
            const VF share_x = k == 1 ? hn::Sub(set(1.0f), part_x) : part_x;
            const VF share = hn::Mul(share_y, share_x);
            x = hn::Add(x, slopeOf(share, at[j][k - 1], at[j][k], at[j][k + 1], length));
            y = hn::Add(y, slopeOf(share, at[j - 1][k], at[j][k], at[j + 1][k], length));
        }
    }
    return shapesOf(x, y, length);
}

HWY_ATTR void edgeRow(const Row& row) {
    for (int x = 0; x < row.width; x += int(hn::Lanes(F()))) {
        const VI columns = hn::LoadU(I(), row.column + x);
        const VF part_x = hn::LoadU(F(), row.part_x + x);
        const Shapes shapes = shapesAt(row, columns, part_x);
        VF total = hn::Zero(F()), weights[12];
        for (int i = 0; i < 12; ++i) {
            weights[i] = weightsAt(shapes, hn::Sub(set(float(kTaps[i].column - 1)), part_x),
                                   set(float(kTaps[i].row - 1) - row.part_y));
            total = hn::Add(total, weights[i]);
        }
        for (int c = 0; c < 3; ++c) {
            VF sum = hn::Zero(F()), least = set(256.0f), most = hn::Zero(F());
            for (int i = 0; i < 12; ++i) {
                const Tap tap = kTaps[i];
                const VF root = taken(row.root[c][tap.row], columns, tap.column);
                sum = hn::Add(sum, hn::Mul(root, weights[i]));
                const bool middle =
                    (tap.row == 1 || tap.row == 2) && (tap.column == 1 || tap.column == 2);
                least = middle ? hn::Min(least, root) : least;
                most = middle ? hn::Max(most, root) : most;
            }
            storeLight(hn::Min(hn::Max(div(sum, total), least), most), row.out[c] + x);
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace still::enlarging
HWY_AFTER_NAMESPACE();
