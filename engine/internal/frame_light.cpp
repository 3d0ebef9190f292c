// Light that is sampled: traced, denoised, and put into the G-buffer's colours before they are
// anti-aliased.

#include "engine/internal/frame_loop_state.h"
#include "postfx/place_light.h"

namespace still {

static LightChange changeOf(const LightChangeImages& images) {
    return {images.direct_before.view(), images.direct_now.view(), images.indirect_before.view(),
            images.indirect_now.view()};
}

/// Of the sample that was just rasterized. `reset`: it has no past.
void FrameLoop::State::addLight(const DrawList& list, const FrameView& view, bool reset) {
    LightStage& stage = *light;
    const bool keeps = denoises();
    DenoiseFrame frame{.reset = reset};
    timed(times.light_ms, [&] {
        stage.sampler.setUp(list, view, settings.simd, workers);
        if (keeps && !reset && stage.sampler.changes(stage.change, workers)) {
            frame.change = changeOf(stage.change);
        }
        stage.sampler.sample(gbuffer, stage.noisy, keeps, workers);
    });
    LightPlanes clean = planesOf(stage.noisy);
    timed(keeps ? times.denoise_ms : times.light_ms, [&] {
        if (keeps) {
            stage.denoiser.run(gbuffer, clean, frame, settings.simd, workers);
            clean = stage.denoiser.light();
        }
        if (keeps && reconstructs) {
            placeLight(gbuffer, clean, view.jitter_x_fx8, view.jitter_y_fx8, stage.placed, workers);
            clean = planesOf(stage.placed);
        }
        remodulate(gbuffer, clean, workers);
    });
}

}  // namespace still
