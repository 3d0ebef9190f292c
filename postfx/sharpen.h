#pragma once
// Sharpening after the resolve. Idea: AMD FidelityFX "robust contrast adaptive sharpening" (RCAS):
// a negative lobe over the four neighbours, limited so that nothing overshoots them. Integer only.

#include <cstdint>

#include "postfx/colour_targets.h"
#include "postfx/taa.h"
#include "rasterizer/simd.h"
#include "rasterizer/workers.h"

namespace still {

/// Strongest sharpness: the neighbours' weight is −3/16 each before normalisation, RCAS's limit.
constexpr int kFullSharpness_q15 = 1 << 15;

/// Each channel moves away from the mean of its four neighbours, as far as the smallest and the
/// largest of the five pixels allow. `sharpness_q15` 0 (a copy) … kFullSharpness_q15. Where
/// `confidence` is 0 nothing is sharpened, 255 is full, linear between; an empty view is full
/// everywhere. `out` does not overlap `in`; all sizes are equal and rows are padded as in Image.
void sharpen(const ColourPlanes& in, ImageView<const uint8_t> confidence, int sharpness_q15,
             const ColourTargets& out, SimdTarget simd, Workers& workers);

}  // namespace still
