// Compiles the SIMD kernels once per target and hands out the table for one of them.

#include "rasterizer/internal/kernels.h"

#if STILL_SIMD

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rasterizer/internal/kernels_simd.cpp"
#include <hwy/foreach_target.h>
// foreach_target must come before highway.h.
#include <hwy/highway.h>

#include <bit>
#include <cstddef>
#include <cstring>

#include "rasterizer/fixed.h"
#include "rasterizer/internal/dispatch.h"
#include "rasterizer/internal/shade_setup.h"
#include "rasterizer/internal/shading_constants.h"
#include "rasterizer/internal/tile.h"
#include "rasterizer/internal/triangle_setup.h"

// In pipeline order: each rests on those before.
// clang-format off
#include "rasterizer/internal/lanes-inl.h"
#include "rasterizer/internal/surface-inl.h"
#include "rasterizer/internal/sampler-inl.h"
#include "rasterizer/internal/parallax-inl.h"
#include "rasterizer/internal/alpha-inl.h"
#include "rasterizer/internal/light-inl.h"
#include "rasterizer/internal/shade-inl.h"
#include "rasterizer/internal/cover-inl.h"
#include "rasterizer/internal/visibility-inl.h"
#include "rasterizer/internal/shade_setup-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace still::internal {
namespace HWY_NAMESPACE {

const RasterKernels* kernelTable() {
    static constexpr RasterKernels kKernels{rasterizeTile, prepareShading, shading::shadeTile};
    return &kKernels;
}

}  // namespace HWY_NAMESPACE
}  // namespace still::internal
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace still::internal {

HWY_EXPORT(kernelTable);

const RasterKernels& kernelsFor(SimdTarget target) {
    return target == SimdTarget::scalar ? referenceKernels()
                                        : *pickKernel(HWY_DISPATCH_TABLE(kernelTable), target)();
}

}  // namespace still::internal
#endif

#else

namespace still::internal {

const RasterKernels& kernelsFor(SimdTarget) {
    return referenceKernels();
}

}  // namespace still::internal

#endif
