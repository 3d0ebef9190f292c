#pragma once
// Enlarges a finished picture, without history: the baselines that temporal upscaling
// (postfx/upscale.h) has to beat. Formulas: internal/spatial_upscale_kernel.h.

#include <cstdint>

#include "postfx/colour_targets.h"
#include "postfx/taa.h"
#include "rasterizer/image.h"
#include "rasterizer/simd.h"
#include "rasterizer/workers.h"

namespace still {

enum class EnlargeFilter : uint8_t {
    bicubic,  ///< Catmull-Rom
    /// Along the edges that brightness shows, within the nearest four pixels' range: after EASU of
    /// AMD's FSR 1 (L. Kramer, "FidelityFX Super Resolution", 2021).
    edge,
};

/// Both filters work on square roots of light, about as eyes and 8-bit pictures see it: that is
/// nearer to the truth there, and light sources do not ring. Strict IEEE floats. Keeps its buffers
/// from frame to frame.
class SpatialUpscaler {
  public:
    /// Writes every pixel of `out`, whose size is any of the input's or more, up to kMaxTargetSize
    /// per axis. Both show the same view: outer edges coincide. Rows of `out` are padded.
    void run(const ColourPlanes& in, EnlargeFilter filter, const ColourTargets& out,
             SimdTarget simd, Workers& workers);

  private:
    Image<float> roots_[4];     ///< red, green, blue; brightness for `edge`; with a border
    Image<float> column_part_;  ///< of each output column: where it lies between two of the input's
    Image<int32_t> column_;     ///< and the left one of them
};

}  // namespace still
