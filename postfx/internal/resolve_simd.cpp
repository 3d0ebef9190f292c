// Compiles the SIMD kernel once per target and hands out the one for a target.

#include "postfx/internal/resolve.h"

#if STILL_SIMD

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "postfx/internal/resolve_simd.cpp"
#include <hwy/foreach_target.h>
// foreach_target must come before highway.h.
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "postfx/internal/rules.h"
#include "rasterizer/internal/dispatch.h"

// Each rests on those before. Highway's one-lane target lacks shuffles and is never asked for: the
// reference kernel stands in.
#if HWY_TARGET != HWY_SCALAR
// clang-format off
#include "postfx/internal/lanes-inl.h"
#include "postfx/internal/owner-inl.h"
#include "postfx/internal/sums-inl.h"
#include "postfx/internal/still-inl.h"
#include "postfx/internal/resolve-inl.h"
// clang-format on
#endif

HWY_BEFORE_NAMESPACE();
namespace still::taa {
namespace HWY_NAMESPACE {

TileKernel kernelHere() {
#if HWY_TARGET == HWY_SCALAR
    return resolveTileReference;
#else
    return resolveTile;
#endif
}

}  // namespace HWY_NAMESPACE
}  // namespace still::taa
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace still::taa {

HWY_EXPORT(kernelHere);

TileKernel tileKernel(SimdTarget target) {
    return target == SimdTarget::scalar
               ? resolveTileReference
               : internal::pickKernel(HWY_DISPATCH_TABLE(kernelHere), target)();
}

}  // namespace still::taa
#endif

#else

namespace still::taa {

TileKernel tileKernel(SimdTarget) {
    return resolveTileReference;
}

}  // namespace still::taa

#endif
