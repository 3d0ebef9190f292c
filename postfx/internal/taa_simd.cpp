// Compiles the SIMD kernels once per target and hands out those for a target.

#include "postfx/internal/kernels.h"
#include "postfx/internal/upscale_gather.h"

#if STILL_SIMD

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "postfx/internal/taa_simd.cpp"
#include <hwy/foreach_target.h>
// foreach_target must come before highway.h.
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <type_traits>

#include "postfx/internal/rules.h"
#include "postfx/internal/upscale_rules.h"
#include "rasterizer/internal/dispatch.h"

// Each rests on those before. Highway's one-lane target lacks shuffles and is never asked for: the
// reference kernels stand in.
#if HWY_TARGET != HWY_SCALAR
// clang-format off
#include "postfx/internal/taa_lanes-inl.h"
#include "postfx/internal/half_lanes-inl.h"
#include "postfx/internal/record-inl.h"
#include "postfx/internal/accumulate-inl.h"
#include "postfx/internal/gather_fetch-inl.h"
#include "postfx/internal/gather_layers-inl.h"
#include "postfx/internal/gather_fit-inl.h"
#include "postfx/internal/gather-inl.h"
#include "postfx/internal/upscale_fetch-inl.h"
#include "postfx/internal/upscale_fit-inl.h"
#include "postfx/internal/upscale-inl.h"
// clang-format on
#endif

HWY_BEFORE_NAMESPACE();
namespace still::taa {
namespace HWY_NAMESPACE {

TileKernels kernelsHere() {
#if HWY_TARGET == HWY_SCALAR
    return {};
#else
    return {recordTile, accumulateTile, gatherTile};
#endif
}

upscale::GatherKernel upscaleHere() {
#if HWY_TARGET == HWY_SCALAR
    return upscale::gatherTileReference;
#else
    return upscaleTile;
#endif
}

}  // namespace HWY_NAMESPACE
}  // namespace still::taa
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace still::taa {

HWY_EXPORT(kernelsHere);

TileKernels tileKernels(SimdTarget target) {
    return target == SimdTarget::scalar
               ? TileKernels{}
               : internal::pickKernel(HWY_DISPATCH_TABLE(kernelsHere), target)();
}

HWY_EXPORT(upscaleHere);

upscale::GatherKernel upscaleKernel(SimdTarget target) {
    return target == SimdTarget::scalar
               ? upscale::gatherTileReference
               : internal::pickKernel(HWY_DISPATCH_TABLE(upscaleHere), target)();
}

}  // namespace still::taa
#endif

#else

namespace still::taa {

TileKernels tileKernels(SimdTarget) {
    return {};
}

upscale::GatherKernel upscaleKernel(SimdTarget) {
    return upscale::gatherTileReference;
}

}  // namespace still::taa

#endif
