#pragma once
// Temporal anti-aliasing: one jittered sample per pixel and the history in, an image out.
// Integer from end to end. Flow, formats and reasons: postfx/README.md.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "postfx/colour_targets.h"
#include "postfx/story.h"
#include "rasterizer/gbuffer.h"
#include "rasterizer/simd.h"
#include "rasterizer/workers.h"

namespace still {

struct TaaSettings {
    SimdTarget simd = bestSimdTarget();
    /// Samples after which a still pixel is finished (the length of the jitter sequence): 1 … 255.
    int sample_cap = 64;
    /// Raw frames that pixels in motion are made from, this one included: 1 … kMaxRing.
    int ring = 8;
};
constexpr int kMaxRing = 16;

/// What the frame loop knows and the pixels do not show.
struct TaaFrame {
    bool reset = false;  ///< first frame, camera cut: there is no history
    /// Light, material or texture changed since the last frame: history colours are only evidence.
    bool shading_changed = false;
    /// The same for single surfaces: one bit per surface number; empty = none.
    std::span<const uint64_t> changed_surfaces{};
    /// Surfaces of objects that turn or bend, in the same form.
    std::span<const uint64_t> turning_surfaces{};
    /// Where this frame's samples lie, from the pixels' centres, −128 … 127.
    int jitter_x_fx8 = 0, jitter_y_fx8 = 0;
    /// Of each pixel, for how many frames its surface has been lit as it is now, 255 = long enough;
    /// older samples of it do not count, and 0 leaves this frame's. Empty: all are. Stays valid
    /// until the next resolve(). plan() does not know it: whoever lights tiles anew asks for them.
    ImageView<const uint8_t> light_age{};
    /// False: the image of this frame is not asked for, and only what later ones need is made.
    bool looked_at = true;
    /// So many frames follow in which nothing moves or changes, and all but the last of them are
    /// not looked at.
    int repeats = 0;
};

/// Linear light, fx12, planar.
struct ColourPlanes {
    ImageView<const uint16_t> red, green, blue;
};

/// Owns the history. resolve() must be called once per frame, in order.
class Taa {
  public:
    Taa();
    ~Taa();
    Taa(Taa&&) noexcept;
    Taa& operator=(Taa&&) noexcept;

    /// Makes all memory that frames of this size with these settings need, as much as taaBytes()
    /// says; else it is made when it is needed first. Forgets the past.
    void reserve(int width, int height, const TaaSettings& settings);

    /// Which tiles (1; else 0) of a G-buffer of this size and these facts the frame's resolve()
    /// reads. In the others the planes may keep samples of the frame in which they were last read.
    /// Valid until the next call.
    std::span<const uint8_t> plan(int width, int height, std::span<const TileFacts> facts,
                                  const TaaFrame& frame, const TaaSettings& settings);

    /// Accumulates the G-buffer's colours. Needs its motion plane (planes.motion), and its normal
    /// plane when present takes part in validation. A changed size resets by itself.
    void resolve(const GBuffer& gbuffer, const TaaFrame& frame, const TaaSettings& settings,
                 Workers& workers);

    /// For a frame in which nothing moved and nothing changed: whether its resolve() would leave
    /// the image as it is, because that is finished. Then this call takes its place, and the frame
    /// needs no G-buffer. False does nothing.
    bool rest(const TaaSettings& settings);

    /// Tiles (1; else 0) whose image was changed by any resolve() since the last forgetChanges().
    std::span<const uint8_t> changedTiles() const;
    void forgetChanges();

    /// The resolved image; valid until the next resolve().
    ColourPlanes colour() const;
    /// Number of samples in each pixel, 1 … sample_cap; valid until the next resolve().
    ImageView<const uint8_t> sampleCount() const;
    /// True when every pixel has sample_cap samples and the last frame changed nothing.
    bool converged() const;

    /// What the last resolve() or rest() did at a pixel of the picture. `gbuffer` is the one that
    /// resolve() was given last, unchanged since.
    PixelStory story(const GBuffer& gbuffer, int x, int y) const;
    /// The same for the whole picture, whose size the targets have. Scalar: about a microsecond a
    /// pixel and thread.
    void storyPlane(const GBuffer& gbuffer, StoryPlane plane, ColourTargets out,
                    Workers& workers) const;
    void rejections(const GBuffer& gbuffer, const RejectionTargets& out, Workers& workers) const;
    /// What they did for the tiles, row by row.
    std::vector<TileWork> tileWork() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace still
