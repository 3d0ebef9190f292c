#pragma once
// Anti-aliasing of a single frame, one sample per pixel: for frames and pixels without history, and
// as the baseline that temporal methods have to beat. Integer only. Flow and figures:
// postfx/README.md, "Spatial filter".

#include <cstdint>

#include "postfx/colour_targets.h"
#include "postfx/taa.h"
#include "rasterizer/gbuffer.h"
#include "rasterizer/image.h"
#include "rasterizer/simd.h"
#include "rasterizer/workers.h"

namespace still {

/// What the filter reads of a frame. All planes have the same size.
struct SpatialInput {
    ColourPlanes colour;
    ImageView<const uint16_t> id;      ///< as in GBuffer; only the surface counts
    ImageView<const uint32_t> normal;  ///< as in GBuffer; empty: creases are not seen
    /// Where the samples lie, from the pixels' centres, −128 … 127. The filter answers for the
    /// pixels, not for the samples: it also takes the offset out.
    int jitter_x_fx8 = 0, jitter_y_fx8 = 0;
};

/// The planes of a G-buffer; valid as long as they are.
SpatialInput spatialInput(const GBuffer& gbuffer, int jitter_x_fx8, int jitter_y_fx8);

enum class SpatialEdges : uint8_t {
    /// FXAA-class: edges are contrasts of brightness. Reads colour only and leaves the sample
    /// offset in.
    colour,
    /// Edges are borders between surfaces and creases, known exactly. Within surfaces the samples
    /// are resampled at the pixels' centres.
    geometry,
};

struct SpatialSettings {
    SpatialEdges edges = SpatialEdges::geometry;
    SimdTarget simd = bestSimdTarget();
};

/// Filters whole frames; keeps its buffer from frame to frame.
class SpatialFilter {
  public:
    /// Makes the buffer; else the first run() does.
    void reserve(int width, int height) { marks_.resize(width, height); }

    /// Writes every pixel of `out`, which has the input's size and does not overlap its planes. The
    /// planes have padded rows and may be read a row's padding beyond their ends (see Image).
    void run(const SpatialInput& input, const SpatialSettings& settings, const ColourTargets& out,
             Workers& workers);

  private:
    Image<uint8_t> marks_;  ///< geometry: edges; colour: brightness
};

/// One pixel of SpatialEdges::geometry, the same value that SpatialFilter::run() writes.
/// Reads up to 34 pixels around (x, y) along rows and columns.
void spatialPixel(const SpatialInput& input, int x, int y, int rgb[3]);

}  // namespace still
