#include "demos/stillframe/job.h"

#include <algorithm>
#include <initializer_list>
#include <set>
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

/// The first of the rules that is broken.
struct Rule {
    bool broken;
    const char* message;
};
Outcome<void> checkRules(std::initializer_list<Rule> rules) {
    for (const Rule& rule : rules) {
        if (rule.broken) {
            return usageError(rule.message);
        }
    }
    return {};
}

/// Where results go.
Outcome<void> checkOutputs(const Job& job) {
    const RenderOptions& options = job.options;
    const bool to_stdout = job.sink == SinkKind::standard_output;
    const bool to_file = job.sink != SinkKind::none && !to_stdout;
    const bool compares = !options.reference.empty();
    return checkRules({
        {job.sink == SinkKind::none && !options.hash && !options.json && !compares,
         "render: expected --output, --hash, --json or --reference"},
        {to_stdout && (options.hash || options.json),
         "--output -: the picture takes standard output, so neither --hash nor --json can have it"},
        {!job.dump.empty() && !to_file,
         "--dump: expected an --output file, whose name the planes' names follow"},
        {compares && job.sink != SinkKind::none && job.sink != SinkKind::png,
         "--reference: is for pictures, expected an --output NAME.png or none"},
        {options.no_background && !keepsAlpha(job.sink),
         "--no-background: expected --output NAME.png, NAME.apng or -, which can keep alpha"},
        {options.no_background && (options.hash || compares),
         "--no-background: excludes --hash and --reference, which know of no alpha"},
        {options.no_background && options.background.has_value(),
         "--no-background: excludes --background-color"},
        {options.watch && to_stdout, "--watch: expected an --output file"},
    });
}

/// Where one looks from, and how pixels are made.
Outcome<void> checkViews(const Job& job) {
    const RenderOptions& options = job.options;
    const bool temporal = job.settings.anti_aliasing == AntiAliasing::taa;
    const bool circles = options.orbit_deg != 0 || options.turntable;
    return checkRules({
        {!temporal && !options.taa.empty(), "--taa: is for --anti-aliasing taa"},
        {!temporal && std::count(job.dump.begin(), job.dump.end(), DumpPlane::confidence) > 0,
         "--dump: confidence exists with --anti-aliasing taa only"},
        {options.turntable && options.orbit_deg != 0,
         "--turntable: is an --orbit of 360 degrees, so it excludes another one"},
        {!options.cameras.empty() && (!options.view.empty() || circles),
         "--cameras: excludes --view, --orbit and --turntable"},
        {!options.cameras.empty() && (options.camera.any() || options.camera.up),
         "--cameras: excludes --up and the --camera options"},
    });
}

/// Scenes that are given together.
Outcome<void> checkScenes(const RenderOptions& options, SinkKind sink) {
    const auto& scenes = options.scenes;
    const auto stdins = std::count(scenes.begin(), scenes.end(), "-");
    const auto files = std::count_if(scenes.begin(), scenes.end(), [](const std::string& name) {
        return name != "-" && !name.starts_with("builtin:");
    });
    const auto checked = checkRules({
        {stdins > 1, "SCENE: standard input can be read only once"},
        {scenes.size() > 1 && sink == SinkKind::standard_output,
         "--output -: takes the pictures of one scene only"},
        {options.watch && files != std::ptrdiff_t(scenes.size()),
         "--watch: expected scenes that are files"},
    });
    if (!checked || scenes.size() < 2 || sink == SinkKind::none) {
        return checked;
    }
    std::set<std::string> outputs;
    for (const std::string& name : scenes) {
        const auto pattern = NamePattern::parse(options.output);
        if (!pattern) {
            return tl::make_unexpected(pattern.error());
        }
        const std::string output = pattern->withModel(modelName(name)).at(0).string();
        if (!outputs.insert(output).second) {
            return usageError("--output: " + options.output + ": several scenes would become " +
                              output + ", expected {model} in it and scenes of different names");
        }
    }
    return {};
}

/// The options' values, before any file is touched.
Outcome<void> settleOptions(Job& job) {
    const RenderOptions& options = job.options;
    FrameSettings& settings = job.settings;
    settings.shading = options.shading == "forward" ? Shading::forward : Shading::deferred;
    settings.tone_map = options.tone_map == "reinhard" ? ToneMap::reinhard : ToneMap::none;
    settings.exposure = exposureFactor(options.exposure_stops);
    settings.background = options.background;
    settings.denoise = options.denoise == "on" ? Denoise::svgf : Denoise::off;
    if (options.no_background) {
        settings.background = {0.0f, 0.0f, 0.0f};
    }
    const int cores = std::max(1, int(std::thread::hardware_concurrency()));
    job.threads = options.threads > 0 ? options.threads : cores;
    // Frames of a turntable lie so far apart that history is worth little.
    const bool alone = options.turntable && options.taa.empty();
    job.anti_aliasing = !options.anti_aliasing.empty() ? options.anti_aliasing
                        : alone                        ? "ssaa:16"
                                                       : "taa";
    AntiAliasingChoice choice;
    return store(sinkKind(options.output), job.sink)
        .and_then([&] { return store(parseDump(options.dump), job.dump); })
        .and_then([&] { return store(parseSimd(options.simd), settings.simd); })
        .and_then([&] { return store(parseAntiAliasing(job.anti_aliasing), choice); })
        .and_then([&] { return parseTaaSettings(options.taa, choice.policy); })
        .map([&](const TaaPolicy& policy) {
            settings.anti_aliasing = choice.mode;
            settings.ssaa_samples = choice.ssaa_samples;
            settings.policy = policy;
            job.preset = choice.preset;
        })
        .and_then([&] { return checkOutputs(job); })
        .and_then([&] { return checkViews(job); });
}

Outcome<void> readCameras(Job& job) {
    if (job.options.cameras.empty()) {
        return {};
    }
    return store(fromResult(loadCameraFile(job.options.cameras)), job.cameras).map([&] {
        printWarnings(job.cameras.warnings, job.options.quiet);
        job.settings.camera.file = &job.cameras;
    });
}

Outcome<void> readFiles(Job& job) {
    const auto cache = job.options.no_cache ? std::filesystem::path() : usersCacheFolder();
    return store(openScene(job.scene_name, loadOptions(job.options.limits, cache),
                           job.options.lights),
                 job.scene)
        .map([&] { printWarnings(job.scene.warnings, job.options.quiet); })
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

/// Size and number of frames: typed ones before those of the camera file.
void settleSize(Job& job) {
    constexpr int kTurntableFrames = 60;
    const RenderOptions& options = job.options;
    FrameSettings& settings = job.settings;
    if (const CameraFile* file = cameraFileOf(job.scene, settings.camera)) {
        settings.width = file->width;
        settings.height = file->height;
        job.frames = int(file->frames.size());
    }
    const Size size = options.resolution.value_or(Size{settings.width, settings.height});
    settings.width = size.width;
    settings.height = size.height;
    job.start = options.start.value_or(0);
    job.frames = options.frames.value_or(options.turntable ? kTurntableFrames : job.frames);
    settings.camera.orbit_frames = options.orbit_frames.value_or(job.frames);
}

Outcome<void> settleView(Job& job) {
    const RenderOptions& options = job.options;
    FrameSettings& settings = job.settings;
    const Outcome<void> view = store(findView(job.scene, options.view), settings.camera.view);
    if (!view) {
        return view;
    }
    settings.camera.orbit_deg = options.turntable ? 360 : options.orbit_deg;
    settleSize(job);
    if (options.camera.up) {
        setUpAxis(job.scene, *options.camera.up);
    }
    if (!options.camera.any()) {
        frameForAspect(job.scene, settings.width, settings.height);
        return {};
    }
    const int from = settings.camera.view;
    settings.camera.view = -1;
    return applyCamera(options.camera, from, settings.width, settings.height, job.scene);
}

/// A single picture of something that stands still is finished before it is handed out, unless it
/// is part of a run.
Outcome<void> settleSamples(Job& job) {
    const bool alone = job.frames == 1 && job.settings.anti_aliasing == AntiAliasing::taa &&
                       isStill(job.scene, job.settings.camera);
    if (alone && (job.options.samples || !job.options.start)) {
        job.settings.subframes =
            job.options.samples.value_or(finishingSamples(job.settings.policy));
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

/// The pattern with the model's name, and with a number when there are several frames.
Outcome<NamePattern> patternFor(const Job& job, const std::string& text) {
    return NamePattern::parse(text).map([&](const NamePattern& pattern) {
        const NamePattern named = pattern.withModel(modelName(job.scene_name));
        return job.frames > 1 ? named.withNumber() : named;
    });
}

Outcome<void> settleOutput(Job& job) {
    const RenderOptions& options = job.options;
    if (!options.reference.empty()) {
        auto pattern = patternFor(job, options.reference);
        if (!pattern) {
            return tl::make_unexpected(pattern.error());
        }
        job.reference = *pattern;
    }
    if (job.sink == SinkKind::none) {
        return {};
    }
    if (job.sink == SinkKind::standard_output) {
        return job.frames == 1 || !options.no_background
                   ? Outcome<void>()
                   : usageError(
                         "--no-background: several frames on standard output are Y4M, which "
                         "has no alpha; expected --output NAME.apng");
    }
    if (job.sink == SinkKind::png) {
        return store(patternFor(job, options.output), job.name);
    }
    const auto pattern = NamePattern::parse(options.output);
    if (!pattern) {
        return tl::make_unexpected(pattern.error());
    }
    if (pattern->numbered()) {
        return usageError("--output: " + options.output +
                          ": all frames go into one file, so its name takes no number");
    }
    job.name = pattern->withModel(modelName(job.scene_name));
    return {};
}

}  // namespace

Outcome<void> checkOptions(const RenderOptions& options) {
    Job job(options, {});
    return settleOptions(job).and_then([&] { return checkScenes(options, job.sink); });
}

Outcome<void> prepare(Job& job) {
    return settleOptions(job)
        .and_then([&] { return readFiles(job); })
        .and_then([&] { return settleView(job); })
        .and_then([&] { return settleSamples(job); })
        .and_then([&] { return settleOutput(job); })
        .map([&] { settlePlanes(job); });
}

}  // namespace still::command
