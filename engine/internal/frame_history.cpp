// Frames one after the other into the history: where it begins, where the samples lie, what
// changed.

#include <algorithm>

#include "engine/internal/camera_drift.h"
#include "engine/internal/frame_loop_state.h"

namespace still {

/// The frame whose history is empty and on which `frame` builds.
int FrameLoop::State::historyStart(int frame) const {
    const int cut = lastCut(scene, settings.camera, frame);
    return resize_frame <= frame ? std::max(cut, resize_frame) : cut;
}

uint32_t FrameLoop::State::sampleOf(int frame, int subframe) const {
    const uint32_t since_start = uint32_t(frame - history_start);
    return uint32_t(settings.first_sample) + since_start * uint32_t(settings.subframes) +
           uint32_t(subframe);
}

/// Later sub-frames of a frame see the same instant: nothing has moved since the one before.
static void freeze(FrameState& frame) {
    frame.cut = false;
    frame.lighting_changed = frame.sampled_light_changed = false;
    frame.changed_surfaces.clear();
    frame.turning_surfaces.clear();
    frame.camera_before = frame.camera;
    for (Instance& instance : frame.instances) {
        instance.transform_before = instance.transform;
        instance.moved = false;
    }
}

void FrameLoop::State::followCamera(const FrameState& frame) {
    const bool follows = gathers() && settings.policy.jitter != JitterPattern::none && !frame.cut;
    drift = follows ? driftAfter(drift, frame.camera, frame.camera_before, renderedWidth(),
                                 renderedHeight())
                    : SampleOffset{};
}

/// Where the sample lies: a camera file's word goes before the policy's pattern.
SampleOffset FrameLoop::State::offsetOf(const FrameState& frame, uint32_t sample) const {
    if (frame.jitter_fx8 && settings.subframes == 1) {
        return {(*frame.jitter_fx8)[0], (*frame.jitter_fx8)[1]};
    }
    // Under a camera that moves, a pixel of the picture is made from the last few frames, and only
    // their samples have to lie evenly; at rest all of a long sequence count.
    const TaaPolicy& policy = settings.policy;
    const bool moves =
        !frame.cut && frame.camera.view_projection != frame.camera_before.view_projection;
    const SampleOffset offset =
        reconstructs && moves
            ? jitterSample(policy.jitter, policy.jitter_scale_fx8, policy.scramble, sample)
            : policySample(policy, sample);
    return {withinPixel(offset.x_fx8 - drift.x_fx8), withinPixel(offset.y_fx8 - drift.y_fx8)};
}

TaaSettings FrameLoop::State::taaSettings() const {
    return {.simd = settings.simd, .sample_cap = sampleCap(), .ring = settings.policy.ring};
}

static bool nothingHappens(const FrameState& frame) {
    return !frame.cut && !frame.lighting_changed && !frame.sampled_light_changed &&
           frame.changed_surfaces.empty() &&
           frame.camera.view_projection == frame.camera_before.view_projection &&
           std::none_of(frame.instances.begin(), frame.instances.end(),
                        [](const Instance& instance) { return instance.moved; });
}

/// Whether the frame leaves a finished picture as it is. Then neither geometry nor pixels are
/// touched.
bool FrameLoop::State::rests(const FrameState& frame) {
    return temporal() && gathers() && nothingHappens(frame) && restsResolved();
}

/// Takes the sample that was just rasterized into the history.
void FrameLoop::State::resolve(const FrameState& frame, TaaFrame evidence) {
    if (!temporal()) {
        return;
    }
    if (gathers()) {
        if (denoises()) {
            evidence.light_age = light->denoiser.lightAge();
        } else {
            evidence.shading_changed |= frame.sampled_light_changed;
        }
        gather(evidence);
        return;
    }
    laboratory.resolve(gbuffer,
                       {.reset = frame.cut,
                        .jitter_x_fx8 = evidence.jitter_x_fx8,
                        .jitter_y_fx8 = evidence.jitter_y_fx8},
                       settings.policy, settings.simd, workers);
}

/// Renders one frame into the history, which ends with the one before, or begins with it.
void FrameLoop::State::resolveFrame(int frame, bool looked_at) {
    settings.policy.ratio_fx8 = ratioAt(frame);
    FrameState state = frameStateAt(scene, settings.camera, frame, settings.width, settings.height);
    // Sessions grow long: the way back to their last cut is not gone in every frame.
    const bool goes_on = resolved_frame == frame - 1 && !state.cut && frame != resize_frame;
    history_start = goes_on ? history_start : historyStart(frame);
    state.cut |= frame == history_start;
    for (int i = 0; i < settings.subframes; ++i) {
        const uint32_t sample = sampleOf(frame, i);
        followCamera(state);
        const SampleOffset offset = temporal() ? offsetOf(state, sample) : SampleOffset{};
        const TaaFrame evidence{.reset = state.cut,
                                .shading_changed = state.lighting_changed,
                                .changed_surfaces = state.changed_surfaces,
                                .turning_surfaces = state.turning_surfaces,
                                .jitter_x_fx8 = offset.x_fx8,
                                .jitter_y_fx8 = offset.y_fx8,
                                .looked_at = looked_at && i + 1 == settings.subframes,
                                .repeats = settings.subframes - 1 - i};
        const bool rest = rests(state);
        counters = {};
        if (!rest || (settings.fresh_gbuffer && light == nullptr)) {
            rasterizeSample(state, offset, sample, temporal() && gathers() ? &evidence : nullptr,
                            rest);
        }
        if (!rest) {
            timed(times.taa_ms, [&] { resolve(state, evidence); });
            shown = false;
        }
        freeze(state);
    }
    resolved_frame = frame;
}

/// Brings the history to `frame`, from its start when it does not end right before.
void FrameLoop::State::resolveHistory(int frame) {
    const int first = resolved_frame == frame - 1 ? frame : historyStart(frame);
    for (int replayed = first; replayed < frame; ++replayed) {
        resolveFrame(replayed, false);
    }
    times = {};
    resolveFrame(frame, true);
    if (settings.anti_aliasing == AntiAliasing::fxaa) {
        filterSample();
    }
    if (enlarges() && !shown) {
        timed(times.taa_ms, [&] { enlarge(); });
    }
    if (sharpens() && !shown) {
        timed(times.taa_ms, [&] { sharpenResolved(); });
    }
}

}  // namespace still
