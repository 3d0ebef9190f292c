// Micro-benchmarks: the kernels of every stage, by instruction set, on the data that they meet in
// whole frames. One thread; times are those spent in the kernels' tasks alone.
//
//     bench_kernels [--quick] [--benchmark_filter=shade/] …
//
// With --quick a moment of everything, to see that it still runs.

#include <benchmark/benchmark.h>

#include <array>
#include <cstdlib>
#include <map>
#include <memory>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "demos/scenes/bench_scenes.h"
#include "demos/scenes/builtin.h"
#include "demos/stillframe/bench_scaling.h"
#include "engine/frame_loop.h"
#include "engine/load.h"
#include "engine/timeline.h"
#include "rasterizer/light_sampler.h"

namespace still {
namespace {

constexpr int kWarmUpFrames = 10;  // by then the TAA's ring is full

struct Extent {
    int width = 1280, height = 720, frames = 12;
};

/// What all benchmarks share. Scenes are made when they are first asked for.
class Fixture {
  public:
    explicit Fixture(const Extent& extent_in) : extent(extent_in) {}

    const Scene& scene(const std::string& name, BenchMotion motion) {
        const auto key = std::pair(name, motion);
        auto found = scenes_.find(key);
        if (found == scenes_.end()) {
            found =
                scenes_.emplace(key, *benchScene(*builtinScene(name), motion, extent.height)).first;
        }
        return found->second;
    }

    const Extent extent;
    Scene sponza;  ///< empty where it is not to be found

  private:
    std::map<std::pair<std::string, BenchMotion>, Scene> scenes_;
};

/// A scene under a loop of one thread.
class Stage {
  public:
    Stage(const Scene& scene, AntiAliasing anti_aliasing, SimdTarget simd, const Extent& extent) {
        FrameSettings settings;
        settings.width = extent.width;
        settings.height = extent.height;
        settings.anti_aliasing = anti_aliasing;
        settings.planes = {.normal = true, .motion = true};
        settings.simd = simd;
        settings.ticks = [] { return uint64_t(command::threadTimeMs() * 1e6); };
        loop_ = std::make_unique<FrameLoop>(scene, settings, workers_);
        workers_.observe(&recorder_);
        while (frame_ < kWarmUpFrames) {
            render();
        }
    }
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

    void render() {
        recorder_.beginFrame();
        loop_->render(frame_++);
        work_ = recorder_.endFrame();
    }

    const RasterCounters& counters() const { return loop_->counters(); }

    /// Seconds in the frame's sections, counted from the last.
    double sectionSeconds(size_t from_end) const {
        const auto& grains = work_.sections[work_.sections.size() - 1 - from_end];
        return std::accumulate(grains.begin(), grains.end(), 0.0) * 1e-3;
    }

  private:
    Workers workers_{1};
    command::WorkRecorder recorder_;
    command::FrameWork work_;
    std::unique_ptr<FrameLoop> loop_;
    int frame_ = 0;
};

/// Runs `seconds` after each frame for the time of that frame.
template <class Seconds>
void measure(benchmark::State& state, Stage& stage, double items, Seconds&& seconds) {
    for (auto _ : state) {
        stage.render();
        state.SetIterationTime(seconds());
    }
    state.SetItemsProcessed(int64_t(items * double(state.iterations())));
}

template <class Run>
void add(const std::string& name, const Extent& extent, Run&& run) {
    benchmark::RegisterBenchmark(name.c_str(), std::forward<Run>(run))
        ->Unit(benchmark::kMillisecond)
        ->UseManualTime()
        ->Iterations(extent.frames);
}

/// A stage of the rasterizer. Items are triangles or pixels.
void addRaster(const char* stage_name, uint64_t StageTicks::*ticks, bool pixels,
               const std::string& scene, SimdTarget simd, Fixture& fixture) {
    add(std::string(stage_name) + "/" + scene + "/" + std::string(name(simd)), fixture.extent,
        [=, &fixture](benchmark::State& state) {
            const Extent& extent = fixture.extent;
            Stage stage(fixture.scene(scene, BenchMotion::pan), AntiAliasing::none, simd, extent);
            const double items =
                pixels ? double(extent.width) * extent.height : double(stage.counters().triangles);
            measure(state, stage, items,
                    [&] { return double(stage.counters().ticks.*ticks) * 1e-9; });
        });
}

/// One of the last sections of a frame with TAA: 0 output, 1 gather, 2 record and sums.
void addSection(const char* stage_name, size_t from_end, BenchMotion motion, SimdTarget simd,
                Fixture& fixture) {
    add(std::string(stage_name) + "/courtyard/" + std::string(name(simd)), fixture.extent,
        [=, &fixture](benchmark::State& state) {
            const Extent& extent = fixture.extent;
            Stage stage(fixture.scene("courtyard", motion), AntiAliasing::taa, simd, extent);
            measure(state, stage, double(extent.width) * extent.height,
                    [&] { return stage.sectionSeconds(from_end); });
        });
}

/// Sampled light at one sample a pixel, all of it: points, rays, what they bring. Items are pixels
/// that a surface is in; each has a ray, and up to two more where a bounce hits.
struct TraceCase {
    const char* name;
    SampledLight light;
};

void addTrace(const TraceCase& effect, const std::string& scene_name, const Scene& scene,
              SimdTarget simd, const Extent& extent) {
    add(std::string("trace_") + effect.name + "/" + scene_name + "/" + std::string(name(simd)),
        extent, [=, &scene](benchmark::State& state) {
            FrameState frame = frameStateAt(scene, {}, 0, extent.width, extent.height);
            DrawList list{.meshes = scene.meshes,
                          .materials = materialsOf(scene, frame),
                          .textures = scene.textures,
                          .alpha_textures = scene.alpha_textures,
                          .instances = frame.instances,
                          .lighting = frame.lighting,
                          .background = scene.background};
            list.lighting.sampled = effect.light;
            FrameView view{.width = extent.width,
                           .height = extent.height,
                           .view_projection = frame.camera.view_projection,
                           .view_projection_before = frame.camera.view_projection,
                           .eye = glm::vec3(frame.camera.eye)};
            Workers workers(1);
            Rasterizer rasterizer;
            GBuffer gbuffer;
            rasterizer.transformAndBin(list, view, {.simd = simd, .planes = {.normal = true}},
                                       workers);
            rasterizer.rasterize(gbuffer, workers);
            LightSampler sampler;
            LightImages light;
            for (auto _ : state) {
                sampler.setUp(list, view, simd, workers);
                const double start_ms = command::threadTimeMs();
                sampler.sample(gbuffer, light, true, workers);
                state.SetIterationTime((command::threadTimeMs() - start_ms) * 1e-3);
                ++view.sample;
            }
            state.SetItemsProcessed(int64_t(rasterizer.counters().pixels_shaded) *
                                    int64_t(state.iterations()));
        });
}

/// Light of the courtyard's size, and ways of `distance` for occlusion.
std::vector<TraceCase> traceCases(std::array<float, 3> lamp, float radius, float distance) {
    return {
        {"sun", {.sun_shadow = SunShadow::traced, .sun_tangent = 0.02f}},
        {"sphere", {.spheres = {{lamp, radius, {1, 1, 1}}}}},
        {"occlusion", {.ambient = AmbientLight::traced_occlusion, .occlusion_distance = distance}},
        {"bounce",
         {.sun_shadow = SunShadow::traced, .sun_tangent = 0.02f, .ambient = AmbientLight::bounce}}};
}

/// Sponza from within, where STILL_DATA has it.
void addSponza(Fixture& fixture) {
    const char* data = std::getenv("STILL_DATA");
    if (data == nullptr) {
        return;
    }
    auto loaded = loadScene(std::string(data) + "/sponza/sponza.obj");
    if (!loaded) {
        return;
    }
    fixture.sponza = std::move(*loaded);
    Camera& camera = fixture.sponza.camera;
    camera.eye.keys = {{0, {1050, 180, -40}}};
    camera.target.keys = {{0, {-300, 330, -30}}};
    camera.fov_y_deg.keys = {{0, 60}};
    camera.near = 1.4;
    camera.far = 14000;
    fixture.sponza.lights.sun.direction = {0.2852f, -0.9507f, 0.1141f};
    for (const SimdTarget simd : availableSimdTargets()) {
        for (const TraceCase& effect : traceCases({-50, 900, -40}, 70, 200)) {
            addTrace(effect, "sponza", fixture.sponza, simd, fixture.extent);
        }
    }
}

void addAll(Fixture& fixture) {
    for (const SimdTarget simd : availableSimdTargets()) {
        for (const char* scene : {"courtyard", "bench-tiny"}) {
            addRaster("transform", &StageTicks::transform, false, scene, simd, fixture);
            addRaster("bin", &StageTicks::bin, false, scene, simd, fixture);
        }
        for (const char* scene : {"courtyard", "bench-tiny", "bench-fill-back"}) {
            addRaster("visibility", &StageTicks::visibility, true, scene, simd, fixture);
        }
        for (const char* scene : {"courtyard", "bench-fill-front"}) {
            addRaster("shade", &StageTicks::shade, true, scene, simd, fixture);
        }
        addSection("taa_record", 2, BenchMotion::pan, simd, fixture);
        addSection("taa_gather", 1, BenchMotion::pan, simd, fixture);
        addSection("taa_sums", 2, BenchMotion::still, simd, fixture);
    }
    addSection("output", 0, BenchMotion::pan, bestSimdTarget(), fixture);
    for (const SimdTarget simd : availableSimdTargets()) {
        for (const TraceCase& effect : traceCases({2, 5, 0}, 0.4f, 1)) {
            addTrace(effect, "courtyard", fixture.scene("courtyard", BenchMotion::still), simd,
                     fixture.extent);
        }
    }
    addSponza(fixture);
}

int run(int argc, char** argv) {
    Extent extent;
    std::vector<char*> arguments;
    for (int i = 0; i < argc; ++i) {
        if (std::string_view(argv[i]) == "--quick") {
            extent = {160, 90, 1};
        } else {
            arguments.push_back(argv[i]);
        }
    }
    int count = int(arguments.size());
    benchmark::Initialize(&count, arguments.data());
    if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) {
        return 2;
    }
    Fixture fixture(extent);
    addAll(fixture);
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}

}  // namespace
}  // namespace still

int main(int argc, char** argv) {
    return still::run(argc, argv);
}
