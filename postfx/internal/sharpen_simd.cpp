// Compiles the row kernel once per target and hands out the one for a target.

#include "postfx/internal/sharpen_kernel.h"

#if STILL_SIMD

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "postfx/internal/sharpen_simd.cpp"
#include <hwy/foreach_target.h>
// foreach_target must come before highway.h.
#include <hwy/highway.h>

#include "rasterizer/internal/dispatch.h"

// Highway's one-lane target is never asked for: the reference kernel stands in.
#if HWY_TARGET != HWY_SCALAR
#include "postfx/internal/sharpen-inl.h"
#endif

HWY_BEFORE_NAMESPACE();
namespace still::sharpening {
namespace HWY_NAMESPACE {

RowKernel kernelHere() {
#if HWY_TARGET == HWY_SCALAR
    return sharpenRowReference;
#else
    return sharpenRow;
#endif
}

}  // namespace HWY_NAMESPACE
}  // namespace still::sharpening
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace still::sharpening {

HWY_EXPORT(kernelHere);

RowKernel rowKernel(SimdTarget target) {
    return target == SimdTarget::scalar
               ? sharpenRowReference
               : internal::pickKernel(HWY_DISPATCH_TABLE(kernelHere), target)();
}

}  // namespace still::sharpening
#endif

#else

namespace still::sharpening {

RowKernel rowKernel(SimdTarget) {
    return sharpenRowReference;
}

}  // namespace still::sharpening

#endif
