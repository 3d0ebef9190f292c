#pragma once
// The denoiser's kernels, in the order in which a frame runs them.

#include "postfx/internal/denoise_job.h"

namespace still::denoising {

/// Fills Job::now.surface, depth and normal.
void guidesReference(const Job& job, const TileRect& tile) noexcept;
/// Blends this frame's samples with the past: Job::now, Job::first.light.
void blendReference(const Job& job, const TileRect& tile) noexcept;
/// How uncertain the means are: Job::first.variance.
void varianceReference(const Job& job, const TileRect& tile) noexcept;
/// One pass of the filter.
void filterReference(const Job& job, const FilterPlanes& in, const FilterPlanes& out, int pass,
                     const TileRect& tile) noexcept;

}  // namespace still::denoising
