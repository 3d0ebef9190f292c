// A surface point, one pixel per lane: barycentrics, interpolated attributes, position and frame in
// the world; see surface_reference.h for the truth. Included once per target by kernels_simd.cpp.

HWY_BEFORE_NAMESPACE();
namespace still::internal {
namespace HWY_NAMESPACE {
namespace shading {
namespace hn = hwy::HWY_NAMESPACE;

/// As many lanes as the target has, up to a quarter of a tile's row.
using FTag = hn::CappedTag<float, kTileSize / 4>;
using ITag = hn::RebindToSigned<FTag>;
using UTag = hn::RebindToUnsigned<FTag>;
using FVec = hn::Vec<FTag>;
using IVec = hn::Vec<ITag>;
using UVec = hn::Vec<UTag>;
using FMask = hn::Mask<FTag>;

HWY_INLINE FVec splat(float v) {
    return hn::Set(FTag(), v);
}

HWY_INLINE IVec splatInt(int32_t v) {
    return hn::Set(ITag(), v);
}

struct Vec3 {
    FVec x, y, z;
};

HWY_INLINE FVec dot3(const Vec3& a, const Vec3& b) {
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

HWY_INLINE Vec3 scale3(const Vec3& a, FVec s) {
    return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)};
}

HWY_INLINE Vec3 normalize3(const Vec3& a) {
    const FVec length = squareRoot(hn::Max(dot3(a, a), splat(kTiny)));
    return scale3(a, div(splat(1.0f), length));
}

/// An integral value below 2^22 as an integer: the sum with 1.5 · 2^23 holds it in its low bits.
/// Shorter than a conversion, which has to care about overflow.
HWY_INLINE IVec smallInt(FVec integral) {
    return hn::Sub(hn::BitCast(ITag(), hn::Add(integral, splat(12582912.0f))),
                   splatInt(0x4B400000));
}

/// floor(v + 0.5) as roundToInt(), for |v| < 2^22.
HWY_INLINE IVec roundSmall(FVec v) {
    return smallInt(hn::Floor(hn::Add(v, splat(0.5f))));
}

/// Four consecutive words of a record, each for all lanes.
struct Quad {
    FVec word[4];
};

#if HWY_TARGET != HWY_SCALAR
/// Word 4 · i of lane 0, 4 · i + 1 of lane 0, … of lane 4, … : 128-bit loads, one per lane quarter.
template <class D>
HWY_INLINE hn::Vec<D> everyFourth(D d, const float* words, const int32_t* at) {
    if constexpr (hn::MaxLanes(D()) <= 4) {
        return hn::LoadU(d, words + at[0]);
    } else {
        const hn::Half<D> half;
        constexpr int kHalf = hn::MaxLanes(D()) / 2;
        return hn::Combine(d, everyFourth(half, words, at + kHalf), everyFourth(half, words, at));
    }
}
#endif

/// The quads that start at words + at[lane], transposed. Gathers would load the same words one by
/// one.
HWY_INLINE Quad loadQuads(const float* words, const int32_t* at) {
#if HWY_TARGET == HWY_SCALAR
    const float* w = words + at[0];
    return {{splat(w[0]), splat(w[1]), splat(w[2]), splat(w[3])}};
#else
    const FTag d;
    const PairsOf<FTag> d64;
    const FVec row[4] = {everyFourth(d, words, at), everyFourth(d, words, at + 1),
                         everyFourth(d, words, at + 2), everyFourth(d, words, at + 3)};
    const auto low01 = hn::BitCast(d64, hn::InterleaveLower(d, row[0], row[1]));
    const auto low23 = hn::BitCast(d64, hn::InterleaveLower(d, row[2], row[3]));
    const auto high01 = hn::BitCast(d64, hn::InterleaveUpper(d, row[0], row[1]));
    const auto high23 = hn::BitCast(d64, hn::InterleaveUpper(d, row[2], row[3]));
    return {{hn::BitCast(d, hn::InterleaveLower(d64, low01, low23)),
             hn::BitCast(d, hn::InterleaveUpper(d64, low01, low23)),
             hn::BitCast(d, hn::InterleaveLower(d64, high01, high23)),
             hn::BitCast(d, hn::InterleaveUpper(d64, high01, high23))}};
#endif
}

/// Which triangle each lane shades. With kUniform all lanes have the same one and everything that
/// belongs to it is broadcast; otherwise it is loaded lane by lane. Both give the same values.
template <bool kUniform>
struct LaneTriangles;

template <>
struct LaneTriangles<true> {
    const ShadeTriangle* t;

    Quad quad(int i) const {
        const float* w = reinterpret_cast<const float*>(t) + 4 * i;
        return {{splat(w[0]), splat(w[1]), splat(w[2]), splat(w[3])}};
    }
};

template <>
struct LaneTriangles<false> {
    const float* words;         ///< of the tile's shade array
    const int32_t* first_word;  ///< of each lane's triangle

    Quad quad(int i) const { return loadQuads(words + 4 * i, first_word); }
};

/// Quads of ShadeTriangle.
enum : int {
    kQuadP,
    kQuadDx,
    kQuadDy,
    kQuadU,
    kQuadV,
    kQuadSlopes,
    kQuadNormal,
    kQuadPosition = kQuadNormal + 3,
    kQuadTangent = kQuadPosition + 3,
};
static_assert(offsetof(ShadeTriangle, u) == kQuadU * 16);
static_assert(offsetof(ShadeTriangle, nx) == kQuadNormal * 16);
static_assert(offsetof(ShadeTriangle, x) == kQuadPosition * 16);
static_assert(offsetof(ShadeTriangle, tx) == kQuadTangent * 16);

struct LaneBarycentrics {
    FVec b[3];
    FVec w;
    FVec flip;
};

template <class Triangles>
HWY_INLINE LaneBarycentrics barycentrics(const Triangles& t, FVec x, FVec y) {
    const Quad p = t.quad(kQuadP), dx = t.quad(kQuadDx), dy = t.quad(kQuadDy);
    LaneBarycentrics out;
    const FVec rx = hn::Sub(x, p.word[3]);
    const FVec ry = hn::Sub(y, dx.word[3]);
    for (int k = 0; k < 3; ++k) {
        const FVec v =
            hn::Add(hn::Add(p.word[k], hn::Mul(dy.word[k], ry)), hn::Mul(dx.word[k], rx));
        out.b[k] = hn::Max(v, hn::Zero(FTag()));
    }
    out.w = div(splat(1.0f), hn::Max(hn::Add(hn::Add(out.b[0], out.b[1]), out.b[2]), splat(kTiny)));
    for (FVec& b : out.b) {
        b = hn::Mul(b, out.w);
    }
    out.flip = dy.word[3];
    return out;
}

HWY_INLINE FVec interpolate3(const FVec b[3], FVec f0, FVec f1, FVec f2) {
    return hn::Add(hn::Add(hn::Mul(b[0], f0), hn::Mul(b[1], f1)), hn::Mul(b[2], f2));
}

/// The attribute whose corner values are the first three words of the quad.
HWY_INLINE FVec attribute(const LaneBarycentrics& p, const Quad& corners) {
    return interpolate3(p.b, corners.word[0], corners.word[1], corners.word[2]);
}

/// Three attributes in consecutive quads.
template <class Triangles>
HWY_INLINE Vec3 attribute3(const Triangles& t, const LaneBarycentrics& p, int quad) {
    return {attribute(p, t.quad(quad)), attribute(p, t.quad(quad + 1)),
            attribute(p, t.quad(quad + 2))};
}

HWY_INLINE FVec affineRow(const float* m, const Vec3& p) {
    return hn::Add(hn::Add(hn::Mul(splat(m[0]), p.x), hn::Mul(splat(m[1]), p.y)),
                   hn::Add(hn::Mul(splat(m[2]), p.z), splat(m[3])));
}

HWY_INLINE FVec linearRow(const float* m, const Vec3& v) {
    return hn::Add(hn::Add(hn::Mul(splat(m[0]), v.x), hn::Mul(splat(m[1]), v.y)),
                   hn::Mul(splat(m[2]), v.z));
}

template <bool kUniform>
HWY_INLINE Vec3 worldTangent(const LaneTriangles<kUniform>& t, const LaneBarycentrics& p,
                             const InstanceSetup& instance) {
    Vec3 v = attribute3(t, p, kQuadTangent);
    if (!instance.identity) {
        const float* m = instance.world.data();
        v = {linearRow(m, v), linearRow(m + 4, v), linearRow(m + 8, v)};
    }
    return normalize3(v);
}

/// Unit length, on the side that the mesh says is outside.
template <bool kUniform>
HWY_INLINE Vec3 worldNormal(const LaneTriangles<kUniform>& t, const LaneBarycentrics& p,
                            const InstanceSetup& instance) {
    Vec3 n = attribute3(t, p, kQuadNormal);
    if (!instance.identity) {
        const float* m = instance.normal;
        n = {linearRow(m, n), linearRow(m + 3, n), linearRow(m + 6, n)};
    }
    return normalize3(n);
}

/// Along +v, from the world's normal and tangent. A mirroring turns the frame's hand.
template <bool kUniform>
HWY_INLINE Vec3 worldBitangent(const LaneTriangles<kUniform>& t, const InstanceSetup& instance,
                               const Vec3& n, const Vec3& tangent) {
    const FVec handedness = t.quad(kQuadNormal).word[3];
    const Vec3 cross{hn::Sub(hn::Mul(n.y, tangent.z), hn::Mul(n.z, tangent.y)),
                     hn::Sub(hn::Mul(n.z, tangent.x), hn::Mul(n.x, tangent.z)),
                     hn::Sub(hn::Mul(n.x, tangent.y), hn::Mul(n.y, tangent.x))};
    return scale3(cross, instance.mirrored ? hn::Neg(handedness) : handedness);
}

template <bool kUniform>
HWY_INLINE Vec3 worldPosition(const LaneTriangles<kUniform>& t, const LaneBarycentrics& p,
                              const InstanceSetup& instance) {
    const Vec3 position = attribute3(t, p, kQuadPosition);
    if (instance.identity) {
        return position;
    }
    const float* m = instance.world.data();
    return {affineRow(m, position), affineRow(m + 4, position), affineRow(m + 8, position)};
}

/// Unit vectors from world positions to the eye.
HWY_INLINE Vec3 towardsEye(const FrameView& view, const Vec3& position) {
    return normalize3({hn::Sub(splat(view.eye.x), position.x),
                       hn::Sub(splat(view.eye.y), position.y),
                       hn::Sub(splat(view.eye.z), position.z)});
}

}  // namespace shading
}  // namespace HWY_NAMESPACE
}  // namespace still::internal
HWY_AFTER_NAMESPACE();
