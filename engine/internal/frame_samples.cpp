// One sample a pixel, rasterized: what a frame's settings need of it, and nothing else. And frames
// that depend on no other.

#include <algorithm>

#include "engine/internal/frame_loop_state.h"

namespace still {

/// Nothing is computed that the policy does not use.
RasterSettings FrameLoop::State::rasterSettings() const {
    RasterSettings raster{
        .simd = settings.simd, .shading = settings.shading, .planes = settings.planes};
    raster.ticks = settings.ticks;
    if (temporal()) {
        const TaaPolicy& policy = settings.policy;
        raster.planes.motion = true;
        raster.planes.normal |= gathers() || policy.normal_reject_q15 > 0;
        raster.mip_bias_fx8 = mipBias_fx8(policy);
        raster.camera_motion_only = !gathers() && policy.motion == MotionSource::camera;
    }
    if (light != nullptr) {
        raster.planes.normal = raster.planes.albedo = true;
        raster.planes.motion |= denoises();
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
    const FrameView view{.width = renderedWidth(),
                         .height = renderedHeight(),
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
        // Sampled light changes anywhere, and is filtered over the borders of tiles.
        if (evidence != nullptr && !rest && light == nullptr) {
            wanted = plan(facts, *evidence);
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
    if (light != nullptr) {
        addLight(list, view, frame.cut);
    }
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

}  // namespace still
