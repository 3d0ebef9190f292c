// Frames in, pictures out; the steps are in internal/frame_samples.cpp and
// internal/frame_history.cpp.

#include "engine/frame_loop.h"

#include <cassert>

#include "engine/internal/frame_loop_state.h"
#include "postfx/sharpen.h"

namespace still {
namespace {

constexpr int kRowGrain = 16;

}  // namespace

/// At the output's size.
ColourPlanes FrameLoop::State::resolved() const {
    if (enlarges()) {
        return {enlarged.red.view(), enlarged.green.view(), enlarged.blue.view()};
    }
    if (reconstructs) {
        return upscaler.colour();
    }
    return gathers() ? taa.colour() : laboratory.colour();
}

/// Confidence with 255 as full. A pixel that has all its samples is fully known.
ImageView<const uint8_t> FrameLoop::State::fullConfidence() {
    if (!gathers()) {
        return laboratory.confidence();
    }
    const ImageView<const uint8_t> counts = sampleCount();
    const int full = fullCount();
    confidence.resize(counts.width, counts.height);
    const ImageView<uint8_t> scaled = confidence.view();
    workers.parallelFor(counts.height, kRowGrain, [&](int begin, int end, int) {
        for (int y = begin; y < end; ++y) {
            for (int x = 0; x < counts.width; ++x) {
                scaled.row(y)[x] = uint8_t(std::min<int>(counts.row(y)[x], full) * 255 / full);
            }
        }
    });
    return scaled;
}

void FrameLoop::State::sharpenResolved() {
    const auto known = enlarges() ? ImageView<const uint8_t>{} : fullConfidence();
    sharpen(resolved(), known, settings.policy.sharpness_q15, resizeFiltered(), settings.simd,
            workers);
}

ColourPlanes FrameLoop::State::colour() const {
    const bool fxaa = settings.anti_aliasing == AntiAliasing::fxaa;
    if (fxaa || sharpens() || ssaaSamples() > 1) {
        return {filtered.red.view(), filtered.green.view(), filtered.blue.view()};
    }
    return temporal() ? resolved() : planesOf(gbuffer);
}

/// The whole picture, or of the gather's, unless it was sharpened, what changed.
void FrameLoop::State::encode() {
    const bool by_tile = temporal() && gathers() && !sharpens() && !enlarges();
    encodeOutput(colour(), table, output.view(), workers,
                 by_tile ? changedTiles() : std::span<const uint8_t>());
    taa.forgetChanges();
    upscaler.forgetChanges();
}

FrameResult FrameLoop::State::result() const {
    FrameResult result;
    result.output = output.view();
    result.linear = colour();
    result.gbuffer = in_parts && settings.fresh_gbuffer ? &fresh : &gbuffer;
    result.jitter = jitter;
    if (light != nullptr) {
        result.light = planesOf(light->noisy);
        result.denoised = denoises() ? light->denoiser.light() : LightPlanes{};
    }
    result.times = times;
    if (temporal() && gathers()) {
        result.sample_count = sampleCount();
        result.confidence = result.sample_count;
        result.confidence_full = fullCount();
        result.converged = reconstructs ? upscaler.converged() : taa.converged();
    } else if (temporal()) {
        result.confidence = laboratory.confidence();
    }
    return result;
}

FrameLoop::FrameLoop(const Scene& scene, const FrameSettings& settings, Workers& workers)
    : state_(std::make_unique<State>(scene, settings, workers)) {
    assert(settings.ssaa_samples >= 1 && settings.ssaa_samples <= 65536);
    assert(settings.subframes >= 1 && settings.first_sample >= 0);
    assert(settings.width >= 1 && settings.width <= kMaxTargetSize);
    assert(settings.height >= 1 && settings.height <= kMaxTargetSize);
}

FrameLoop::~FrameLoop() = default;
FrameLoop::FrameLoop(FrameLoop&&) noexcept = default;
FrameLoop& FrameLoop::operator=(FrameLoop&&) noexcept = default;

FrameResult FrameLoop::render(int frame) {
    assert(frame >= 0);
    State& state = *state_;
    state.times = {};
    if (state.resized) {
        state.resize_frame = frame;
        state.resized = false;
    }
    state.noteRatio(frame);
    if (state.hasPast()) {
        state.resolveHistory(frame);
    } else {
        state.renderAlone(frame);
    }
    if (!state.shown) {
        state.output.resize(state.settings.width, state.settings.height);
        state.timed(state.times.output_ms, [&] { state.encode(); });
    }
    state.shown = state.temporal();
    return state.result();
}

void FrameLoop::resize(int width, int height) {
    assert(width >= 1 && width <= kMaxTargetSize && height >= 1 && height <= kMaxTargetSize);
    state_->settings.width = width;
    state_->settings.height = height;
    state_->resolved_frame = kNoFrame;
    state_->resized = true;
}

void FrameLoop::setRatio(int ratio_fx8) {
    assert(state_->reconstructs);
    assert(ratio_fx8 >= kNativeRatio_fx8 && ratio_fx8 <= kMaxRatio_fx8);
    state_->next_ratio_fx8 = ratio_fx8;
}

const RasterCounters& FrameLoop::counters() const {
    return state_->counters;
}

std::optional<PixelStory> FrameLoop::story(int x, int y) const {
    const State& s = *state_;
    const bool inside = x >= 0 && x < s.gbuffer.width() && y >= 0 && y < s.gbuffer.height();
    if (!s.hasStory() || !inside) {
        return std::nullopt;
    }
    return s.gathers() ? s.taa.story(s.gbuffer, x, y) : s.laboratory.story(s.gbuffer, x, y);
}

bool FrameLoop::storyPlane(StoryPlane plane, ColourTargets out) const {
    const State& s = *state_;
    if (!s.hasStory()) {
        return false;
    }
    if (s.gathers()) {
        s.taa.storyPlane(s.gbuffer, plane, out, s.workers);
    } else {
        s.laboratory.storyPlane(s.gbuffer, plane, out, s.workers);
    }
    return true;
}

bool FrameLoop::rejections(const RejectionTargets& out) const {
    const State& s = *state_;
    if (!s.hasStory()) {
        return false;
    }
    if (s.gathers()) {
        s.taa.rejections(s.gbuffer, out, s.workers);
    } else {
        s.laboratory.rejections(s.gbuffer, out, s.workers);
    }
    return true;
}

std::vector<TileWork> FrameLoop::tileWork() const {
    const State& s = *state_;
    if (s.reconstructs) {
        return s.upscaler.tileWork();
    }
    if (s.temporal() && s.gathers() && !s.enlarges()) {
        return s.taa.tileWork();
    }
    const auto along = [](int pixels) { return size_t(pixels + kTileSize - 1) / kTileSize; };
    return std::vector<TileWork>(along(s.output.width()) * along(s.output.height()),
                                 {.drawn = true, .resolved = true});
}

}  // namespace still
