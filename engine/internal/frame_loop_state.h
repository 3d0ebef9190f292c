#pragma once
// What a frame loop keeps, and the steps of a frame: frame_loop.cpp hands frames out,
// frame_samples.cpp rasterizes, frame_light.cpp adds sampled light, frame_history.cpp brings the
// past to a frame.

#include <algorithm>
#include <vector>

#include "engine/frame_loop.h"
#include "engine/jitter.h"
#include "postfx/denoise.h"
#include "postfx/laboratory.h"
#include "postfx/sample_sums.h"
#include "postfx/spatial.h"
#include "postfx/spatial_upscale.h"
#include "postfx/upscale.h"
#include "rasterizer/light_sampler.h"

namespace still {

constexpr int kNoFrame = -2;

struct ColourImages {
    Image<uint16_t> red, green, blue;
};

inline ColourPlanes planesOf(const GBuffer& gbuffer) {
    return {gbuffer.red.view(), gbuffer.green.view(), gbuffer.blue.view()};
}

inline LightPlanes planesOf(const LightImages& images) {
    return {
        {images.direct_red.view(), images.direct_green.view(), images.direct_blue.view()},
        {images.indirect_red.view(), images.indirect_green.view(), images.indirect_blue.view()}};
}

/// Of light that is sampled.
struct LightStage {
    LightSampler sampler;
    LightImages noisy;   ///< one sample a pixel
    LightImages placed;  ///< denoised, where the samples lie; of frames that are upscaled in time
    LightChangeImages change;
    Denoiser denoiser;
};

struct FrameLoop::State {
    State(const Scene& scene_in, const FrameSettings& settings_in, Workers& workers_in)
        : scene(scene_in),
          settings(settings_in),
          workers(workers_in),
          table(settings.tone_map, settings.exposure),
          reconstructs(temporal() && upscalesInTime(settings.policy)) {
        if (scene.lights.sampled()) {
            light = std::make_unique<LightStage>();
        }
        windings.resize(scene.meshes.size());
        workers.parallelFor(int(windings.size()), 1, [&](int begin, int end, int) {
            for (int i = begin; i < end; ++i) {
                windings[size_t(i)] = windingBits(scene.meshes[size_t(i)]);
            }
        });
    }

    const Scene& scene;
    FrameSettings settings;
    Workers& workers;
    std::vector<WindingBits> windings;  ///< of the meshes
    Rasterizer rasterizer;
    Taa taa;                    ///< Method::gather …
    TemporalUpscaler upscaler;  ///< … of frames that are smaller than the picture
    Laboratory laboratory;      ///< Method::recursive
    SpatialFilter spatial;
    SpatialUpscaler enlarger;           ///< policies that upscale
    std::unique_ptr<LightStage> light;  ///< of scenes with sampled light
    GBuffer gbuffer;        ///< what is resolved; tiles that nothing new is in keep earlier samples
    GBuffer fresh;          ///< FrameSettings::fresh_gbuffer, in frames that `gbuffer` has parts of
    bool in_parts = false;  ///< this is such a frame
    OutputTable table;
    /// Frames are upscaled in time, at any ratio, 1 included. FrameSettings::policy.ratio_fx8 is
    /// that of the frame that is rendered.
    const bool reconstructs;
    struct RatioChange {
        int first_frame = 0;
        int ratio_fx8 = kNativeRatio_fx8;
    };
    std::vector<RatioChange>
        ratio_changes;       ///< FrameLoop::setRatio(), by frame; first the policy's
    int next_ratio_fx8 = 0;  ///< of the frame rendered next; 0: as before
    Image<Rgb8> output;
    ColourSums sums;
    ColourImages filtered;      ///< mean of ssaa samples, or after spatial filter or sharpening
    ColourImages enlarged;      ///< before sharpening
    Image<uint8_t> confidence;  ///< for sharpening only
    StageTimes times;
    RasterCounters counters;
    SampleOffset jitter;            ///< of the sample that was rasterized last
    int resolved_frame = kNoFrame;  ///< the frame that the TAA history ends with
    bool shown = false;             ///< the output shows the history as it is
    /// What lies far ahead has moved by this much over the picture since the camera set off, 1/256
    /// pixel modulo 1 pixel.
    SampleOffset drift;
    int history_start = 0;  ///< historyStart() of the frame that is rendered
    int resize_frame = 0;   ///< the first frame of the present size
    bool resized = false;   ///< resize_frame is the one that is rendered next

    /// Runs `stage` and adds its time to `total_ms`.
    template <class Stage>
    void timed(double& total_ms, Stage&& stage) {
        if (!settings.clock_ms) {
            stage();
            return;
        }
        const double start_ms = settings.clock_ms();
        stage();
        total_ms += settings.clock_ms() - start_ms;
    }

    bool temporal() const { return settings.anti_aliasing == AntiAliasing::taa; }
    bool denoises() const {
        return light != nullptr && settings.denoise == Denoise::svgf &&
               settings.anti_aliasing != AntiAliasing::ssaa;
    }
    /// Whether a frame depends on those before it.
    bool hasPast() const { return temporal() || denoises(); }
    bool hasStory() const {
        return temporal() && !reconstructs && !enlarges() && !gbuffer.red.empty();
    }
    bool gathers() const { return settings.policy.method == Method::gather; }
    bool sharpens() const { return temporal() && settings.policy.sharpness_q15 > 0; }
    int sampleCap() const { return int(policyPeriod(settings.policy)); }
    /// Samples that are averaged; 1 when there is nothing to average.
    int ssaaSamples() const {
        return settings.anti_aliasing == AntiAliasing::ssaa ? settings.ssaa_samples : 1;
    }
    int historyStart(int frame) const;
    uint32_t sampleOf(int frame, int subframe) const;
    RasterSettings rasterSettings() const;
    void rasterizeSample(const FrameState& frame, SampleOffset offset, uint32_t sample,
                         const TaaFrame* evidence = nullptr, bool rest = false);
    void addLight(const DrawList& list, const FrameView& view, bool reset);
    void addRasterTimes(const StageTimes& sample);
    void followCamera(const FrameState& frame);
    SampleOffset offsetOf(const FrameState& frame, uint32_t sample) const;
    TaaSettings taaSettings() const;
    bool rests(const FrameState& frame);
    void resolve(const FrameState& frame, TaaFrame evidence);
    void resolveFrame(int frame, bool looked_at);
    void resolveHistory(int frame);
    ColourTargets resizeFiltered();
    ColourPlanes resolved() const;
    ImageView<const uint8_t> fullConfidence();
    void sharpenResolved();
    // frame_upscale.cpp
    bool enlarges() const;
    int renderedWidth() const;
    int renderedHeight() const;
    void enlarge();
    void noteRatio(int frame);
    int ratioAt(int frame) const;
    UpscaleSettings upscaleSettings() const;
    // Of the gather, whichever of the two does it.
    std::span<const uint8_t> plan(std::span<const TileFacts> facts, const TaaFrame& evidence);
    bool restsResolved();
    void gather(const TaaFrame& evidence);
    std::span<const uint8_t> changedTiles() const;
    ImageView<const uint8_t> sampleCount() const;
    int fullCount() const;
    void averageSamples(const FrameState& frame);
    void filterSample();
    void renderAlone(int frame);
    ColourPlanes colour() const;
    void encode();
    FrameResult result() const;
};

}  // namespace still
