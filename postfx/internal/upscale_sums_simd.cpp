// Compiles the row kernels once per target and hands out those for a target.

#include "postfx/internal/upscale_sums_row.h"

#if STILL_SIMD

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "postfx/internal/upscale_sums_simd.cpp"
#include <hwy/foreach_target.h>
// foreach_target must come before highway.h.
#include <hwy/highway.h>

#include <array>

#include "rasterizer/internal/dispatch.h"

#ifndef STILL_UPSCALE_ROW_RECIPROCALS
#define STILL_UPSCALE_ROW_RECIPROCALS
namespace still::upscale {

/// floor(2^32 / n) + 1: sums of up to 255 samples divided by their number are exact with it, for
/// 255 · (255 · 65535 + 127) < 2^32. 0 and 1 are not asked for.
constexpr std::array<uint32_t, 256> makeRowReciprocals() {
    std::array<uint32_t, 256> table{};
    for (size_t n = 2; n < table.size(); ++n) {
        table[n] = uint32_t((uint64_t{1} << 32) / n + 1);
    }
    return table;
}
inline constexpr auto kRowReciprocals = makeRowReciprocals();

}  // namespace still::upscale
#endif

// Highway's one-lane target is never asked for: there are no lanes.
#if HWY_TARGET != HWY_SCALAR
#include "postfx/internal/upscale_sums-inl.h"
#endif

HWY_BEFORE_NAMESPACE();
namespace still::upscale {
namespace HWY_NAMESPACE {

SumKernels kernelsHere() {
#if HWY_TARGET == HWY_SCALAR
    return {};
#else
    return {sumRow, ageRow};
#endif
}

}  // namespace HWY_NAMESPACE
}  // namespace still::upscale
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace still::upscale {

HWY_EXPORT(kernelsHere);

SumKernels sumKernels(SimdTarget target) {
    return target == SimdTarget::scalar
               ? SumKernels{}
               : internal::pickKernel(HWY_DISPATCH_TABLE(kernelsHere), target)();
}

}  // namespace still::upscale
#endif

#else

namespace still::upscale {

SumKernels sumKernels(SimdTarget) {
    return {};
}

}  // namespace still::upscale

#endif
