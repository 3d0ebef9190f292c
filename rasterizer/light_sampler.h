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
struct LightPlanes {
    Image<uint16_t> direct_red, direct_green, direct_blue;        ///< from lights
    Image<uint16_t> indirect_red, indirect_green, indirect_blue;  ///< sky and other surfaces

    int width() const { return direct_red.width(); }
    int height() const { return direct_red.height(); }
    void resize(int width, int height);
};

/// Luminance (Rec. 709, fx12) of one sample of the previous frame, as it was and as the same sample
/// (same place on its surface, same random numbers) is in the present scene. Exactly equal where no
/// light, no occluder and no reflecting surface changed. All 0 where no such sample is.
struct LightChange {
    uint16_t direct_before = 0, direct_now = 0;
    uint16_t indirect_before = 0, indirect_now = 0;
    friend bool operator==(const LightChange&, const LightChange&) = default;
};

/// Pixels (x, y) of the block of a LightChange: x / kLightBlock, y / kLightBlock.
constexpr int kLightBlock = 3;

/// Keeps its trees from frame to frame: those of meshes as long as it lives, so that meshes, their
/// textures and the alpha modes of their materials have to stay as they are. Not copyable, one
/// frame at a time, in this order: setUp(), changes() if wanted, sample().
class LightSampler {
  public:
    LightSampler();
    ~LightSampler();
    LightSampler(const LightSampler&) = delete;
    LightSampler& operator=(const LightSampler&) = delete;

    /// Builds what does not exist yet, and the tree of instances if one of them moved. Only what
    /// is traced is built. `list` and `view` must stay valid until sample() has returned.
    void setUp(const DrawList& list, const FrameView& view, SimdTarget simd, Workers& workers);

    /// How light changed since the last frame that was sampled with `keep`, for each block of the
    /// present frame: sized ceil(width / 3) × ceil(height / 3). False, and `out` stays as it is,
    /// where nothing can have changed: no instance moved and lighting and materials are the same;
    /// or where nothing was kept. `gbuffer` is the present frame's.
    bool changes(const GBuffer& gbuffer, Image<LightChange>& out, Workers& workers);

    /// Writes all of `out`, which gets the view's size: the part that is traced. Adds the
    /// highlights of traced lights to the G-buffer's colour. Needs the normal plane. `keep`: for
    /// changes() of the next frame.
    void sample(GBuffer& gbuffer, LightPlanes& out, bool keep, Workers& workers);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace still
