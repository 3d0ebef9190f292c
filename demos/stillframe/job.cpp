#include "demos/stillframe/job.h"

#include <algorithm>
#include <cmath>
#include <thread>

#include "demos/stillframe/file_cache.h"
#include "demos/stillframe/scene_source.h"
#include "engine/jitter.h"
#include "engine/load.h"

namespace still::command {
namespace {

/// Puts the value of `from` into `to`.
template <class T>
Outcome<void> store(Outcome<T> from, T& to) {
    return std::move(from).map([&](T value) { to = std::move(value); });
}

/// Options that exclude or need each other.
Outcome<void> checkCombination(const Job& job) {
    const RenderOptions& options = job.options;
    const bool to_stdout = job.sink == SinkKind::standard_output;
    if (job.sink == SinkKind::none && !options.hash && !options.json) {
        return usageError("render: expected --output, --hash or --json");
    }
    if (to_stdout && (options.hash || options.json)) {
        return usageError(
            "--output -: the picture takes standard output, so neither --hash nor "
            "--json can have it");
    }
    if (!job.dump.empty() && (to_stdout || job.sink == SinkKind::none)) {
        return usageError("--dump: expected an --output file, whose name the planes' names follow");
    }
    const bool temporal = job.settings.anti_aliasing == AntiAliasing::taa;
    if (!temporal && !options.taa.empty()) {
        return usageError("--taa: is for --anti-aliasing taa");
    }
    const bool confidence = std::count(job.dump.begin(), job.dump.end(), DumpPlane::confidence) > 0;
    if (confidence && !temporal) {
        return usageError("--dump: confidence exists with --anti-aliasing taa only");
    }
    if (!std::isfinite(options.orbit_deg)) {
        return usageError("--orbit: expected a finite number of degrees");
    }
    if (!options.cameras.empty() && (!options.view.empty() || options.orbit_deg != 0)) {
        return usageError("--cameras: excludes --view and --orbit");
    }
    return {};
}

/// The options' values, before any file is touched.
Outcome<void> settleOptions(Job& job) {
    const RenderOptions& options = job.options;
    FrameSettings& settings = job.settings;
    settings.shading = options.shading == "forward" ? Shading::forward : Shading::deferred;
    settings.tone_map = options.tone_map == "reinhard" ? ToneMap::reinhard : ToneMap::none;
    const int cores = std::max(1, int(std::thread::hardware_concurrency()));
    job.threads = options.threads > 0 ? options.threads : cores;
    AntiAliasingChoice choice;
    return store(sinkKind(options.output), job.sink)
        .and_then([&] { return store(parseDump(options.dump), job.dump); })
        .and_then([&] { return store(parseSimd(options.simd), settings.simd); })
        .and_then([&] { return store(parseAntiAliasing(options.anti_aliasing), choice); })
        .and_then([&] { return parseTaaSettings(options.taa, choice.policy); })
        .map([&](const TaaPolicy& policy) {
            settings.anti_aliasing = choice.mode;
            settings.ssaa_samples = choice.ssaa_samples;
            settings.policy = policy;
            job.preset = choice.preset;
        })
        .and_then([&] { return checkCombination(job); });
}

Outcome<void> readCameras(Job& job) {
    if (job.options.cameras.empty()) {
        return {};
    }
    return store(fromResult(loadCameraFile(job.options.cameras)), job.cameras).map([&] {
        printWarnings(job.cameras.warnings);
        job.settings.camera.file = &job.cameras;
    });
}

Outcome<void> readFiles(Job& job) {
    const auto cache = job.options.no_cache ? std::filesystem::path() : usersCacheFolder();
    return store(openScene(job.options.scene, cache), job.scene)
        .map([&] { printWarnings(job.scene.warnings); })
        .and_then([&] { return readCameras(job); });
}

Outcome<int> findView(const Scene& scene, const std::string& name) {
    if (name.empty()) {
        return -1;
    }
    std::string known;
    for (size_t i = 0; i < scene.views.size(); ++i) {
        if (scene.views[i].name == name) {
            return int(i);
        }
        known += (i == 0 ? "" : ", ") + scene.views[i].name;
    }
    return usageError("--view: " + name + ": the scene has " +
                      (known.empty() ? "no views" : "the views " + known));
}

/// Size, number of frames and camera: typed ones before those of the camera file.
Outcome<void> settleView(Job& job) {
    const RenderOptions& options = job.options;
    FrameSettings& settings = job.settings;
    const Outcome<void> view = store(findView(job.scene, options.view), settings.camera.view);
    if (!view) {
        return view;
    }
    settings.camera.orbit_deg = options.orbit_deg;
    if (const CameraFile* file = cameraFileOf(job.scene, settings.camera)) {
        settings.width = file->width;
        settings.height = file->height;
        job.frames = int(file->frames.size());
    }
    const Size size = options.resolution.value_or(Size{settings.width, settings.height});
    settings.width = size.width;
    settings.height = size.height;
    job.start = options.start.value_or(0);
    job.frames = options.frames.value_or(job.frames);
    frameForAspect(job.scene, size.width, size.height);
    settings.camera.orbit_frames = options.orbit_frames.value_or(job.frames);
    return {};
}

/// A single picture of something that stands still is finished before it is handed out, unless it
/// is part of a run.
Outcome<void> settleSamples(Job& job) {
    const bool alone = job.frames == 1 && job.settings.anti_aliasing == AntiAliasing::taa &&
                       isStill(job.scene, job.settings.camera);
    if (alone && (job.options.samples || !job.options.start)) {
        job.settings.subframes = job.options.samples.value_or(int(kTaaPeriod));
    } else if (job.options.samples) {
        return usageError(
            "--samples: is for one frame with --anti-aliasing taa in which nothing "
            "moves");
    }
    return {};
}

/// Planes that TAA does not ask for by itself.
void settlePlanes(Job& job) {
    job.settings.fresh_gbuffer = job.options.hash || !job.dump.empty();
    job.settings.planes = {.normal = job.options.hash, .motion = job.options.hash};
    for (DumpPlane plane : job.dump) {
        job.settings.planes.normal |= plane == DumpPlane::normal;
        job.settings.planes.motion |= plane == DumpPlane::motion;
    }
}

Outcome<void> settleOutput(Job& job) {
    if (job.sink == SinkKind::none) {
        return {};
    }
    if (job.sink == SinkKind::standard_output) {
        return job.frames == 1 ? Outcome<void>() : usageError("--output -: takes one frame only");
    }
    if (auto stored = store(NamePattern::parse(job.options.output), job.name); !stored) {
        return stored;
    }
    if (job.sink != SinkKind::png && job.name.numbered()) {
        return usageError("--output: " + job.options.output +
                          ": all frames go into one file, so its name takes no number");
    }
    if (job.sink == SinkKind::png && job.frames > 1) {
        job.name = job.name.withNumber();
    }
    return {};
}

}  // namespace

Outcome<void> prepare(Job& job) {
    return settleOptions(job)
        .and_then([&] { return readFiles(job); })
        .and_then([&] { return settleView(job); })
        .and_then([&] { return settleSamples(job); })
        .and_then([&] { return settleOutput(job); })
        .map([&] { settlePlanes(job); });
}

}  // namespace still::command
