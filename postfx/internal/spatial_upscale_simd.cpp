// Compiles the row kernels once per target and hands out those for a target.

#include "postfx/internal/spatial_upscale_kernel.h"

#if STILL_SIMD

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "postfx/internal/spatial_upscale_simd.cpp"
#include <hwy/foreach_target.h>
// foreach_target must come before highway.h.
#include <hwy/highway.h>

#include "rasterizer/internal/dispatch.h"

// Highway's one-lane target is never asked for: the reference kernels stand in.
#if HWY_TARGET != HWY_SCALAR
#include "rasterizer/internal/lanes-inl.h"
// The other builds on it.
#include "postfx/internal/spatial_upscale-inl.h"
#endif

HWY_BEFORE_NAMESPACE();
namespace still::enlarging {
namespace HWY_NAMESPACE {

RowKernels kernelsHere() {
#if HWY_TARGET == HWY_SCALAR
    return referenceKernels();
#else
    return {bicubicRow, edgeRow};
#endif
}

}  // namespace HWY_NAMESPACE
}  // namespace still::enlarging
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace still::enlarging {

HWY_EXPORT(kernelsHere);

RowKernels rowKernels(SimdTarget target) {
    return target == SimdTarget::scalar
               ? referenceKernels()
               : internal::pickKernel(HWY_DISPATCH_TABLE(kernelsHere), target)();
}

}  // namespace still::enlarging
#endif

#else

namespace still::enlarging {

RowKernels rowKernels(SimdTarget) {
    return referenceKernels();
}

}  // namespace still::enlarging

#endif
