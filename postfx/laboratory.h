#pragma once
// The published methods: history is one resampled image, blended with every new frame
// (Method::recursive). Integer from end to end; presets run compiled for their own policy, any
// other policy runs through the generic kernel, with the same bytes.

#include <cstdint>
#include <memory>

#include "postfx/colour_targets.h"
#include "postfx/policy.h"
#include "postfx/story.h"
#include "postfx/taa.h"
#include "rasterizer/gbuffer.h"
#include "rasterizer/simd.h"
#include "rasterizer/workers.h"

namespace still {

/// What the frame loop knows and the pixels do not show.
struct LaboratoryFrame {
    bool reset = false;  ///< first frame, camera cut: there is no history
    /// Where this frame's samples lie, from the pixels' centres, −128 … 127.
    int jitter_x_fx8 = 0, jitter_y_fx8 = 0;
};

/// Owns the history. resolve() must be called once per frame, in order.
/// In builds for boards the image takes the place of the past as soon as that is no longer read,
/// and there are neither stories nor confidence().
class Laboratory {
  public:
    Laboratory();
    ~Laboratory();
    Laboratory(Laboratory&&) noexcept;
    Laboratory& operator=(Laboratory&&) noexcept;

    /// Makes the memory that resolve() needs for pictures of this size with this policy, as much as
    /// laboratoryBytes() says; else the first resolve() makes it.
    void reserve(int width, int height, const TaaPolicy& policy);

    /// `policy.method` is recursive. Needs the planes motion and, for tests of normals, normal. A
    /// changed size or policy resets by itself.
    void resolve(const GBuffer& gbuffer, const LaboratoryFrame& frame, const TaaPolicy& policy,
                 SimdTarget simd, Workers& workers);

    /// The resolved image, before sharpening; valid until the next resolve().
    ColourPlanes colour() const;
    /// 0 = only this frame's sample … 255 = history fully trusted; valid until the next resolve().
    ImageView<const uint8_t> confidence() const;

    /// What the last resolve() did at a pixel of the picture. `gbuffer` is the one that it was
    /// given, unchanged since.
    PixelStory story(const GBuffer& gbuffer, int x, int y) const;
    /// The same for the whole picture, whose size the targets have. Scalar: about a microsecond a
    /// pixel and thread.
    void storyPlane(const GBuffer& gbuffer, StoryPlane plane, ColourTargets out,
                    Workers& workers) const;
    void rejections(const GBuffer& gbuffer, const RejectionTargets& out, Workers& workers) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace still
