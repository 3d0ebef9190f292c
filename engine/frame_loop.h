#pragma once
// Scene and settings in, frames out: timeline → rasterizer → TAA (or ssaa, fxaa) → 8-bit image.

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "engine/jitter.h"
#include "engine/scene.h"
#include "engine/timeline.h"
#include "postfx/denoise.h"
#include "postfx/encode.h"
#include "postfx/policy.h"
#include "postfx/story.h"
#include "postfx/taa.h"
#include "rasterizer/rasterizer.h"

namespace still {

enum class AntiAliasing {
    none,  ///< one sample in the pixel's centre
    taa,   ///< FrameSettings::policy
    fxaa,  ///< the sample in the pixel's centre, edges smoothed by brightness: postfx/spatial.h
    ssaa,  ///< FrameSettings::ssaa_samples
};

/// What happens to light that is sampled (SampledLight), when a scene has any.
enum class Denoise {
    off,   ///< one sample a pixel as it is; anti-aliasing averages some
    svgf,  ///< postfx/denoise.h
};

struct FrameSettings {
    int width = 1280, height = 720;
    AntiAliasing anti_aliasing = AntiAliasing::taa;
    TaaPolicy policy{};               ///< used with AntiAliasing::taa; the preset `still`
    int ssaa_samples = 64;            ///< 1 … 65536, used with AntiAliasing::ssaa
    Denoise denoise = Denoise::svgf;  ///< not with AntiAliasing::ssaa, which needs none
    ToneMap tone_map = ToneMap::none;
    double exposure = 1;  ///< light is multiplied by it when it is encoded, before the tone map
    /// Linear light, instead of the scene's.
    std::optional<std::array<float, 3>> background{};
    SimdTarget simd = bestSimdTarget();
    Shading shading = Shading::deferred;
    PlaneSet planes{};  ///< in addition to what the other settings need
    /// FrameResult::gbuffer is read: it holds this frame's samples in every pixel. Else, with
    /// Method::gather, what is finished and at rest is not drawn again and keeps earlier samples.
    /// Nothing else depends on it. With sampled light a finished picture keeps them in any case.
    bool fresh_gbuffer = false;
    CameraChoice camera{};
    /// Sub-frames rendered at each frame's instant; > 1 only makes sense when the scene is still
    /// (a finished picture instead of a raw first frame).
    int subframes = 1;
    /// Place in the sample sequence, ≥ 0, at which every history begins: two runs whose histories
    /// differ in length can be compared at equal samples.
    int first_sample = 0;
    /// Returns milliseconds; when empty no times are taken.
    std::function<double()> clock_ms{};
    /// See RasterSettings::ticks; splits the rasterizer's times by stages.
    uint64_t (*ticks)() = nullptr;
};

/// Milliseconds spent on one frame (summed over sub-frames and ssaa samples).
struct StageTimes {
    double transform_bin_ms = 0, raster_ms = 0, taa_ms = 0, output_ms = 0;
    double light_ms = 0, denoise_ms = 0;  ///< of sampled light
    /// The first two by what their workers did; 0 without FrameSettings::ticks.
    double transform_ms = 0, bin_ms = 0, visibility_ms = 0, shade_ms = 0;
};

/// What render() hands out; views are valid until the next render().
struct FrameResult {
    ImageView<const Rgb8> output;
    ColourPlanes linear;  ///< the same before encoding, fx12
    /// Of the last sub-frame, see FrameSettings::fresh_gbuffer; smaller than the output with a
    /// policy that upscales.
    const GBuffer* gbuffer = nullptr;
    /// Of scenes with sampled light, else empty: one sample a pixel, as it was taken last, and the
    /// same without its noise, with Denoise::svgf. Their sum times the albedo is in the colours.
    LightPlanes light{}, denoised{};
    /// Method::gather only, else empty. Of the frame's pixels, not the output's, with a policy that
    /// enlarges in space.
    ImageView<const uint8_t> sample_count;
    /// How much of a pixel is known, up to confidence_full; empty without TAA. Samples in the
    /// pixel (Method::gather), or trust in history.
    ImageView<const uint8_t> confidence;
    int confidence_full = 255;
    SampleOffset jitter;  ///< where the sample lies that was rasterized last
    StageTimes times;
    /// Method::gather only: further frames of a still scene will not differ.
    bool converged = false;
};

class FrameLoop {
  public:
    /// `scene` and `workers` must outlive the loop. Loops on different threads may share both; a
    /// loop itself is used by one thread at a time. A result outlives its loop's being moved.
    FrameLoop(const Scene& scene, const FrameSettings& settings, Workers& workers);
    ~FrameLoop();
    FrameLoop(FrameLoop&&) noexcept;
    FrameLoop& operator=(FrameLoop&&) noexcept;

    /// Renders frame `frame`. Frames that it depends on (back to the last cut or resize) are
    /// replayed unseen when they were not rendered just before, so any order gives the same bytes.
    FrameResult render(int frame);

    /// Changes the target size. For history and sample sequence the frame rendered next, R, is a
    /// cut: from R on, frame N is a function of scene, settings and R.
    /// Frames before R are those of a loop that has had the new size from the start.
    void resize(int width, int height);

    /// From the frame rendered next, R, on, frames are smaller than the picture by this ratio
    /// (kNativeRatio_fx8 … kMaxRatio_fx8). That is no cut: the picture goes on. Frames before R
    /// keep the ratios they had, also when they are rendered again; for that, eight bytes are kept
    /// for each change. Only with a policy that upscales in time, upscalesInTime().
    void setRatio(int ratio_fx8);

    /// Of the sample that was rasterized last for the last frame; all zero when it needed none.
    const RasterCounters& counters() const;

    // What the last frame did, told when asked for: postfx/story.h. Valid as long as its result.

    /// None without AntiAliasing::taa, with upscaling, before the first frame and outside the
    /// picture.
    std::optional<PixelStory> story(int x, int y) const;
    /// The same for the whole picture; false, and nothing is written, where story() has none. The
    /// targets have the last frame's size. About a microsecond a pixel and thread.
    bool storyPlane(StoryPlane plane, ColourTargets out) const;
    bool rejections(const RejectionTargets& out) const;
    /// Of each tile, row by row; empty before the first frame. Without Method::gather every tile is
    /// drawn and resolved in every frame.
    std::vector<TileWork> tileWork() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace still
