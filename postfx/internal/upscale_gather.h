#pragma once
// An output pixel from the raw samples that fell near it during the last frames.

#include "postfx/internal/upscale_job.h"
#include "rasterizer/simd.h"

namespace still::upscale {

/// The output pixels of a frame's tile, except those that the sums have shown already. Every
/// slot's record is complete.
void gatherTileReference(const Job& job, const TileRect& tile, bool sums_valid) noexcept;

using GatherKernel = void (*)(const Job&, const TileRect&, bool sums_valid) noexcept;

}  // namespace still::upscale

namespace still::taa {

/// The kernel for a target that availableSimdTargets() lists, which equals the reference. All slots
/// must have the frame's size and stand in Job::frame, too.
upscale::GatherKernel upscaleKernel(SimdTarget target);

}  // namespace still::taa
