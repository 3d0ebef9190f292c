// Compiles the kernels of the vertex and triangle stages once per target and hands out the table
// for one of them.

#include "rasterizer/internal/geometry.h"

#if STILL_SIMD

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rasterizer/internal/geometry_simd.cpp"
#include <hwy/foreach_target.h>
// foreach_target must come before highway.h.
#include <hwy/highway.h>

#include <array>

#include "rasterizer/fixed.h"
#include "rasterizer/internal/dispatch.h"
#include "rasterizer/internal/triangles_reference.h"
#include "rasterizer/internal/vertex_reference.h"

#ifndef STILL_PACKED_LANES  // once, not per target
#define STILL_PACKED_LANES
namespace still::internal {

/// For each set of up to 8 lanes their numbers in order.
constexpr std::array<std::array<uint8_t, 8>, 256> kPackedLanes = [] {
    std::array<std::array<uint8_t, 8>, 256> table{};
    for (size_t set = 0; set < table.size(); ++set) {
        size_t count = 0;
        for (uint8_t lane = 0; lane < 8; ++lane) {
            if ((set >> lane & 1) != 0) {
                table[set][count++] = lane;
            }
        }
    }
    return table;
}();

}  // namespace still::internal
#endif

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
