// Frames that are smaller than the picture.

#include <algorithm>

#include "engine/internal/frame_loop_state.h"

namespace still {

/// Whether the finished picture is enlarged in space.
bool FrameLoop::State::enlarges() const {
    return temporal() && upscales(settings.policy) && !reconstructs;
}

int FrameLoop::State::renderedWidth() const {
    return temporal() ? renderedSize(settings.width, settings.policy.ratio_fx8) : settings.width;
}
int FrameLoop::State::renderedHeight() const {
    return temporal() ? renderedSize(settings.height, settings.policy.ratio_fx8) : settings.height;
}

void FrameLoop::State::enlarge() {
    for (Image<uint16_t>* plane : {&enlarged.red, &enlarged.green, &enlarged.blue}) {
        plane->resize(settings.width, settings.height);
    }
    const bool bicubic = settings.policy.upscaler == UpscaleMethod::bicubic;
    enlarger.run(gathers() ? taa.colour() : laboratory.colour(),
                 bicubic ? EnlargeFilter::bicubic : EnlargeFilter::edge,
                 {enlarged.red.view(), enlarged.green.view(), enlarged.blue.view()}, settings.simd,
                 workers);
}

/// A ratio that was set begins at `frame`; what was to come after it does not any more.
void FrameLoop::State::noteRatio(int frame) {
    if (next_ratio_fx8 == 0) {
        return;
    }
    if (ratio_changes.empty()) {
        ratio_changes.push_back({-1, settings.policy.ratio_fx8});
    }
    while (ratio_changes.back().first_frame >= frame) {
        ratio_changes.pop_back();
    }
    if (ratio_changes.back().ratio_fx8 != next_ratio_fx8) {
        ratio_changes.push_back({frame, next_ratio_fx8});
    }
    next_ratio_fx8 = 0;
}

int FrameLoop::State::ratioAt(int frame) const {
    // Sessions grow long, and some change their ratio often.
    const auto after = std::upper_bound(
        ratio_changes.begin(), ratio_changes.end(), frame,
        [](int wanted, const RatioChange& change) { return wanted < change.first_frame; });
    return after == ratio_changes.begin() ? settings.policy.ratio_fx8 : (after - 1)->ratio_fx8;
}

/// The ring is the same at all ratios, so that the history stays when the ratio changes.
UpscaleSettings FrameLoop::State::upscaleSettings() const {
    return {.simd = settings.simd,
            .width = settings.width,
            .height = settings.height,
            .sample_cap = sampleCap(),
            .ring = settings.policy.ring};
}

std::span<const uint8_t> FrameLoop::State::plan(std::span<const TileFacts> facts,
                                                const TaaFrame& evidence) {
    if (reconstructs) {
        return upscaler.plan(renderedWidth(), renderedHeight(), facts, evidence, upscaleSettings());
    }
    return taa.plan(renderedWidth(), renderedHeight(), facts, evidence, taaSettings());
}

bool FrameLoop::State::restsResolved() {
    return reconstructs ? upscaler.rest(renderedWidth(), renderedHeight(), upscaleSettings())
                        : taa.rest(taaSettings());
}

void FrameLoop::State::gather(const TaaFrame& evidence) {
    if (reconstructs) {
        upscaler.resolve(gbuffer, evidence, upscaleSettings(), workers);
    } else {
        taa.resolve(gbuffer, evidence, taaSettings(), workers);
    }
}

std::span<const uint8_t> FrameLoop::State::changedTiles() const {
    return reconstructs ? upscaler.changedTiles() : taa.changedTiles();
}

ImageView<const uint8_t> FrameLoop::State::sampleCount() const {
    return reconstructs ? upscaler.sampleCount() : taa.sampleCount();
}

/// Samples with which a pixel is known.
int FrameLoop::State::fullCount() const {
    return reconstructs ? int(kTaaPeriod) : sampleCap();
}

}  // namespace still
