#pragma once
// Temporal upscaling: one jittered sample per pixel of a smaller frame and the history in, an image
// of the full size out. Integer from end to end. Flow, formats and reasons: postfx/README.md.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "postfx/taa.h"
#include "rasterizer/gbuffer.h"
#include "rasterizer/simd.h"
#include "rasterizer/workers.h"

namespace still {

/// Frames are at most this many times smaller than the image, per axis.
constexpr int kMaxUpscale = 3;

struct UpscaleSettings {
    SimdTarget simd = bestSimdTarget();
    /// Of the image. Frames are as large or smaller, by up to kMaxUpscale per axis; both show the
    /// same view, so that a frame's pixel is width / (frame's width) of the image's pixels wide.
    int width = 0, height = 0;
    /// Frames after which a still image is finished (the length of the jitter sequence, whose
    /// offsets are in the frame's pixels): 1 … 4096.
    int sample_cap = 256;
    /// Raw frames that pixels in motion are made from, this one included: 1 … kMaxRing.
    int ring = 16;
};

/// Owns the history. resolve() must be called once per frame, in order. The frames' size may change
/// from one to the next: the history stays. Offsets of the samples (TaaFrame::jitter_x_fx8) and
/// motion are in 1/256 of the frame's pixels.
class TemporalUpscaler {
  public:
    TemporalUpscaler();
    ~TemporalUpscaler();
    TemporalUpscaler(TemporalUpscaler&&) noexcept;
    TemporalUpscaler& operator=(TemporalUpscaler&&) noexcept;

    /// Taa::plan() of a frame of this size.
    std::span<const uint8_t> plan(int frame_width, int frame_height,
                                  std::span<const TileFacts> facts, const TaaFrame& frame,
                                  const UpscaleSettings& settings);
    /// Needs the G-buffer's motion plane; the normal plane, when present, takes part in validation.
    /// A changed size of the image resets by itself.
    void resolve(const GBuffer& gbuffer, const TaaFrame& frame, const UpscaleSettings& settings,
                 Workers& workers);
    /// Taa::rest(). `frame_width`, `frame_height`: what the frame would have had.
    bool rest(int frame_width, int frame_height, const UpscaleSettings& settings);

    /// Tiles of the image whose pixels were changed by any resolve() since the last
    /// forgetChanges(), row by row.
    std::span<const uint8_t> changedTiles() const;
    void forgetChanges();

    /// The image; valid until the next resolve().
    ColourPlanes colour() const;
    /// How much is known of each of its pixels, in samples, 1 … 255.
    ImageView<const uint8_t> sampleCount() const;
    /// True when the image is finished and the last frame changed nothing.
    bool converged() const;
    /// What the last frame did for the image's tiles, row by row.
    std::vector<TileWork> tileWork() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace still
