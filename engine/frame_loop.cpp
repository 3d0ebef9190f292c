// One frame: FrameState → (sub-frames or ssaa samples: transform, bin, raster, resolve) → encode.

#include "engine/frame_loop.h"

#include <cassert>

#include "engine/jitter.h"

namespace still {
namespace {

constexpr int kNoFrame = -2;
constexpr int kRowGrain = 16;

/// Per-channel sums of up to 65536 samples: 65536 · 65535 fits 32 bits.
struct ColourSums {
    Image<uint32_t> red, green, blue;
};
struct ColourImages {
    Image<uint16_t> red, green, blue;
};

void addPlane(ImageView<const uint16_t> sample, bool first, ImageView<uint32_t> sum,
              Workers& workers) {
    workers.parallelFor(sum.height, kRowGrain, [&](int begin, int end, int) {
        for (int y = begin; y < end; ++y) {
            const uint16_t* from = sample.row(y);
            uint32_t* to = sum.row(y);
            for (int x = 0; x < sum.width; ++x) {
                to[x] = (first ? 0 : to[x]) + from[x];
            }
        }
    });
}

/// Rounded half up: count / 2 cannot carry past 32 bits, see ColourSums.
void averagePlane(ImageView<const uint32_t> sum, uint32_t count, ImageView<uint16_t> mean,
                  Workers& workers) {
    workers.parallelFor(sum.height, kRowGrain, [&](int begin, int end, int) {
        for (int y = begin; y < end; ++y) {
            const uint32_t* from = sum.row(y);
            uint16_t* to = mean.row(y);
            for (int x = 0; x < sum.width; ++x) {
                to[x] = uint16_t((from[x] + count / 2) / count);
            }
        }
    });
}

ColourPlanes planesOf(const GBuffer& gbuffer) {
    return {gbuffer.red.view(), gbuffer.green.view(), gbuffer.blue.view()};
}

}  // namespace

struct FrameLoop::State {
    State(const Scene& scene_in, const FrameSettings& settings_in, Workers& workers_in)
        : scene(scene_in), settings(settings_in), workers(workers_in), table(settings.tone_map) {}

    const Scene& scene;
    FrameSettings settings;
    Workers& workers;
    Rasterizer rasterizer;
    Taa taa;
    GBuffer gbuffer;
    OutputTable table;
    Image<Rgb8> output;
    ColourSums sums;
    ColourImages mean;
    StageTimes times;
    int resolved_frame = kNoFrame;  ///< the frame that the TAA history ends with

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

    void rasterizeSample(const FrameState& frame, SampleOffset offset, uint32_t sample);
    void resolveFrame(int frame);
    void resolveHistory(int frame);
    void averageSamples(int frame);
    ColourPlanes colour() const;
};

void FrameLoop::State::rasterizeSample(const FrameState& frame, SampleOffset offset,
                                       uint32_t sample) {
    const DrawList list{.meshes = scene.meshes,
                        .materials = materialsOf(scene, frame),
                        .textures = scene.textures,
                        .alpha_textures = scene.alpha_textures,
                        .instances = frame.instances,
                        .lighting = frame.lighting,
                        .background = scene.background};
    const FrameView view{.width = settings.width,
                         .height = settings.height,
                         .view_projection = frame.camera.view_projection,
                         .view_projection_before = frame.camera_before.view_projection,
                         .eye = glm::vec3(frame.camera.eye),
                         .jitter_x_fx8 = offset.x_fx8,
                         .jitter_y_fx8 = offset.y_fx8,
                         .sample = sample};
    PlaneSet planes = settings.planes;
    if (settings.anti_aliasing == AntiAliasing::taa) {
        planes = {.normal = true, .motion = true};
    }
    const RasterSettings raster{
        .simd = settings.simd, .shading = settings.shading, .planes = planes};
    timed(times.transform_bin_ms, [&] { rasterizer.transformAndBin(list, view, raster, workers); });
    timed(times.raster_ms, [&] { rasterizer.rasterize(gbuffer, workers); });
}

/// Later sub-frames of a frame see the same instant: nothing has moved since the one before.
static void freeze(FrameState& frame) {
    frame.cut = false;
    frame.lighting_changed = false;
    frame.changed_surfaces.clear();
    frame.camera_before = frame.camera;
    for (Instance& instance : frame.instances) {
        instance.transform_before = instance.transform;
        instance.moved = false;
    }
}

/// Renders one frame into the history, which must end with the frame before (or frame is a cut).
void FrameLoop::State::resolveFrame(int frame) {
    FrameState state = frameStateAt(scene, settings.camera, frame, settings.width, settings.height);
    const uint32_t since_cut = uint32_t(frame - lastCut(scene, frame));
    const uint32_t subframes = uint32_t(settings.subframes);
    for (uint32_t i = 0; i < subframes; ++i) {
        const uint32_t sample = since_cut * subframes + i;
        SampleOffset offset = taaSample(sample);
        if (state.jitter_fx8 && subframes == 1) {
            offset = {(*state.jitter_fx8)[0], (*state.jitter_fx8)[1]};
        }
        rasterizeSample(state, offset, sample);
        const TaaFrame evidence{.reset = state.cut, .shading_changed = state.lighting_changed};
        const TaaSettings taa_settings{.simd = settings.simd, .sample_cap = int(kTaaPeriod)};
        timed(times.taa_ms, [&] { taa.resolve(gbuffer, evidence, taa_settings, workers); });
        freeze(state);
    }
    resolved_frame = frame;
}

/// Brings the history to `frame`, from the last cut when it does not end right before.
void FrameLoop::State::resolveHistory(int frame) {
    const int first = resolved_frame == frame - 1 ? frame : lastCut(scene, frame);
    for (int replayed = first; replayed <= frame; ++replayed) {
        times = {};
        resolveFrame(replayed);
    }
}

void FrameLoop::State::averageSamples(int frame) {
    const FrameState state =
        frameStateAt(scene, settings.camera, frame, settings.width, settings.height);
    const bool single = settings.anti_aliasing == AntiAliasing::none;
    const uint32_t count = single ? 1 : uint32_t(settings.ssaa_samples);
    if (count == 1) {
        rasterizeSample(state, {}, single ? uint32_t(frame - lastCut(scene, frame)) : 0);
        return;
    }
    const auto resize = [&](auto& images) {
        images.red.resize(settings.width, settings.height);
        images.green.resize(settings.width, settings.height);
        images.blue.resize(settings.width, settings.height);
    };
    resize(sums);
    resize(mean);
    for (uint32_t i = 0; i < count; ++i) {
        rasterizeSample(state, ssaaSample(i, count), i);
        timed(times.taa_ms, [&] {
            addPlane(gbuffer.red.view(), i == 0, sums.red.view(), workers);
            addPlane(gbuffer.green.view(), i == 0, sums.green.view(), workers);
            addPlane(gbuffer.blue.view(), i == 0, sums.blue.view(), workers);
        });
    }
    timed(times.taa_ms, [&] {
        averagePlane(std::as_const(sums.red).view(), count, mean.red.view(), workers);
        averagePlane(std::as_const(sums.green).view(), count, mean.green.view(), workers);
        averagePlane(std::as_const(sums.blue).view(), count, mean.blue.view(), workers);
    });
}

ColourPlanes FrameLoop::State::colour() const {
    if (settings.anti_aliasing == AntiAliasing::taa) {
        return taa.colour();
    }
    const bool averaged = settings.anti_aliasing == AntiAliasing::ssaa && settings.ssaa_samples > 1;
    return averaged ? ColourPlanes{mean.red.view(), mean.green.view(), mean.blue.view()}
                    : planesOf(gbuffer);
}

FrameLoop::FrameLoop(const Scene& scene, const FrameSettings& settings, Workers& workers)
    : state_(std::make_unique<State>(scene, settings, workers)) {
    assert(settings.ssaa_samples >= 1 && settings.ssaa_samples <= 65536);
    assert(settings.subframes >= 1);
    resize(settings.width, settings.height);
}

FrameLoop::~FrameLoop() = default;

FrameResult FrameLoop::render(int frame) {
    assert(frame >= 0);
    State& state = *state_;
    state.times = {};
    const bool temporal = state.settings.anti_aliasing == AntiAliasing::taa;
    if (temporal) {
        state.resolveHistory(frame);
    } else {
        state.averageSamples(frame);
    }
    state.output.resize(state.settings.width, state.settings.height);
    state.timed(state.times.output_ms, [&] {
        encodeOutput(state.colour(), state.table, state.output.view(), state.workers);
    });
    FrameResult result;
    result.output = std::as_const(state.output).view();
    result.linear = state.colour();
    result.gbuffer = &state.gbuffer;
    result.times = state.times;
    if (temporal) {
        result.sample_count = state.taa.sampleCount();
        result.converged = state.taa.converged();
    }
    return result;
}

void FrameLoop::resize(int width, int height) {
    assert(width >= 1 && width <= kMaxTargetSize && height >= 1 && height <= kMaxTargetSize);
    state_->settings.width = width;
    state_->settings.height = height;
    state_->resolved_frame = kNoFrame;
}

const RasterCounters& FrameLoop::counters() const {
    return state_->rasterizer.counters();
}

}  // namespace still
