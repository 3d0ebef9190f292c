// One frame: FrameState → (sub-frames or ssaa samples: transform, bin, raster, resolve or filter)
// → encode.

#include "engine/frame_loop.h"

#include <algorithm>
#include <cassert>

#include "engine/internal/camera_drift.h"
#include "engine/jitter.h"
#include "postfx/laboratory.h"
#include "postfx/sample_sums.h"
#include "postfx/sharpen.h"
#include "postfx/spatial.h"

namespace still {
namespace {

constexpr int kNoFrame = -2;
constexpr int kRowGrain = 16;

struct ColourImages {
    Image<uint16_t> red, green, blue;
};

ColourPlanes planesOf(const GBuffer& gbuffer) {
    return {gbuffer.red.view(), gbuffer.green.view(), gbuffer.blue.view()};
}

}  // namespace

struct FrameLoop::State {
    State(const Scene& scene_in, const FrameSettings& settings_in, Workers& workers_in)
        : scene(scene_in),
          settings(settings_in),
          workers(workers_in),
          table(settings.tone_map, settings.exposure) {
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
    Taa taa;                ///< Method::gather
    Laboratory laboratory;  ///< Method::recursive
    SpatialFilter spatial;
    GBuffer gbuffer;        ///< what is resolved; tiles that nothing new is in keep earlier samples
    GBuffer fresh;          ///< FrameSettings::fresh_gbuffer, in frames that `gbuffer` has parts of
    bool in_parts = false;  ///< this is such a frame
    OutputTable table;
    Image<Rgb8> output;
    ColourSums sums;
    ColourImages filtered;      ///< mean of ssaa samples, or after spatial filter or sharpening
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
    bool hasStory() const { return temporal() && !gbuffer.red.empty(); }
    bool gathers() const { return settings.policy.method == Method::gather; }
    bool sharpens() const { return temporal() && settings.policy.sharpness_q15 > 0; }
    int sampleCap() const { return int(jitterPeriod(settings.policy.jitter)); }
    /// Samples that are averaged; 1 when there is nothing to average.
    int ssaaSamples() const {
        return settings.anti_aliasing == AntiAliasing::ssaa ? settings.ssaa_samples : 1;
    }
    int historyStart(int frame) const;
    uint32_t sampleOf(int frame, int subframe) const;
    RasterSettings rasterSettings() const;
    void rasterizeSample(const FrameState& frame, SampleOffset offset, uint32_t sample,
                         const TaaFrame* evidence = nullptr, bool rest = false);
    void addRasterTimes(const StageTimes& sample);
    void followCamera(const FrameState& frame);
    SampleOffset offsetOf(const FrameState& frame, uint32_t sample) const;
    TaaSettings taaSettings() const;
    bool rests(const FrameState& frame);
    void resolve(const FrameState& frame, const TaaFrame& evidence);
    void resolveFrame(int frame, bool looked_at);
    void resolveHistory(int frame);
    ColourTargets resizeFiltered();
    ColourPlanes resolved() const;
    ImageView<const uint8_t> fullConfidence();
    void sharpenResolved();
    void averageSamples(const FrameState& frame);
    void filterSample();
    void renderAlone(int frame);
    ColourPlanes colour() const;
    void encode();
    FrameResult result() const;
};

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

/// Nothing is computed that the policy does not use.
RasterSettings FrameLoop::State::rasterSettings() const {
    RasterSettings raster{
        .simd = settings.simd, .shading = settings.shading, .planes = settings.planes};
    raster.ticks = settings.ticks;
    if (temporal()) {
        const TaaPolicy& policy = settings.policy;
        raster.planes.motion = true;
        raster.planes.normal |= gathers() || policy.normal_reject_q15 > 0;
        raster.mip_bias_fx8 = policy.mip_bias_fx8;
        raster.camera_motion_only = !gathers() && policy.motion == MotionSource::camera;
    }
    return raster;
}

/// With `evidence`, only what the gather's resolve() will read of it; at rest that is nothing.
void FrameLoop::State::rasterizeSample(const FrameState& frame, SampleOffset offset,
                                       uint32_t sample, const TaaFrame* evidence, bool rest) {
    const DrawList list{.meshes = scene.meshes,
                        .materials = materialsOf(scene, frame),
                        .textures = scene.textures,
                        .alpha_textures = scene.alpha_textures,
                        .instances = frame.instances,
                        .windings = windings,
                        .lighting = frame.lighting,
                        .background = settings.background.value_or(scene.background)};
    const FrameView view{.width = settings.width,
                         .height = settings.height,
                         .view_projection = frame.camera.view_projection,
                         .view_projection_before = frame.camera_before.view_projection,
                         .eye = glm::vec3(frame.camera.eye),
                         .jitter_x_fx8 = offset.x_fx8,
                         .jitter_y_fx8 = offset.y_fx8,
                         .sample = sample};
    jitter = offset;
    std::span<const uint8_t> wanted;
    StageTimes sample_times;
    timed(sample_times.transform_bin_ms, [&] {
        const auto facts = rasterizer.setUp(list, view, rasterSettings());
        if (evidence != nullptr && !rest) {
            wanted = taa.plan(settings.width, settings.height, facts, *evidence, taaSettings());
        }
        rasterizer.transformAndBin(workers);
    });
    in_parts = rest || std::find(wanted.begin(), wanted.end(), 0) != wanted.end();
    timed(sample_times.raster_ms, [&] {
        if (!rest) {
            rasterizer.rasterize(gbuffer, workers, wanted);
        }
        if (in_parts && settings.fresh_gbuffer) {
            rasterizer.rasterize(fresh, workers);
        }
    });
    addRasterTimes(sample_times);
    counters = rasterizer.counters();
}

/// Adds one sample's times, each divided by what the workers did meanwhile.
void FrameLoop::State::addRasterTimes(const StageTimes& sample) {
    const StageTicks& ticks = rasterizer.counters().ticks;
    const auto divide = [](double time_ms, uint64_t a, uint64_t b, double& a_ms, double& b_ms) {
        if (a + b > 0) {
            a_ms += time_ms * double(a) / double(a + b);
            b_ms += time_ms * double(b) / double(a + b);
        }
    };
    times.transform_bin_ms += sample.transform_bin_ms;
    times.raster_ms += sample.raster_ms;
    divide(sample.transform_bin_ms, ticks.transform, ticks.bin, times.transform_ms, times.bin_ms);
    divide(sample.raster_ms, ticks.visibility, ticks.shade, times.visibility_ms, times.shade_ms);
}

/// Later sub-frames of a frame see the same instant: nothing has moved since the one before.
static void freeze(FrameState& frame) {
    frame.cut = false;
    frame.lighting_changed = false;
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
    drift = follows ? driftAfter(drift, frame.camera, frame.camera_before, settings.width,
                                 settings.height)
                    : SampleOffset{};
}

/// Where the sample lies: a camera file's word goes before the policy's pattern.
SampleOffset FrameLoop::State::offsetOf(const FrameState& frame, uint32_t sample) const {
    if (frame.jitter_fx8 && settings.subframes == 1) {
        return {(*frame.jitter_fx8)[0], (*frame.jitter_fx8)[1]};
    }
    const TaaPolicy& policy = settings.policy;
    const SampleOffset offset =
        jitterSample(policy.jitter, policy.jitter_scale_fx8, policy.scramble, sample);
    return {withinPixel(offset.x_fx8 - drift.x_fx8), withinPixel(offset.y_fx8 - drift.y_fx8)};
}

TaaSettings FrameLoop::State::taaSettings() const {
    return {.simd = settings.simd, .sample_cap = sampleCap(), .ring = settings.policy.ring};
}

static bool nothingHappens(const FrameState& frame) {
    return !frame.cut && !frame.lighting_changed && frame.changed_surfaces.empty() &&
           frame.camera.view_projection == frame.camera_before.view_projection &&
           std::none_of(frame.instances.begin(), frame.instances.end(),
                        [](const Instance& instance) { return instance.moved; });
}

/// Whether the frame leaves a finished picture as it is. Then neither geometry nor pixels are
/// touched.
bool FrameLoop::State::rests(const FrameState& frame) {
    return gathers() && nothingHappens(frame) && taa.rest(taaSettings());
}

/// Takes the sample that was just rasterized into the history.
void FrameLoop::State::resolve(const FrameState& frame, const TaaFrame& evidence) {
    if (gathers()) {
        taa.resolve(gbuffer, evidence, taaSettings(), workers);
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
    FrameState state = frameStateAt(scene, settings.camera, frame, settings.width, settings.height);
    // Sessions grow long: the way back to their last cut is not gone in every frame.
    const bool goes_on = resolved_frame == frame - 1 && !state.cut && frame != resize_frame;
    history_start = goes_on ? history_start : historyStart(frame);
    state.cut |= frame == history_start;
    for (int i = 0; i < settings.subframes; ++i) {
        const uint32_t sample = sampleOf(frame, i);
        followCamera(state);
        const SampleOffset offset = offsetOf(state, sample);
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
        if (!rest || settings.fresh_gbuffer) {
            rasterizeSample(state, offset, sample, gathers() ? &evidence : nullptr, rest);
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
    for (int replayed = first; replayed <= frame; ++replayed) {
        times = {};
        resolveFrame(replayed, replayed == frame);
    }
    if (sharpens() && !shown) {
        timed(times.taa_ms, [&] { sharpenResolved(); });
    }
}

ColourTargets FrameLoop::State::resizeFiltered() {
    for (Image<uint16_t>* plane : {&filtered.red, &filtered.green, &filtered.blue}) {
        plane->resize(settings.width, settings.height);
    }
    return {filtered.red.view(), filtered.green.view(), filtered.blue.view()};
}

void FrameLoop::State::averageSamples(const FrameState& frame) {
    const uint32_t count = uint32_t(ssaaSamples());
    sums.resize(settings.width, settings.height);
    for (uint32_t i = 0; i < count; ++i) {
        rasterizeSample(frame, ssaaSample(i, count), i);
        timed(times.taa_ms, [&] { sums.add(planesOf(gbuffer), i == 0, workers); });
    }
    const ColourTargets mean = resizeFiltered();
    timed(times.taa_ms, [&] { sums.average(count, mean, workers); });
}

void FrameLoop::State::filterSample() {
    const ColourTargets targets = resizeFiltered();
    timed(times.taa_ms, [&] {
        spatial.run(spatialInput(gbuffer, 0, 0),
                    {.edges = SpatialEdges::colour, .simd = settings.simd}, targets, workers);
    });
}

/// A frame that depends on no other.
void FrameLoop::State::renderAlone(int frame) {
    const FrameState state =
        frameStateAt(scene, settings.camera, frame, settings.width, settings.height);
    if (ssaaSamples() > 1) {
        averageSamples(state);
        return;
    }
    const bool reference = settings.anti_aliasing == AntiAliasing::ssaa;
    history_start = reference ? 0 : historyStart(frame);
    rasterizeSample(state, {}, reference ? 0 : sampleOf(frame, 0));
    if (settings.anti_aliasing == AntiAliasing::fxaa) {
        filterSample();
    }
}

ColourPlanes FrameLoop::State::resolved() const {
    return gathers() ? taa.colour() : laboratory.colour();
}

/// Confidence with 255 as full. A pixel that has all its samples is fully known.
ImageView<const uint8_t> FrameLoop::State::fullConfidence() {
    if (!gathers()) {
        return laboratory.confidence();
    }
    const ImageView<const uint8_t> counts = taa.sampleCount();
    const int cap = sampleCap();
    confidence.resize(counts.width, counts.height);
    const ImageView<uint8_t> scaled = confidence.view();
    workers.parallelFor(counts.height, kRowGrain, [&](int begin, int end, int) {
        for (int y = begin; y < end; ++y) {
            for (int x = 0; x < counts.width; ++x) {
                scaled.row(y)[x] = uint8_t(counts.row(y)[x] * 255 / cap);
            }
        }
    });
    return scaled;
}

void FrameLoop::State::sharpenResolved() {
    sharpen(resolved(), fullConfidence(), settings.policy.sharpness_q15, resizeFiltered(),
            settings.simd, workers);
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
    const bool by_tile = temporal() && gathers() && !sharpens();
    encodeOutput(colour(), table, output.view(), workers,
                 by_tile ? taa.changedTiles() : std::span<const uint8_t>());
    taa.forgetChanges();
}

FrameResult FrameLoop::State::result() const {
    FrameResult result;
    result.output = output.view();
    result.linear = colour();
    result.gbuffer = in_parts && settings.fresh_gbuffer ? &fresh : &gbuffer;
    result.jitter = jitter;
    result.times = times;
    if (temporal() && gathers()) {
        result.sample_count = taa.sampleCount();
        result.confidence = result.sample_count;
        result.confidence_full = sampleCap();
        result.converged = taa.converged();
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

FrameResult FrameLoop::render(int frame) {
    assert(frame >= 0);
    State& state = *state_;
    state.times = {};
    if (state.resized) {
        state.resize_frame = frame;
        state.resized = false;
    }
    if (state.temporal()) {
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
    if (s.temporal() && s.gathers()) {
        return s.taa.tileWork();
    }
    return std::vector<TileWork>(s.gbuffer.tiles.size(), {.drawn = true, .resolved = true});
}

}  // namespace still
