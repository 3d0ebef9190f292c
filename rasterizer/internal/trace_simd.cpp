// Compiles the tracing kernels once per target and hands out those for one of them.

#include "rasterizer/internal/trace.h"

#if STILL_SIMD

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rasterizer/internal/trace_simd.cpp"
#include <hwy/foreach_target.h>
// foreach_target must come before highway.h.
#include <hwy/highway.h>

#include <bit>

#include "rasterizer/internal/dispatch.h"
#include "rasterizer/internal/packed_lanes.h"

// Highway's one-lane target is never asked for: the reference kernels stand in.
#if HWY_TARGET == HWY_SCALAR
HWY_BEFORE_NAMESPACE();
namespace still::internal {
namespace HWY_NAMESPACE {
TraceKernels traceHere() {
    return traceReference();
}
}  // namespace HWY_NAMESPACE
}  // namespace still::internal
HWY_AFTER_NAMESPACE();
#else
#include "rasterizer/internal/lanes-inl.h"
// The others build on it.
#include "rasterizer/internal/trace-inl.h"
#endif

#if HWY_ONCE
namespace still::internal {

HWY_EXPORT(traceHere);

TraceKernels traceFor(SimdTarget target) {
    return target == SimdTarget::scalar ? traceReference()
                                        : pickKernel(HWY_DISPATCH_TABLE(traceHere), target)();
}

}  // namespace still::internal
#endif

#else

namespace still::internal {

TraceKernels traceFor(SimdTarget) {
    return traceReference();
}

}  // namespace still::internal

#endif
