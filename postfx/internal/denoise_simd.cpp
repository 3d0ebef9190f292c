// Compiles the kernels once per target and hands out those for a target.

#include "postfx/internal/denoise_kernels.h"
#include "postfx/internal/denoise_rules.h"

#if STILL_SIMD

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "postfx/internal/denoise_simd.cpp"
#include <hwy/foreach_target.h>
// foreach_target must come before highway.h.
#include <hwy/highway.h>

#include "rasterizer/internal/dispatch.h"

// Highway's one-lane target is never asked for: the reference kernels stand in.
#if HWY_TARGET != HWY_SCALAR
#include "rasterizer/internal/lanes-inl.h"
// The others build on it.
#include "postfx/internal/denoise_lanes-inl.h"
// The others build on both.
#include "postfx/internal/denoise_blend-inl.h"
#include "postfx/internal/denoise_filter-inl.h"
#endif

HWY_BEFORE_NAMESPACE();
namespace still::denoising {
namespace HWY_NAMESPACE {

Kernels kernelsHere() {
#if HWY_TARGET == HWY_SCALAR
    return {};
#else
    return {guidesTile, blendTile, varianceTile, filterTile};
#endif
}

}  // namespace HWY_NAMESPACE
}  // namespace still::denoising
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace still::denoising {

HWY_EXPORT(kernelsHere);

Kernels kernels(SimdTarget target) {
    return target == SimdTarget::scalar
               ? Kernels{}
               : internal::pickKernel(HWY_DISPATCH_TABLE(kernelsHere), target)();
}

}  // namespace still::denoising
#endif

#else

namespace still::denoising {

Kernels kernels(SimdTarget) {
    return {};
}

}  // namespace still::denoising

#endif
