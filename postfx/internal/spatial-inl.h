// Edge marks and means of rows in lanes. Included once per target by spatial_simd.cpp; 32-bit
// lanes, one pixel each.

HWY_BEFORE_NAMESPACE();
namespace still::spatial {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr int kMaxLanes = 16;
using D32 = hn::CappedTag<int32_t, kMaxLanes>;
using D16 = hn::Rebind<uint16_t, D32>;
using D8 = hn::Rebind<uint8_t, D32>;
using V32 = hn::Vec<D32>;
using Mask32 = hn::Mask<D32>;

HWY_INLINE V32 load16(const uint16_t* p) {
    return hn::PromoteTo(D32(), hn::LoadU(D16(), p));
}

struct Normals {
    V32 x, y, z;
};

/// unpackNormal()
HWY_INLINE Normals unpackNormals(V32 packed) {
    const D32 d;
    const V32 zero = hn::Zero(d);
    V32 x = hn::ShiftRight<16>(hn::ShiftLeft<16>(packed));
    V32 y = hn::ShiftRight<16>(packed);
    const V32 z = hn::Sub(hn::Sub(hn::Set(d, 32767), hn::Abs(x)), hn::Abs(y));
    const V32 fold = hn::Max(hn::Neg(z), zero);
    x = hn::Add(x, hn::IfThenElse(hn::Lt(x, zero), fold, hn::Neg(fold)));
    y = hn::Add(y, hn::IfThenElse(hn::Lt(y, zero), fold, hn::Neg(fold)));
    return {x, y, z};
}

/// normalDistance()
HWY_INLINE V32 normalDistances(const Normals& a, const Normals& b) {
    return hn::Add(hn::Add(hn::Abs(hn::Sub(a.x, b.x)), hn::Abs(hn::Sub(a.y, b.y))),
                   hn::Abs(hn::Sub(a.z, b.z)));
}

HWY_INLINE V32 loadNormal(const uint32_t* p) {
    return hn::BitCast(D32(), hn::LoadU(hn::Rebind<uint32_t, D32>(), p));
}

/// Four pixels in a line, the edge being between the second and the third.
struct Line {
    const uint16_t* id[4];
    const uint32_t* normal[4];
};

HWY_INLINE Mask32 sameSurfaces(const Line& line, int x, int i) {
    const D32 d;
    const V32 different = hn::Xor(load16(line.id[i] + x), load16(line.id[i + 1] + x));
    return hn::Eq(hn::And(different, hn::Set(d, kSurfaceMask)), hn::Zero(d));
}

/// LiveEdges::isSmooth() of the step from pixel i to i + 1.
HWY_INLINE Mask32 areSmooth(const Line& line, int x, int i, const Normals& a, const Normals& b,
                            V32 jump) {
    static_assert(kCreaseRatio == 4);
    const V32 bend = hn::ShiftLeft<2>(normalDistances(a, b));
    return hn::Or(hn::Not(sameSurfaces(line, x, i)), hn::Not(hn::Gt(bend, jump)));
}

/// Creases between the second and the third pixel, whatever their surfaces.
HWY_INLINE Mask32 creasesAt(const Line& line, int x) {
    const D32 d;
    const V32 second = loadNormal(line.normal[1] + x), third = loadNormal(line.normal[2] + x);
    if (hn::AllTrue(d, hn::Eq(second, third))) {
        return hn::MaskFromVec(hn::Zero(d));
    }
    const Normals b = unpackNormals(second), c = unpackNormals(third);
    const V32 jump = normalDistances(b, c);
    const Mask32 large = hn::Gt(jump, hn::Set(d, kCrease));
    if (hn::AllFalse(d, large)) {
        return large;
    }
    const Normals a = unpackNormals(loadNormal(line.normal[0] + x));
    const Normals e = unpackNormals(loadNormal(line.normal[3] + x));
    return hn::And(large,
                   hn::And(areSmooth(line, x, 0, a, b, jump), areSmooth(line, x, 2, c, e, jump)));
}

/// Edges between the second and the third pixel as `bit`.
HWY_INLINE V32 edgesAt(const Line& line, int x, bool creases, uint8_t bit) {
    const D32 d;
    const Mask32 same = sameSurfaces(line, x, 1);
    Mask32 edge = hn::Not(same);
    if (creases) {
        edge = hn::Or(edge, creasesAt(line, x));
    }
    return hn::IfThenElseZero(edge, hn::Set(d, bit));
}

/// Pixels (x + i · dx, y + i · dy) for i = −1 … 2. Rows outside repeat, which makes steps of
/// nothing as isSmooth() wants it.
HWY_INLINE Line lineAt(const SpatialInput& input, int y, int dx, int dy) {
    Line line{};
    for (int i = 0; i < 4; ++i) {
        const int row = std::clamp(y + (i - 1) * dy, 0, input.id.height - 1);
        line.id[i] = input.id.row(row) + (i - 1) * dx;
        line.normal[i] = input.normal.empty() ? nullptr : input.normal.row(row) + (i - 1) * dx;
    }
    return line;
}

HWY_ATTR void markEdges(const SpatialInput& input, int y, uint8_t* marks) {
    const D32 d;
    const int width = input.id.width;
    const bool creases = !input.normal.empty();
    const Line across = lineAt(input, y, 1, 0), down = lineAt(input, y, 0, 1);
    for (int x = 0; x < width; x += int(hn::Lanes(d))) {
        const V32 bits =
            hn::Or(edgesAt(across, x, creases, kEdgeRight), edgesAt(down, x, creases, kEdgeBelow));
        hn::StoreU(hn::DemoteTo(D8(), bits), D8(), marks + x);
    }
    // These have seen pixels from outside of the picture.
    const Picture<LiveEdges> picture(input, {input});
    for (int x : {0, width - 2, width - 1}) {
        if (x >= 0) {
            marks[x] = edgeMarks(picture, x, y);
        }
    }
}

/// Non-zero where an edge is within the 3×3 window. Reads one pixel to each side.
HWY_INLINE void markBusy(ImageView<const uint8_t> edges, int y, uint8_t* busy) {
    const hn::ScalableTag<uint8_t> d;
    const uint8_t *above = edges.row(y - 1), *here = edges.row(y), *below = edges.row(y + 1);
    const auto right_bit = hn::Set(d, kEdgeRight), below_bit = hn::Set(d, kEdgeBelow);
    const auto both = [&](const uint8_t* a, const uint8_t* b) {
        return hn::Or(hn::LoadU(d, a), hn::LoadU(d, b));
    };
    for (int x = 0; x < edges.width; x += int(hn::Lanes(d))) {
        const auto before = both(above + x - 1, here + x - 1);
        const auto centre = both(above + x, here + x);
        const auto after = both(above + x + 1, here + x + 1);
        const auto vertical = hn::Or(hn::Or(before, centre), both(below + x - 1, below + x));
        const auto horizontal = hn::Or(hn::Or(before, centre), after);
        hn::StoreU(hn::Or(hn::And(vertical, right_bit), hn::And(horizontal, below_bit)), d,
                   busy + x);
    }
}

struct LaneTaps {
    V32 before, after;
};
HWY_INLINE LaneTaps laneTaps(int jitter_fx8) {
    const Taps taps = pixelTaps(jitter_fx8);
    return {hn::Set(D32(), taps.before_q14), hn::Set(D32(), taps.after_q14)};
}

/// threeTaps()
HWY_INLINE V32 threeTapLanes(V32 before, V32 centre, V32 after, const LaneTaps& taps) {
    const V32 sum = hn::Add(hn::Mul(hn::Sub(before, centre), taps.before),
                            hn::Mul(hn::Sub(after, centre), taps.after));
    return hn::Add(centre, hn::ShiftRight<14>(hn::Add(sum, hn::Set(D32(), 1 << 13))));
}

/// pixelMean() at x of the rows above, here and below.
HWY_INLINE V32 pixelMeans(const uint16_t* above, const uint16_t* here, const uint16_t* below,
                          const LaneTaps& across, const LaneTaps& down) {
    const V32 left = load16(here - 1), centre = load16(here), right = load16(here + 1);
    const V32 up = load16(above), low = load16(below);
    const V32 top = threeTapLanes(load16(above - 1), up, load16(above + 1), across);
    const V32 middle = threeTapLanes(left, centre, right, across);
    const V32 bottom = threeTapLanes(load16(below - 1), low, load16(below + 1), across);
    const V32 mean = threeTapLanes(top, middle, bottom, down);
    const V32 least = hn::Min(hn::Min(hn::Min(left, right), hn::Min(up, low)), centre);
    const V32 most = hn::Max(hn::Max(hn::Max(left, right), hn::Max(up, low)), centre);
    return hn::Min(hn::Max(mean, least), most);
}

HWY_INLINE void store16(V32 v, uint16_t* p) {
    hn::StoreU(hn::DemoteTo(D16(), v), D16(), p);
}

HWY_ATTR void meanRow(const SpatialInput& input, ImageView<const uint8_t> edges, int y,
                      const ColourTargets& out, uint8_t* busy) {
    const D32 d;
    const D8 d8;
    markBusy(edges, y, busy);
    const LaneTaps across = laneTaps(input.jitter_x_fx8), down = laneTaps(input.jitter_y_fx8);
    const ImageView<const uint16_t> from[3] = {input.colour.red, input.colour.green,
                                               input.colour.blue};
    const ImageView<uint16_t> to[3] = {out.red, out.green, out.blue};
    for (int x = 0; x < edges.width; x += int(hn::Lanes(d))) {
        const V32 edge = hn::PromoteTo(d, hn::LoadU(d8, busy + x));
        if (hn::AllFalse(d, hn::Eq(edge, hn::Zero(d)))) {
            continue;
        }
        for (int c = 0; c < 3; ++c) {
            store16(pixelMeans(from[c].row(y - 1) + x, from[c].row(y) + x, from[c].row(y + 1) + x,
                               across, down),
                    to[c].row(y) + x);
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace still::spatial
HWY_AFTER_NAMESPACE();
