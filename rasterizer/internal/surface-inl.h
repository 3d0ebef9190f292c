// A surface point, one pixel per lane: barycentrics, interpolated attributes, position and frame in
// the world; see surface_reference.h for the truth. Included once per target by kernels_simd.cpp.

HWY_BEFORE_NAMESPACE();
namespace still::internal {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FTag = hn::CappedTag<float, 8>;
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
    const FVec length = hn::Sqrt(hn::Max(dot3(a, a), splat(kTiny)));
    return scale3(a, hn::Div(splat(1.0f), length));
}

/// Which triangle each lane shades. With kUniform all lanes have the same one and everything that
/// belongs to it is broadcast; otherwise it is gathered. Both give the same values.
template <bool kUniform>
struct LaneTriangles;

template <>
struct LaneTriangles<true> {
    const ShadeTriangle* t;

    FVec word(int i) const { return splat(reinterpret_cast<const float*>(t)[i]); }
    FVec vertexField(const float* base, int stride, int field, int k) const {
        return splat(base[t->vertex[k] * stride + field]);
    }
};

template <>
struct LaneTriangles<false> {
    const float* words;  ///< of the tile's shade array
    IVec first_word;     ///< of each lane's triangle
    IVec vertex[3];

    FVec word(int i) const {
        return hn::GatherIndex(FTag(), words, hn::Add(first_word, splatInt(i)));
    }
    FVec vertexField(const float* base, int stride, int field, int k) const {
        const IVec at = hn::Add(hn::Mul(vertex[k], splatInt(stride)), splatInt(field));
        return hn::GatherIndex(FTag(), base, at);
    }
};

/// Word offsets of ShadeTriangle.
enum : int {
    kWordP = 0,
    kWordDx = 3,
    kWordDy = 6,
    kWordAnchorX = 9,
    kWordAnchorY = 10,
    kWordVertex = 11,
    kWordFlip = 15
};

struct LaneBarycentrics {
    FVec b[3];
    FVec w;
};

template <class Triangles>
HWY_INLINE LaneBarycentrics barycentrics(const Triangles& t, FVec x, FVec y) {
    LaneBarycentrics p;
    const FVec rx = hn::Sub(x, t.word(kWordAnchorX));
    const FVec ry = hn::Sub(y, t.word(kWordAnchorY));
    for (int k = 0; k < 3; ++k) {
        const FVec v = hn::Add(hn::Add(t.word(kWordP + k), hn::Mul(t.word(kWordDy + k), ry)),
                               hn::Mul(t.word(kWordDx + k), rx));
        p.b[k] = hn::Max(v, hn::Zero(FTag()));
    }
    p.w = hn::Div(splat(1.0f), hn::Max(hn::Add(hn::Add(p.b[0], p.b[1]), p.b[2]), splat(kTiny)));
    for (FVec& b : p.b) {
        b = hn::Mul(b, p.w);
    }
    return p;
}

HWY_INLINE FVec interpolate3(const FVec b[3], FVec f0, FVec f1, FVec f2) {
    return hn::Add(hn::Add(hn::Mul(b[0], f0), hn::Mul(b[1], f1)), hn::Mul(b[2], f2));
}

template <class Triangles>
HWY_INLINE FVec attribute(const Triangles& t, const LaneBarycentrics& p, const float* base,
                          int stride, int field) {
    return interpolate3(p.b, t.vertexField(base, stride, field, 0),
                        t.vertexField(base, stride, field, 1),
                        t.vertexField(base, stride, field, 2));
}

template <bool kUniform>
HWY_INLINE Vec3 objectPosition(const LaneTriangles<kUniform>& t, const LaneBarycentrics& p,
                               const Surface& s) {
    return {attribute(t, p, s.x, 1, 0), attribute(t, p, s.y, 1, 0), attribute(t, p, s.z, 1, 0)};
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
                             const Surface& s, const InstanceSetup& instance) {
    Vec3 v{attribute(t, p, s.tangents, kTangentStride, 0),
           attribute(t, p, s.tangents, kTangentStride, 1),
           attribute(t, p, s.tangents, kTangentStride, 2)};
    if (!instance.identity) {
        const float* m = instance.world.data();
        v = {linearRow(m, v), linearRow(m + 4, v), linearRow(m + 8, v)};
    }
    return normalize3(v);
}

/// Unit length, on the side that the mesh says is outside.
template <bool kUniform>
HWY_INLINE Vec3 worldNormal(const LaneTriangles<kUniform>& t, const LaneBarycentrics& p,
                            const Surface& s, const InstanceSetup& instance) {
    Vec3 n{attribute(t, p, s.attributes, kAttributeStride, 0),
           attribute(t, p, s.attributes, kAttributeStride, 1),
           attribute(t, p, s.attributes, kAttributeStride, 2)};
    if (!instance.identity) {
        const float* m = instance.normal;
        n = {linearRow(m, n), linearRow(m + 3, n), linearRow(m + 6, n)};
    }
    return normalize3(n);
}

/// Along +v, from the world's normal and tangent. A mirroring turns the frame's hand.
template <bool kUniform>
HWY_INLINE Vec3 worldBitangent(const LaneTriangles<kUniform>& t, const Surface& s,
                               const InstanceSetup& instance, const Vec3& n, const Vec3& tangent) {
    const FVec handedness = t.vertexField(s.tangents, kTangentStride, 3, 0);
    const Vec3 cross{hn::Sub(hn::Mul(n.y, tangent.z), hn::Mul(n.z, tangent.y)),
                     hn::Sub(hn::Mul(n.z, tangent.x), hn::Mul(n.x, tangent.z)),
                     hn::Sub(hn::Mul(n.x, tangent.y), hn::Mul(n.y, tangent.x))};
    return scale3(cross, instance.mirrored ? hn::Neg(handedness) : handedness);
}

template <bool kUniform>
HWY_INLINE Vec3 worldPosition(const LaneTriangles<kUniform>& t, const LaneBarycentrics& p,
                              const Surface& s, const InstanceSetup& instance) {
    const Vec3 position = objectPosition(t, p, s);
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

}  // namespace HWY_NAMESPACE
}  // namespace still::internal
HWY_AFTER_NAMESPACE();
