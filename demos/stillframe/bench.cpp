#include "demos/stillframe/bench.h"

#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <thread>

#include "demos/scenes/bench_scenes.h"
#include "demos/stillframe/bench_report.h"
#include "demos/stillframe/clock.h"
#include "demos/stillframe/progress.h"
#include "demos/stillframe/report.h"
#include "demos/stillframe/scene_source.h"
#include "engine/load.h"

namespace still::command {
namespace {

constexpr int kMaxThreads = 256;

/// The options with every question answered.
struct Plan {
    std::vector<std::string> scenes;
    std::vector<int> threads;
    std::optional<CameraFile> cameras;
    FrameSettings settings;
    int frames = 0;
    bool quiet = false;
    Limits limits;
};

std::vector<std::string> defaultScenes() {
    std::vector<std::string> scenes;
    for (const std::string& name : benchSceneNames()) {
        scenes.push_back("builtin:" + name);
    }
    if (const char* data = std::getenv("STILL_DATA")) {
        const auto sponza = std::filesystem::path(data) / "sponza" / "scene.json";
        std::error_code error;
        if (std::filesystem::exists(sponza, error)) {
            scenes.push_back(sponza.string());
        }
    }
    return scenes;
}

Outcome<void> readCameras(const BenchOptions& options, Plan& plan) {
    if (options.cameras.empty()) {
        return {};
    }
    return fromResult(loadCameraFile(options.cameras)).map([&](CameraFile cameras) {
        printWarnings(cameras.warnings, options.quiet);
        plan.cameras = std::move(cameras);
    });
}

Outcome<void> settle(const BenchOptions& options, Plan& plan) {
    plan.scenes = options.scenes.empty() ? defaultScenes() : options.scenes;
    plan.frames = options.frames;
    plan.quiet = options.quiet;
    plan.limits = options.limits;
    return parseThreads(options.threads)
        .map([&](std::vector<int> threads) { plan.threads = std::move(threads); })
        .and_then([&] { return parseSimd(options.simd); })
        .map([&](SimdTarget simd) { plan.settings.simd = simd; })
        .and_then([&] { return readCameras(options, plan); })
        .map([&] {
            const Size usual =
                plan.cameras ? Size{plan.cameras->width, plan.cameras->height} : Size{1920, 1080};
            const Size size = options.resolution.value_or(usual);
            plan.settings.width = size.width;
            plan.settings.height = size.height;
            plan.settings.clock_ms = nowMs;
            plan.settings.ticks = nowTicks;
        });
}

/// The scene as it moves, or empty when it has no such motion. Loaded anew for each motion, so that
/// there is one copy in memory.
Outcome<std::optional<Scene>> openMoving(const Plan& plan, const std::string& name,
                                         BenchMotion motion) {
    return openScene(name, loadOptions(plan.limits, {})).map([&](Scene scene) {
        if (motion == kBenchMotions[0]) {
            printWarnings(scene.warnings, plan.quiet);
        }
        frameForAspect(scene, plan.settings.width, plan.settings.height);
        if (plan.cameras) {
            scene.camera_file = plan.cameras;
        }
        return benchScene(std::move(scene), motion, plan.settings.height);
    });
}

Outcome<BenchReport> measure(const Plan& plan) {
    BenchReport report;
    const ProgressBar progress(int(plan.scenes.size() * std::size(kBenchMotions)), plan.quiet);
    int done = 0;
    for (const std::string& name : plan.scenes) {
        for (BenchMotion motion : kBenchMotions) {
            const auto scene = openMoving(plan, name, motion);
            if (!scene) {
                progress.clear();
                return tl::make_unexpected(scene.error());
            }
            if (*scene) {
                if (const auto fits = checkFrameMemory(name, **scene, plan.settings, plan.limits,
                                                       int(plan.threads.size()));
                    !fits) {
                    progress.clear();
                    return tl::make_unexpected(fits.error());
                }
                auto results = measureCase({.scene = name,
                                            .motion = still::name(motion),
                                            .content = &**scene,
                                            .settings = plan.settings,
                                            .threads = plan.threads,
                                            .frames = plan.frames});
                report.results.insert(report.results.end(),
                                      std::make_move_iterator(results.begin()),
                                      std::make_move_iterator(results.end()));
            }
            progress.show(++done);
        }
    }
    report.machine = measureMachine(plan.threads);
    return report;
}

}  // namespace

Outcome<std::vector<int>> parseThreads(const std::string& text) {
    if (text.empty()) {
        return std::vector<int>{std::max(1, int(std::thread::hardware_concurrency()))};
    }
    std::vector<int> threads;
    const char* at = text.data();
    const char* end = at + text.size();
    for (;;) {
        int count = 0;
        const auto [stop, error] = std::from_chars(at, end, count);
        if (error != std::errc() || count < 1 || count > kMaxThreads) {
            break;
        }
        threads.push_back(count);
        if (stop == end) {
            return threads;
        }
        if (*stop != ',') {
            break;
        }
        at = stop + 1;
    }
    return usageError("--threads: " + text + ": expected numbers from 1 to 256 with commas");
}

Outcome<void> bench(const BenchOptions& options) {
    Plan plan;
    return settle(options, plan).and_then([&] { return measure(plan); }).and_then([&](auto report) {
        return print(options.json ? benchJson(report) : benchLines(report));
    });
}

}  // namespace still::command
