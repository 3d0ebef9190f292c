#include "demos/stillframe/bench_probe_kernels.h"

#if STILL_SIMD

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "demos/stillframe/bench_probe_kernels.cpp"
#include <hwy/foreach_target.h>
// foreach_target must come before highway.h.
#include <hwy/cache_control.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace still::command {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void copy(const uint8_t* from, uint8_t* to, size_t bytes) {
    const hn::ScalableTag<uint8_t> d;
    for (size_t i = 0; i < bytes; i += 4 * hn::Lanes(d)) {
        const auto a = hn::Load(d, from + i), b = hn::Load(d, from + i + hn::Lanes(d)),
                   c = hn::Load(d, from + i + 2 * hn::Lanes(d)),
                   e = hn::Load(d, from + i + 3 * hn::Lanes(d));
        hn::Store(a, d, to + i);
        hn::Store(b, d, to + i + hn::Lanes(d));
        hn::Store(c, d, to + i + 2 * hn::Lanes(d));
        hn::Store(e, d, to + i + 3 * hn::Lanes(d));
    }
}

void stream(const uint8_t* from, uint8_t* to, size_t bytes) {
    const hn::ScalableTag<uint8_t> d;
    for (size_t i = 0; i < bytes; i += hn::Lanes(d)) {
        hn::Stream(hn::Load(d, from + i), d, to + i);
    }
    hwy::FlushStream();
}

/// Applies `step` to kProbeChains vectors in turn.
template <class D, class Step, class T = hn::TFromD<D>>
double chains(D d, int rounds, T* sink, Step&& step) {
    // Chains that began alike would be one chain to the compiler.
    const auto start = hn::Load(d, sink);
    const auto one = hn::Set(d, T{1});
    auto v0 = start, v1 = hn::Add(v0, one), v2 = hn::Add(v1, one), v3 = hn::Add(v2, one),
         v4 = hn::Add(v3, one), v5 = hn::Add(v4, one), v6 = hn::Add(v5, one), v7 = hn::Add(v6, one),
         v8 = hn::Add(v7, one), v9 = hn::Add(v8, one), v10 = hn::Add(v9, one),
         v11 = hn::Add(v10, one);
    static_assert(kProbeChains == 12);
    for (int i = 0; i < rounds; ++i) {
        v0 = step(v0);
        v1 = step(v1);
        v2 = step(v2);
        v3 = step(v3);
        v4 = step(v4);
        v5 = step(v5);
        v6 = step(v6);
        v7 = step(v7);
        v8 = step(v8);
        v9 = step(v9);
        v10 = step(v10);
        v11 = step(v11);
    }
    const auto a = hn::Xor(hn::Xor(v0, v1), hn::Xor(v2, v3));
    const auto b = hn::Xor(hn::Xor(v4, v5), hn::Xor(v6, v7));
    const auto c = hn::Xor(hn::Xor(v8, v9), hn::Xor(v10, v11));
    hn::Store(hn::Xor(a, hn::Xor(b, c)), d, sink + 96);
    return double(rounds) * kProbeChains * double(hn::Lanes(d));
}

double mulHigh(int rounds, int16_t* sink) {
    const hn::ScalableTag<int16_t> d;
    const auto factor = hn::Load(d, sink + 64);
    return chains(d, rounds, sink, [&](auto v) HWY_ATTR { return hn::MulHigh(v, factor); });
}

double add(int rounds, int16_t* sink) {
    const hn::ScalableTag<int16_t> d;
    const auto term = hn::Load(d, sink + 64);
    return chains(d, rounds, sink, [&](auto v) HWY_ATTR { return hn::SaturatedAdd(v, term); });
}

double divide(int rounds, float* sink) {
    const hn::ScalableTag<float> d;
    const auto by = hn::Load(d, sink + 64);
    return chains(d, rounds, sink, [&](auto v) HWY_ATTR { return hn::Div(v, by); });
}

double gather(const int32_t* texels, int rounds, int32_t* sink) {
    const hn::ScalableTag<int32_t> d;
    const auto mask = hn::Set(d, kProbeTexels - 1), jump = hn::Set(d, 12347);
    auto at = hn::And(hn::Mul(hn::Iota(d, 1), jump), mask);
    auto sum = hn::Load(d, sink);
    for (int i = 0; i < rounds; ++i) {
        sum = hn::Add(sum, hn::GatherIndex(d, texels, at));
        at = hn::And(hn::Add(at, jump), mask);
    }
    hn::Store(sum, d, sink);
    return double(rounds) * double(hn::Lanes(d));
}

const ProbeKernels* kernelTable() {
    static constexpr ProbeKernels kKernels{copy, stream, mulHigh, add, divide, gather};
    return &kKernels;
}

}  // namespace HWY_NAMESPACE
}  // namespace still::command
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace still::command {

HWY_EXPORT(kernelTable);

const ProbeKernels& probeKernels() {
    return *HWY_DYNAMIC_DISPATCH(kernelTable)();
}

}  // namespace still::command
#endif

#else

#include <cstring>

namespace still::command {

const ProbeKernels& probeKernels() {
    static constexpr auto kCopy = [](const uint8_t* from, uint8_t* to, size_t bytes) {
        std::memcpy(to, from, bytes);
    };
    static constexpr auto kNothing = [](int, auto*) { return 0.0; };
    static constexpr ProbeKernels kKernels{
        kCopy,    kCopy,    kNothing,
        kNothing, kNothing, [](const int32_t*, int, int32_t*) { return 0.0; }};
    return kKernels;
}

}  // namespace still::command

#endif
