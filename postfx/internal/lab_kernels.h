#pragma once
// Kernels that resolve one tile. The scalar one defines the result; the SIMD ones equal it bit for
// bit.

#include "postfx/internal/lab_job.h"
#include "rasterizer/simd.h"

namespace still::lab {

void resolveTileReference(const ResolveJob& job, const TileRect& tile) noexcept;

/// Repeats the border's colours in the margin of history, as far as the tile touches the border.
void fillMargin(const ResolveJob& job, const TileRect& tile) noexcept;

/// The kernel for a target that availableSimdTargets() lists: the one compiled for the policy, if
/// there is one, else the one that reads it at run time.
TileKernel tileKernel(SimdTarget target, const TaaPolicy& policy);

}  // namespace still::lab
