#pragma once
// Denoised light for frames that are smaller than the picture.

#include "postfx/denoise.h"
#include "rasterizer/light_sampler.h"

namespace still {

/// Denoised light is that of pixels' centres, while the samples it falls on lie beside them; where
/// samples of a pixel go to several of the picture's, shadows would be stairs of the frame's
/// pixels. Writes light at the samples' places: bilinear between neighbouring pixels of the same
/// surface with about the same normal. Needs the G-buffer's normal plane; `out` gets its size.
void placeLight(const GBuffer& gbuffer, const LightPlanes& light, int jitter_x_fx8,
                int jitter_y_fx8, LightImages& out, Workers& workers);

}  // namespace still
