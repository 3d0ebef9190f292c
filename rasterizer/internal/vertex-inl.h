// Vertex stage, one vertex per lane; see vertex_reference.cpp for the truth.
// Included once per target by geometry_simd.cpp.

HWY_BEFORE_NAMESPACE();
namespace still::internal {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D, class V = hn::Vec<D>>
V transformRow(D d, const float m[4], V x, V y, V z) {
    return hn::Add(hn::Add(hn::Mul(hn::Set(d, m[0]), x), hn::Mul(hn::Set(d, m[1]), y)),
                   hn::Add(hn::Mul(hn::Set(d, m[2]), z), hn::Set(d, m[3])));
}

template <class D>
void transformGroup(D d, const VertexJob& job, int i) {
    const hn::RebindToSigned<D> di;
    using V = hn::Vec<D>;
    const V px = hn::LoadU(d, job.x + i);
    const V py = hn::LoadU(d, job.y + i);
    const V pz = hn::LoadU(d, job.z + i);
    const V x = transformRow(d, job.clip.m[0], px, py, pz);
    const V y = transformRow(d, job.clip.m[1], px, py, pz);
    const V z = transformRow(d, job.clip.m[2], px, py, pz);
    const V w = transformRow(d, job.clip.m[3], px, py, pz);

    const V zero = hn::Zero(d);
    // v − v is 0 for finite v and NaN otherwise.
    const V spread =
        hn::Add(hn::Add(hn::Sub(x, x), hn::Sub(y, y)), hn::Add(hn::Sub(z, z), hn::Sub(w, w)));
    const auto finite = hn::Eq(spread, zero);
    const V fx = hn::Mul(hn::Set(d, job.frustum_x), w);
    const V fy = hn::Mul(hn::Set(d, job.frustum_y), w);
    const auto near_ok = hn::And(hn::Le(z, w), hn::Gt(w, hn::Set(d, 1e-20f)));
    const auto ok_div = hn::And(near_ok, finite);

    const V r = div(hn::Set(d, 1.0f), hn::IfThenElse(ok_div, w, hn::Set(d, 1.0f)));
    const V sx = hn::Mul(hn::Mul(x, r), hn::Set(d, job.scale_x_fx8));
    const V sy = hn::Mul(hn::Mul(y, r), hn::Set(d, job.scale_y_fx8));
    const V guard = hn::Set(d, job.guard_fx8);
    const auto guard_ok = hn::And(hn::Le(hn::Abs(sx), guard), hn::Le(hn::Abs(sy), guard));
    const auto valid = hn::And(ok_div, guard_ok);

    const auto bit = [&](auto mask, int value) {
        return hn::IfThenElseZero(hn::RebindMask(di, mask), hn::Set(di, value));
    };
    auto code = bit(hn::Not(near_ok), kOutNear);
    code = hn::Or(code, bit(hn::Lt(x, hn::Neg(fx)), kOutLeft));
    code = hn::Or(code, bit(hn::Gt(x, fx), kOutRight));
    code = hn::Or(code, bit(hn::Gt(y, fy), kOutTop));
    code = hn::Or(code, bit(hn::Lt(y, hn::Neg(fy)), kOutBottom));
    code = hn::Or(code, bit(hn::Lt(z, zero), kOutFar));
    code = hn::Or(code, bit(hn::And(ok_div, hn::Not(guard_ok)), kOutGuard));
    code = hn::IfThenElse(hn::RebindMask(di, finite), code, hn::Set(di, int32_t{kOutInvalid}));

    // Where there is no position, x says so and y says why.
    const auto valid_i = hn::RebindMask(di, valid);
    const auto x_fx8 =
        hn::Add(roundLanes(d, hn::IfThenElseZero(valid, sx)), hn::Set(di, job.centre_x_fx8));
    const auto y_fx8 =
        hn::Add(roundLanes(d, hn::IfThenElseZero(valid, sy)), hn::Set(di, job.centre_y_fx8));
    const auto x_word = hn::IfThenElse(valid_i, x_fx8, hn::Set(di, kNoPosition));
    const auto y_word = hn::IfThenElse(valid_i, y_fx8, code);
    hn::StoreInterleaved4(x_word, y_word, hn::BitCast(di, hn::IfThenElseZero(valid, hn::Mul(z, r))),
                          hn::BitCast(di, hn::IfThenElseZero(valid, r)), di,
                          reinterpret_cast<int32_t*>(job.out + i));
}

void transformVertices(const VertexJob& job, int begin, int end) {
    const hn::CappedTag<float, 16> d;
    const int lanes = int(hn::Lanes(d));
    int i = begin;
    for (; i + lanes <= end; i += lanes) {
        transformGroup(d, job, i);
    }
    for (; i < end; ++i) {
        job.out[i] = projectVertex(job, transformVertex(job.clip, job.x[i], job.y[i], job.z[i]));
    }
}

PositionBox boundVertices(const float* x, const float* y, const float* z, size_t count) {
    const hn::CappedTag<float, 16> d;
    const size_t lanes = hn::Lanes(d);
    if (count < lanes) {
        return boundVerticesReference(x, y, z, count);
    }
    PositionBox box;
    const float* const axes[3] = {x, y, z};
    for (int axis = 0; axis < 3; ++axis) {
        auto low = hn::LoadU(d, axes[axis] + count - lanes);  // the rest after whole vectors, too
        auto high = low;
        for (size_t i = 0; i + lanes <= count; i += lanes) {
            const auto v = hn::LoadU(d, axes[axis] + i);
            low = hn::Min(low, v);
            high = hn::Max(high, v);
        }
        box.low[axis] = hn::GetLane(hn::MinOfLanes(d, low));
        box.high[axis] = hn::GetLane(hn::MaxOfLanes(d, high));
    }
    return box;
}

}  // namespace HWY_NAMESPACE
}  // namespace still::internal
HWY_AFTER_NAMESPACE();
