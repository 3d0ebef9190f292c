#include "demos/inspect/pane.h"

#include <algorithm>

#include "demos/inspect/paint_rows.h"
#include "demos/inspect/views.h"
#include "engine/hash.h"

namespace still::inspect {

Pane::Pane(const Film& film, const FrameSettings& base, const Mode& mode, Workers& workers)
    : film_(film),
      base_(base),
      mode_(mode),
      workers_(workers),
      table_(base.tone_map),
      probe_(film, base.simd, workers) {
    base_.camera = film.camera();
    if (mode.anti_aliasing == AntiAliasing::ssaa) {
        reference_ = std::make_unique<Reference>(film, base.simd, workers);
    } else {
        loop_ = std::make_unique<FrameLoop>(film.scene, settings(), workers);
        loop_->resize(base_.width, base_.height);  // the next frame is a cut
    }
}

FrameSettings Pane::settings() const {
    FrameSettings settings = base_;
    settings.anti_aliasing = mode_.anti_aliasing;
    settings.policy = mode_.policy;
    settings.ssaa_samples = mode_.ssaa_samples;
    settings.denoise = mode_.denoise;
    return settings;
}

void Pane::setRatio(int ratio_fx8) {
    if (temporal() && upscalesInTime(mode_.policy)) {
        loop_->setRatio(ratio_fx8);
    }
}

/// Recursive methods have no end of their own: they rest when a whole period of the jitter has
/// changed nothing. What has no history still wants a frame in which nothing moves.
void Pane::watchForRest() {
    const bool stands = film_.stands(shown_frame_);
    if (!temporal()) {
        at_rest_ = stands;
        return;
    }
    if (mode_.policy.method == Method::gather) {
        at_rest_ = stands && result_.converged;
        return;
    }
    const uint64_t hash = hashPlane(result_.output);
    equal_frames_ = stands && hash == last_hash_ ? equal_frames_ + 1 : 0;
    last_hash_ = hash;
    at_rest_ = equal_frames_ >= int(policyPeriod(mode_.policy));
}

bool Pane::wantsLastFrame() const {
    if (shown_frame_ < 0 || temporal()) {
        return shown_frame_ != film_.lastFrame();
    }
    const bool same = film_.sameView(shown_frame_, film_.lastFrame());
    return !same || (!reference_ && (film_.noisy || !at_rest_));
}

void Pane::render() {
    shown_frame_ = film_.lastFrame();
    first_frame_ = first_frame_ < 0 ? shown_frame_ : first_frame_;
    if (reference_) {
        reference_->begin(shown_frame_, base_.width, base_.height, mode_.ssaa_samples);
        at_rest_ = false;
        return;
    }
    result_ = loop_->render(shown_frame_);
    times_ = result_.times;
    watchForRest();
}

void Pane::refine(int samples) {
    const double start_ms = base_.clock_ms ? base_.clock_ms() : 0;
    reference_->add(samples);
    const double encode_ms = base_.clock_ms ? base_.clock_ms() : 0;
    reference_->encode(table_);
    const double end_ms = base_.clock_ms ? base_.clock_ms() : 0;
    times_ = {.raster_ms = encode_ms - start_ms, .output_ms = end_ms - encode_ms};
    at_rest_ = reference_->complete();
}

ImageView<const Rgb8> Pane::picture() const {
    return reference_ ? reference_->picture() : result_.output;
}

const RasterCounters& Pane::counters() const {
    return reference_ ? reference_->counters() : loop_->counters();
}

/// As FrameLoop counts them: from the last cut on.
uint32_t Pane::sampleNumber() const {
    if (reference_) {
        return 0;
    }
    const int cut = lastCut(film_.scene, film_.camera(), shown_frame_);
    return uint32_t(shown_frame_ - std::max(cut, first_frame_));
}

const GBuffer& Pane::sample() {
    if (probed_frame_ != shown_frame_) {
        const bool camera_only = temporal() && mode_.policy.method == Method::recursive &&
                                 mode_.policy.motion == MotionSource::camera;
        probe_.draw(shown_frame_, base_.width, base_.height,
                    {.offset = jitter(),
                     .sample = sampleNumber(),
                     .planes = {.normal = true, .motion = true},
                     .mip_bias_fx8 = temporal() ? mipBias_fx8(mode_.policy) : 0,
                     .camera_motion_only = camera_only});
        probed_frame_ = shown_frame_;
    }
    return probe_.gbuffer();
}

void Pane::paintStory(StoryPlane plane, ImageView<Rgb8> out) {
    for (Image<uint16_t>* channel : {&planes_.red, &planes_.green, &planes_.blue}) {
        channel->resize(out.width, out.height);
    }
    if (!loop_ || !loop_->storyPlane(
                      plane, {planes_.red.view(), planes_.green.view(), planes_.blue.view()})) {
        paintRows(out, workers_, [](int, int) { return Rgb8{}; });
        return;
    }
    encodeOutput({planes_.red.view(), planes_.green.view(), planes_.blue.view()}, table_, out,
                 workers_);
}

void Pane::paintRejections(ImageView<Rgb8> out) {
    planes_.reason = {};  // zero is "taken"
    planes_.lost = {};
    planes_.reason.resize(out.width, out.height);
    planes_.lost.resize(out.width, out.height);
    if (loop_) {
        loop_->rejections({planes_.reason.view(), planes_.lost.view()});
    }
    paintRejection(planes_.reason.view(), planes_.lost.view(), picture(), out, workers_);
}

ImageView<const uint16_t> Pane::overdraw() {
    sample();
    return probe_.overdraw();
}

std::vector<TileWork> Pane::tileWork() const {
    if (loop_) {
        return loop_->tileWork();
    }
    const auto tiles = [](int pixels) { return size_t((pixels + kTileSize - 1) / kTileSize); };
    const bool complete = reference_->complete();
    return std::vector<TileWork>(tiles(base_.width) * tiles(base_.height),
                                 {.drawn = !complete, .resolved = !complete, .finished = complete});
}

std::vector<SampleOffset> Pane::pattern() const {
    std::vector<SampleOffset> offsets;
    if (reference_) {
        for (int i = 0; i < mode_.ssaa_samples; ++i) {
            offsets.push_back(ssaaSample(uint32_t(i), uint32_t(mode_.ssaa_samples)));
        }
        return offsets;
    }
    if (!temporal()) {
        return {{}};
    }
    // The gather's pattern goes along with the camera: all of it is shifted by as much as this
    // frame's sample is, modulo a pixel.
    const TaaPolicy& policy = mode_.policy;
    const auto sampleAt = [&](uint32_t index) { return policySample(policy, index); };
    const SampleOffset plain = sampleAt(sampleNumber());
    const auto withinPixel = [](int offset_fx8) { return ((offset_fx8 + 128) & 255) - 128; };
    for (uint32_t i = 0; i < policyPeriod(policy); ++i) {
        const SampleOffset offset = sampleAt(i);
        offsets.push_back({withinPixel(offset.x_fx8 + result_.jitter.x_fx8 - plain.x_fx8),
                           withinPixel(offset.y_fx8 + result_.jitter.y_fx8 - plain.y_fx8)});
    }
    return offsets;
}

}  // namespace still::inspect
