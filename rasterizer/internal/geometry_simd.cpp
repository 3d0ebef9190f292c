// Compiles the kernels of the vertex and triangle stages once per target and hands out the table
// for one of them.

#include "rasterizer/internal/geometry.h"

#if STILL_SIMD

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rasterizer/internal/geometry_simd.cpp"
#include <hwy/foreach_target.h>
// foreach_target must come before highway.h.
#include <hwy/highway.h>

#include "rasterizer/fixed.h"
#include "rasterizer/internal/dispatch.h"
#include "rasterizer/internal/packed_lanes.h"
#include "rasterizer/internal/triangles_reference.h"
#include "rasterizer/internal/vertex_reference.h"


// These rest on all of the above.
// clang-format off
#include "rasterizer/internal/lanes-inl.h"
#include "rasterizer/internal/vertex-inl.h"
#include "rasterizer/internal/triangles-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace still::internal {
namespace HWY_NAMESPACE {

const GeometryKernels* geometryTable() {
    static constexpr GeometryKernels kKernels{transformVertices, boundVertices, cullTriangles};
    return &kKernels;
}

}  // namespace HWY_NAMESPACE
}  // namespace still::internal
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace still::internal {

HWY_EXPORT(geometryTable);

const GeometryKernels& geometryFor(SimdTarget target) {
    return target == SimdTarget::scalar ? referenceGeometry()
                                        : *pickKernel(HWY_DISPATCH_TABLE(geometryTable), target)();
}

}  // namespace still::internal
#endif

#else

namespace still::internal {

const GeometryKernels& geometryFor(SimdTarget) {
    return referenceGeometry();
}

}  // namespace still::internal

#endif
