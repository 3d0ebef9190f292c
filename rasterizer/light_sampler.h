#pragma once
// Light that needs a random sample a pixel and frame: soft shadows of the sun, of spheres and of
// rectangles, ambient occlusion, one bounce. One ray per effect and pixel, traced through the
// scene's triangles (bvh.h).
//
// What the light of a pixel is, is a pure function of the pixel, of its surface point in the
// G-buffer, of FrameView::sample and of the scene: not of threads, of the instruction set or of
// earlier frames.

#include <cstdint>
#include <memory>

#include "rasterizer/draw_list.h"
#include "rasterizer/gbuffer.h"
#include "rasterizer/image.h"
#include "rasterizer/simd.h"
#include "rasterizer/workers.h"

namespace still {

/// Light that arrives at each pixel's surface, as a white surface would show it: multiplied by the
/// albedo planes it is colour. Linear, fx12 as the colour planes, saturated; 0 where no surface is.
struct LightImages {
    Image<uint16_t> direct_red, direct_green, direct_blue;        ///< from lights
    Image<uint16_t> indirect_red, indirect_green, indirect_blue;  ///< sky and other surfaces

    void resize(int width, int height);
};

/// Each block of kLightBlock² pixels holds one sample of a LightChangeImages.
constexpr int kLightBlock = 3;

/// Luminance (Rec. 709, fx12) of one sample in each block of the *previous* frame, as it was and as
/// the very same sample (same place on its surface, same random numbers) is in the present scene.
/// Exactly equal where no light, no occluder and no reflecting surface changed; 0 where no surface
/// was. Sized ceil(width / kLightBlock) × ceil(height / kLightBlock).
struct LightChangeImages {
    Image<uint16_t> direct_before, direct_now;
    Image<uint16_t> indirect_before, indirect_now;

    void resize(int width, int height);
};

/// Keeps its trees from frame to frame: those of meshes as long as it lives, so that meshes, their
/// textures and the alpha modes of their materials have to stay as they are. Not copyable, one
/// frame at a time, in this order: setUp(), changes() if wanted, sample().
class LightSampler {
  public:
    LightSampler();
    ~LightSampler();
    LightSampler(LightSampler&&) noexcept;
    LightSampler& operator=(LightSampler&&) noexcept;

    /// Builds what does not exist yet, and the tree of instances if one of them moved. Only what
    /// is traced is built. `list` and `view` must stay valid until sample() has returned.
    void setUp(const DrawList& list, const FrameView& view, SimdTarget simd, Workers& workers);

    /// How light changed since the frame that was sampled last, if that was done with `keep`.
    /// False, and `out` stays as it is, where nothing was kept, and where nothing can have changed:
    /// no instance moved, and lighting and materials are what they were.
    bool changes(LightChangeImages& out, Workers& workers);

    /// Writes `out`, which gets the view's size: all light that SampledLight holds. Adds the
    /// highlights of these lights to the G-buffer's colour. Needs the normal plane. `keep`: for
    /// changes() of the next frame.
    void sample(GBuffer& gbuffer, LightImages& out, bool keep, Workers& workers);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace still
