// Boxes and triangles, as many at once as there are lanes. Steps as in trace_reference.cpp.
// Included once per target.

HWY_BEFORE_NAMESPACE();
namespace still::internal {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using Eight = hn::CappedTag<float, kTreeWidth>;

template <class D, class M>
HWY_INLINE uint32_t maskBits(D d, M mask) {
    uint8_t bits[8] = {};
    hn::StoreMaskBits(d, mask, bits);
    return bits[0];
}

template <bool kWithNear>
HWY_INLINE uint32_t boxMask(const BvhNode& node, const TraceRay& ray, float end, float* near_t) {
    const Eight d;
    const auto o_x = hn::Set(d, ray.origin[0]), i_x = hn::Set(d, ray.inverse[0]);
    const auto o_y = hn::Set(d, ray.origin[1]), i_y = hn::Set(d, ray.inverse[1]);
    const auto o_z = hn::Set(d, ray.origin[2]), i_z = hn::Set(d, ray.inverse[2]);
    const float* bounds = node.bounds[0][0];
    uint32_t mask = 0;
    for (size_t i = 0; i < size_t(kTreeWidth); i += hn::Lanes(d)) {
        const auto at = [&](size_t bound, auto o, auto inverse) HWY_ATTR {
            return hn::Mul(hn::Sub(hn::Load(d, bounds + bound + i), o), inverse);
        };
        const auto entry =
            hn::Max(hn::Max(hn::Zero(d), at(ray.near_at[0], o_x, i_x)),
                    hn::Max(at(ray.near_at[1], o_y, i_y), at(ray.near_at[2], o_z, i_z)));
        const auto exit =
            hn::Min(hn::Min(hn::Set(d, end), at(ray.far_at[0], o_x, i_x)),
                    hn::Min(at(ray.far_at[1], o_y, i_y), at(ray.far_at[2], o_z, i_z)));
        const auto meets = hn::Le(entry, hn::Mul(exit, hn::Set(d, kFarSlack)));
        mask |= maskBits(d, meets) << i;
        if constexpr (kWithNear) {
            hn::Store(hn::IfThenElse(meets, entry, hn::Set(d, 3e38f)), d, near_t + i);
        }
    }
    return mask;
}

/// Without a loop over the mask, whose end no processor foresees.
HWY_INLINE int pushChildren(const BvhNode& node, uint32_t mask, uint32_t* stack, int size) {
    const hn::CappedTag<int32_t, kTreeWidth> d;
    const hn::Rebind<uint8_t, decltype(d)> d8;
    for (size_t i = 0; i < size_t(kTreeWidth); i += hn::Lanes(d)) {
        const uint32_t bits = mask >> i & ((1u << hn::Lanes(d)) - 1);
        const auto order = hn::PromoteTo(d, hn::LoadU(d8, kPackedLanes[bits].data()));
        const auto children = hn::Load(d, reinterpret_cast<const int32_t*>(node.child) + i);
        const auto packed = hn::TableLookupLanes(children, hn::IndicesFromVec(d, order));
        hn::StoreU(packed, d, reinterpret_cast<int32_t*>(stack) + size);
        size += std::popcount(bits);
    }
    return size;
}

HWY_INLINE int pushNearestLast(const BvhNode& node, uint32_t mask, const float* near_t,
                               uint32_t* stack, float* stack_t, int size) {
    if (mask == 0) {
        return size;
    }
    const Eight d;
    const hn::CappedTag<int32_t, kTreeWidth> di;
    const hn::Rebind<uint8_t, decltype(di)> d8;
    auto least = hn::Load(d, near_t);
    for (size_t i = hn::Lanes(d); i < size_t(kTreeWidth); i += hn::Lanes(d)) {
        least = hn::Min(least, hn::Load(d, near_t + i));
    }
    least = hn::MinOfLanes(d, least);
    uint32_t equal = 0;
    for (size_t i = 0; i < size_t(kTreeWidth); i += hn::Lanes(d)) {
        equal |= maskBits(d, hn::Eq(least, hn::Load(d, near_t + i))) << i;
    }
    const int nearest = std::countr_zero(equal & mask);
    const uint32_t others = mask & ~(1u << nearest);
    for (size_t i = 0; i < size_t(kTreeWidth); i += hn::Lanes(d)) {
        const uint32_t bits = others >> i & ((1u << hn::Lanes(d)) - 1);
        const auto order =
            hn::IndicesFromVec(di, hn::PromoteTo(di, hn::LoadU(d8, kPackedLanes[bits].data())));
        const auto children = hn::Load(di, reinterpret_cast<const int32_t*>(node.child) + i);
        hn::StoreU(hn::TableLookupLanes(children, order), di,
                   reinterpret_cast<int32_t*>(stack) + size);
        const auto t = hn::BitCast(di, hn::Load(d, near_t + i));
        hn::StoreU(hn::BitCast(d, hn::TableLookupLanes(t, order)), d, stack_t + size);
        size += std::popcount(bits);
    }
    stack_t[size] = near_t[nearest];
    stack[size++] = node.child[nearest];
    return size;
}

HWY_INLINE uint32_t blockMask(const TriangleBlock& block, const TraceRay& ray, float end,
                              BlockHits& hits) {
    const Eight d;
    const auto zero = hn::Zero(d);
    const auto o_x = hn::Set(d, ray.origin[ray.kx]), o_y = hn::Set(d, ray.origin[ray.ky]);
    const auto o_z = hn::Set(d, ray.origin[ray.kz]);
    const auto s_x = hn::Set(d, ray.sx), s_y = hn::Set(d, ray.sy), s_z = hn::Set(d, ray.sz);
    uint32_t mask = 0;
    for (size_t i = 0; i < size_t(kTreeWidth); i += hn::Lanes(d)) {
        const auto depth = [&](int c) HWY_ATTR {
            return hn::Sub(hn::Load(d, block.corner[c][ray.kz] + i), o_z);
        };
        const auto sheared = [&](int c, int k, auto o, auto s, auto z) HWY_ATTR {
            return hn::Sub(hn::Sub(hn::Load(d, block.corner[c][k] + i), o), hn::Mul(s, z));
        };
        const auto d0 = depth(0), d1 = depth(1), d2 = depth(2);
        const auto x0 = sheared(0, ray.kx, o_x, s_x, d0), y0 = sheared(0, ray.ky, o_y, s_y, d0);
        const auto x1 = sheared(1, ray.kx, o_x, s_x, d1), y1 = sheared(1, ray.ky, o_y, s_y, d1);
        const auto x2 = sheared(2, ray.kx, o_x, s_x, d2), y2 = sheared(2, ray.ky, o_y, s_y, d2);
        const auto u = hn::Sub(hn::Mul(x2, y1), hn::Mul(y2, x1));
        const auto v = hn::Sub(hn::Mul(x0, y2), hn::Mul(y0, x2));
        const auto w = hn::Sub(hn::Mul(x1, y0), hn::Mul(y1, x0));
        const auto least = hn::Min(hn::Min(u, v), w), most = hn::Max(hn::Max(u, v), w);
        const auto inside = hn::Or(hn::Ge(least, zero), hn::Le(most, zero));
        if (hn::AllFalse(d, inside)) {
            continue;
        }
        const auto det = hn::Add(hn::Add(u, v), w);
        const auto t = hn::Add(hn::Add(hn::Mul(u, hn::Mul(s_z, d0)), hn::Mul(v, hn::Mul(s_z, d1))),
                               hn::Mul(w, hn::Mul(s_z, d2)));
        const auto ahead = hn::IfThenElse(hn::Lt(det, zero), hn::Neg(t), t);
        const auto reached =
            hn::And(hn::Gt(ahead, zero), hn::Le(ahead, hn::Mul(hn::Set(d, end), hn::Abs(det))));
        const uint32_t bits = maskBits(d, hn::And(inside, reached));
        if (bits != 0) {
            hn::Store(div(t, det), d, hits.t + i);
            hn::Store(div(v, det), d, hits.b1 + i);
            hn::Store(div(w, det), d, hits.b2 + i);
            mask |= bits << i;
        }
    }
    return mask;
}

#include "rasterizer/internal/trace_walk-inl.h"

#include "rasterizer/internal/trace_packet-inl.h"

}  // namespace

TraceKernels traceHere() {
    return {occludedRays, occludedPackets, closestOfRays};
}

}  // namespace HWY_NAMESPACE
}  // namespace still::internal
HWY_AFTER_NAMESPACE();
