#pragma once
// Draws single samples of a film's frames, beside the frame loops and without changing them: for
// views of the G-buffer, for overlays, and for supersampled pictures that grow.

#include "demos/inspect/film.h"
#include "engine/jitter.h"
#include "rasterizer/rasterizer.h"

namespace still::inspect {

struct ProbeSample {
    SampleOffset offset{};  ///< from the pixels' centres
    uint32_t sample = 0;    ///< as FrameView::sample
    PlaneSet planes{};
    int mip_bias_fx8 = 0;
    bool camera_motion_only = false;
};

class Probe {
  public:
    Probe(const Film& film, SimdTarget simd, Workers& workers)
        : film_(film), simd_(simd), workers_(workers) {}

    /// The G-buffer stays until the next call.
    const GBuffer& draw(int frame, int width, int height, const ProbeSample& sample);
    const GBuffer& gbuffer() const { return gbuffer_; }
    /// Triangles at each sample drawn last.
    ImageView<const uint16_t> overdraw();
    const RasterCounters& counters() const { return rasterizer_.counters(); }

  private:
    const Film& film_;
    SimdTarget simd_;
    Workers& workers_;
    Rasterizer rasterizer_;
    GBuffer gbuffer_;
    Image<uint16_t> overdraw_;
};

}  // namespace still::inspect
