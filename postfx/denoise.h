#pragma once
// Light of one random sample a pixel and frame in, clean light out: variance-guided filtering over
// time and space. Flow, formats and sources: postfx/README.md, "Denoiser".

#include <cstdint>
#include <memory>

#include "postfx/colour_targets.h"
#include "postfx/taa.h"
#include "rasterizer/gbuffer.h"
#include "rasterizer/light_sampler.h"
#include "rasterizer/simd.h"
#include "rasterizer/workers.h"

namespace still {

/// Light that falls onto the surfaces, before it is multiplied by their albedo; fx12, of the
/// G-buffer's size, in two parts that are filtered apart.
struct LightPlanes {
    ColourPlanes direct;    ///< from lamps and sun
    ColourPlanes indirect;  ///< ambient, or what other surfaces reflect
};

/// One sample in each block of kLightBlock² pixels of the *previous* frame: luminance (fx12) that
/// it saw then, and luminance that the very same sample sees in this frame's scene. Equal where
/// light did not change. Blocks row by row, ceil(width / kLightBlock) × ceil(height / kLightBlock);
/// the right and bottom ones may be cut off by the picture's border.
struct LightChange {
    ImageView<const uint16_t> direct_before, direct_now;
    ImageView<const uint16_t> indirect_before, indirect_now;
};

/// What the frame loop knows and the pixels do not show.
struct DenoiseFrame {
    bool reset = false;  ///< first frame, camera cut: there is no history
    /// Empty views: no light, object or material changed since the frame before, so that all light
    /// is what it was; the camera may have moved.
    LightChange change{};
};

/// Owns the history. run() is called once per frame, in order.
class Denoiser {
  public:
    Denoiser();
    ~Denoiser();
    Denoiser(Denoiser&&) noexcept;
    Denoiser& operator=(Denoiser&&) noexcept;

    /// `gbuffer` has the planes normal and motion; its colours are not read, and of its albedo only
    /// where there is none. A changed size is a reset.
    void run(const GBuffer& gbuffer, const LightPlanes& noisy, const DenoiseFrame& frame,
             SimdTarget simd, Workers& workers);

    /// The result of the last run(); valid until the next.
    LightPlanes light() const;
    /// For TaaFrame::light_age. Empty: light has been as it is for long everywhere.
    ImageView<const uint8_t> lightAge() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// G-buffer colour += albedo · (direct + indirect), saturated.
void remodulate(GBuffer& gbuffer, const LightPlanes& light, Workers& workers);

}  // namespace still
