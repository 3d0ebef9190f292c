#include "demos/stillframe/chart.h"

#include <algorithm>
#include <filesystem>
#include <list>
#include <thread>

#include "demos/scenes/bench_scenes.h"
#include "demos/stillframe/chart_report.h"
#include "demos/stillframe/file_cache.h"
#include "demos/stillframe/progress.h"
#include "demos/stillframe/report.h"
#include "demos/stillframe/scene_source.h"
#include "demos/stillframe/whole_file.h"
#include "engine/load.h"

namespace still::command {
namespace {

/// A still segment has one reference only, so it may be a better one.
constexpr int kStillSampleFactor = 4;

/// Among allModes(), behind raw and fxaa.
constexpr size_t kFirstPreset = 2;

/// A scene on the chart. Its segments point into it, so it stays where it was made.
struct ChartScene {
    std::string name;
    Scene moving, still;
};

Outcome<void> openScenes(const ChartOptions& options, std::list<ChartScene>& scenes) {
    const std::filesystem::path cache =
        options.cache.empty() ? usersCacheFolder() : std::filesystem::path(options.cache);
    for (const std::string& text : options.scenes) {
        auto opened = openScene(text, loadOptions(options.limits, cache), options.lights);
        if (!opened) {
            return tl::make_unexpected(opened.error());
        }
        printWarnings(opened->warnings, options.quiet);
        const Size& size = options.resolution;
        if (auto fits = checkFrameMemory(
                text, *opened, {.width = size.width, .height = size.height}, options.limits);
            !fits) {
            return fits;
        }
        frameForAspect(*opened, options.resolution.width, options.resolution.height);
        std::string name = plainName(text);
        const auto taken = [&](const ChartScene& scene) { return scene.name == name; };
        for (int i = 2; std::any_of(scenes.begin(), scenes.end(), taken); ++i) {
            name = plainName(text) + "-" + std::to_string(i);
        }
        Scene still = frozen(*opened);
        scenes.push_back({name, std::move(*opened), std::move(still)});
    }
    return {};
}

std::vector<ChartSegment> segmentsOf(const std::list<ChartScene>& scenes,
                                     const ChartOptions& options) {
    std::vector<ChartSegment> segments;
    for (const ChartScene& scene : scenes) {
        FrameSettings view{.width = options.resolution.width, .height = options.resolution.height};
        segments.push_back({scene.name, "still", &scene.still, view, options.frames,
                            kStillSampleFactor * options.reference_samples});
        view.camera = {.orbit_deg = options.orbit_deg, .orbit_frames = 1};
        segments.push_back(
            {scene.name, "moving", &scene.moving, view, options.frames, options.reference_samples});
    }
    return segments;
}

/// Where light is sampled, also what is not denoised.
std::vector<Mode> chartModes(const Scene& scene) {
    std::vector<Mode> modes = allModes();
    if (scene.lights.sampled()) {
        for (const size_t i : {size_t{0}, kFirstPreset}) {
            Mode noisy = modes[i];
            noisy.name += ":denoise=off";
            noisy.denoise = Denoise::off;
            modes.push_back(std::move(noisy));
        }
    }
    for (int samples : {2, 4, 8, 16}) {
        modes.push_back({.name = "ssaa:" + std::to_string(samples),
                         .anti_aliasing = AntiAliasing::ssaa,
                         .ssaa_samples = samples});
    }
    return modes;
}

std::vector<int> threadCounts() {
    const int cores = std::max(1, int(std::thread::hardware_concurrency()));
    return cores > 1 ? std::vector<int>{1, cores} : std::vector<int>{1};
}

Outcome<ChartReport> measure(const std::vector<ChartSegment>& segments, const ChartOptions& options,
                             const FileCache& cache) {
    const std::vector<int> threads = threadCounts();
    int steps = 0;
    for (const ChartSegment& segment : segments) {
        steps += chartSteps(segment, threads.size());
    }
    const ProgressBar progress(steps, options.quiet);
    int done = 0;
    ChartReport report{options.resolution.width, options.resolution.height, options.frames, {}};
    for (const ChartSegment& segment : segments) {
        auto points = measureSegment(segment, chartModes(*segment.content), threads, cache,
                                     [&] { progress.show(++done); });
        if (!points) {
            return tl::make_unexpected(points.error());
        }
        report.points.insert(report.points.end(), points->begin(), points->end());
    }
    return report;
}

Outcome<void> writeChart(const ChartReport& report, const std::list<ChartScene>& scenes,
                         const ChartOptions& options, Interruption& interruption) {
    const std::filesystem::path folder = options.output;
    std::vector<WholeFile> files{{folder / "chart.json", chartJson(report)},
                                 {folder / "chart.csv", chartCsv(report)}};
    for (const ChartScene& scene : scenes) {
        for (int threads : threadCounts()) {
            auto drawn = drawPlot(chartPlot(report, scene.name, threads));
            if (!drawn) {
                return tl::make_unexpected(drawn.error());
            }
            const std::string name = scene.name + "-" + std::to_string(threads) +
                                     (threads == 1 ? "-thread" : "-threads");
            files.push_back({folder / (name + ".svg"), std::move(drawn->svg)});
            files.push_back({folder / (name + ".png"), std::move(drawn->png)});
        }
    }
    return writeWholeFiles(files, interruption).and_then([&] {
        return options.json ? print(chartJson(report)) : Outcome<void>();
    });
}

}  // namespace

Outcome<void> chart(const ChartOptions& options, Interruption& interruption) {
    std::list<ChartScene> scenes;
    return openScenes(options, scenes)
        .and_then([&] { return tryFolder(options.output, interruption); })
        .and_then([&] { return FileCache::open(options.cache, interruption); })
        .and_then([&](const FileCache& cache) {
            return measure(segmentsOf(scenes, options), options, cache);
        })
        .and_then([&](const ChartReport& report) {
            return writeChart(report, scenes, options, interruption);
        });
}

}  // namespace still::command
