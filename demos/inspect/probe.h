#pragma once
// Draws single samples of a film's frames, beside the frame loops and without changing them: for
// views of the G-buffer, for overlays, and for supersampled pictures that grow.

#include <memory>

#include "demos/inspect/film.h"
#include "engine/jitter.h"
#include "rasterizer/light_sampler.h"
#include "rasterizer/rasterizer.h"

namespace still::inspect {

struct ProbeSample {
    SampleOffset offset{};  ///< from the pixels' centres
    uint32_t sample = 0;    ///< as FrameView::sample
    PlaneSet planes{};
    int mip_bias_fx8 = 0;
    bool camera_motion_only = false;
    bool lit = true;  ///< with the light that is sampled, of scenes that have some
};

class Probe {
  public:
    Probe(const Film& film, SimdTarget simd, Workers& workers)
        : film_(film), simd_(simd), workers_(workers) {}

    /// The film has another scene.
    void forgetScene() { sampler_.reset(); }
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
    void addLight(const DrawList& list, const FrameView& view);

    Rasterizer rasterizer_;
    std::unique_ptr<LightSampler> sampler_;  ///< made when light is sampled
    LightImages light_;
    GBuffer gbuffer_;
    Image<uint16_t> overdraw_;
};

}  // namespace still::inspect
