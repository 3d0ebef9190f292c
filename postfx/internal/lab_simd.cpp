// Compiles the laboratory's SIMD kernels once per target and hands out the one for a target and a
// policy: eight presets and the generic kernel.

#include "postfx/internal/lab_kernels.h"
#include "postfx/internal/lab_presets.h"

#if STILL_SIMD

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "postfx/internal/lab_simd.cpp"
#include <hwy/foreach_target.h>
// foreach_target must come before highway.h.
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <utility>

#include "postfx/internal/lab_rules.h"
#include "rasterizer/internal/dispatch.h"

// Sanitizers instrument every inlined operation, and a kernel in one piece would take minutes to
// compile. With them, its phases are functions of their own, and presets, which run the same lines,
// are left to the generic kernel.
#ifndef STILL_LAB_PHASE
#if HWY_IS_ASAN || HWY_IS_TSAN
#define STILL_LAB_PHASE HWY_NOINLINE HWY_ATTR
namespace still::lab {
constexpr size_t kCompiledPresets = 0;
}
#else
#define STILL_LAB_PHASE HWY_INLINE
namespace still::lab {
constexpr size_t kCompiledPresets = kRecipes.size();
}
#endif
#endif

// Each rests on those before. Highway's one-lane target lacks shuffles and is never asked for: the
// reference kernel stands in.
#if HWY_TARGET != HWY_SCALAR
// clang-format off
#include "postfx/internal/lab_lanes-inl.h"
#include "postfx/internal/lab_window-inl.h"
#include "postfx/internal/lab_history-inl.h"
#include "postfx/internal/lab_resolve-inl.h"
// clang-format on
#else
namespace still::lab::HWY_NAMESPACE {
TileKernel kernelHere(const TaaPolicy&) {
    return resolveTileReference;
}
}  // namespace still::lab::HWY_NAMESPACE
#endif

#if HWY_ONCE
namespace still::lab {

HWY_EXPORT(kernelHere);

TileKernel tileKernel(SimdTarget target, const TaaPolicy& policy) {
    return target == SimdTarget::scalar
               ? resolveTileReference
               : internal::pickKernel(HWY_DISPATCH_TABLE(kernelHere), target)(policy);
}

}  // namespace still::lab
#endif

#else

namespace still::lab {

TileKernel tileKernel(SimdTarget, const TaaPolicy&) {
    return resolveTileReference;
}

}  // namespace still::lab

#endif
