#pragma once
// The denoiser's kernels, in the order in which a frame runs them.

#include "postfx/internal/denoise_job.h"

namespace still::denoising {

/// Fills Job::now.surface, depth and normal, and Job::step.
void guidesReference(const Job& job, const TileRect& tile) noexcept;
/// Blends this frame's samples with the past: Job::now, Job::first.light, Job::light_age.
void blendReference(const Job& job, const TileRect& tile) noexcept;
void blendPixel(const Job& job, int x, int y) noexcept;
/// How uncertain the means are: Job::first.variance.
void varianceReference(const Job& job, const TileRect& tile) noexcept;
/// One pass of the filter over the `parts`, a bit for each.
void filterReference(const Job& job, const FilterPlanes& in, const FilterPlanes& out, int pass,
                     int parts, const TileRect& tile) noexcept;

struct Kernels {
    void (*guides)(const Job&, const TileRect&) noexcept = guidesReference;
    void (*blend)(const Job&, const TileRect&) noexcept = blendReference;
    void (*variance)(const Job&, const TileRect&) noexcept = varianceReference;
    void (*filter)(const Job&, const FilterPlanes&, const FilterPlanes&, int pass, int parts,
                   const TileRect&) noexcept = filterReference;
};
Kernels kernels(SimdTarget target);

}  // namespace still::denoising
