#include "demos/stillframe/atlas.h"

#include <list>

#include "demos/scenes/bench_scenes.h"
#include "demos/stillframe/atlas_page.h"
#include "demos/stillframe/atlas_summary.h"
#include "demos/stillframe/noise_table.h"
#include "demos/stillframe/report.h"
#include "demos/stillframe/scene_source.h"
#include "demos/stillframe/whole_file.h"
#include "engine/load.h"

namespace still::command {
namespace {

constexpr const char* kNoise = "noise";
constexpr const char* kNoisePresets = "raw:denoise=off,still:denoise=off,still";
constexpr const char* kNoiseBase = "raw:denoise=off";

std::string knownCases() {
    std::string known;
    for (const std::vector<AtlasCase>* suite : {&atlasCases(), &noiseCases()}) {
        for (const AtlasCase& atlas_case : *suite) {
            known += (known.empty() ? "" : ", ") + atlas_case.name;
        }
    }
    return known;
}

Outcome<void> chooseCases(const AtlasOptions& options, AtlasPlan& plan) {
    for (const std::string& name : splitAtCommas(options.scenes)) {
        const AtlasCase* found = findAtlasCase(name);
        if (found == nullptr) {
            return usageError("--scenes: " + name + ": expected names out of " + knownCases());
        }
        plan.cases.push_back(found);
    }
    for (const AtlasCase& atlas_case : plan.noise ? noiseCases() : atlasCases()) {
        if (options.scenes.empty() && !atlas_case.slow) {
            plan.cases.push_back(&atlas_case);
        }
    }
    return {};
}

/// People's own scenes as cases, kept in `own`.
Outcome<void> addModels(const AtlasOptions& options, std::list<AtlasCase>& own, AtlasPlan& plan) {
    if (!options.models.empty() && !plan.noise) {
        return usageError("--model: a case of --suite noise");
    }
    const std::filesystem::path cache =
        options.cache.empty() ? usersCacheFolder() : std::filesystem::path(options.cache);
    for (const std::string& name : options.models) {
        auto opened = openScene(name, loadOptions(options.limits, cache), options.lights);
        if (!opened) {
            return tl::make_unexpected(opened.error());
        }
        printWarnings(opened->warnings, options.quiet);
        frameForAspect(*opened, plan.resolution.width, plan.resolution.height);
        const std::string title = plainName(opened->name.empty() ? name : opened->name);
        const auto scene = std::make_shared<const Scene>(frozen(std::move(*opened)));
        own.push_back(settledNoise(title, name + ", standing still.", [scene] { return *scene; }));
        plan.cases.push_back(&own.back());
    }
    return {};
}

Outcome<std::optional<size_t>> placeOf(const std::string& name, const std::vector<Mode>& modes) {
    if (name.empty()) {
        return std::nullopt;
    }
    for (size_t i = 0; i < modes.size(); ++i) {
        if (modes[i].name == name) {
            return i;
        }
    }
    return usageError("--versus: " + name + ": expected one of the presets that are measured");
}

/// For people; nothing without a base.
std::string tableOf(const AtlasReport& report) {
    if (report.versus.empty()) {
        return {};
    }
    return report.noise ? noiseLines(noiseTableOf(report))
                        : summaryLines(summaryOf(report), report.versus);
}

/// All or none of the three: what cannot be written is found out before anything is renamed.
Outcome<void> writeAll(const AtlasOptions& options, const AtlasReport& report,
                       Interruption& interruption) {
    const std::filesystem::path folder = options.output;
    return writeWholeFiles({{folder / "index.html", atlasPage(report)},
                            {folder / "atlas.json", atlasJson(report)},
                            {folder / "atlas.csv", atlasCsv(report)}},
                           interruption);
}

}  // namespace

Outcome<void> atlas(const AtlasOptions& options, Interruption& interruption) {
    const bool noise = options.suite == kNoise;
    const auto either = [&](const std::string& typed, const char* of_noise) {
        return typed.empty() && noise ? std::string(of_noise) : typed;
    };
    AtlasPlan plan{.resolution = options.resolution,
                   .time_resolution = options.time_resolution.value_or(options.resolution),
                   .samples = options.samples > 0 ? options.samples : AtlasPlan::kMaxSamples,
                   .noise = noise,
                   .quiet = options.quiet};
    std::list<AtlasCase> own;
    for (const Size& size : {plan.resolution, plan.time_resolution}) {
        if (auto fits = checkFrameMemory("atlas", {}, {.width = size.width, .height = size.height},
                                         options.limits);
            !fits) {
            return fits;
        }
    }
    return chooseCases(options, plan)
        .and_then([&] { return parseModes(either(options.presets, kNoisePresets), "--presets"); })
        .map([&](std::vector<Mode> modes) { plan.modes = std::move(modes); })
        .and_then([&] { return placeOf(either(options.versus, kNoiseBase), plan.modes); })
        .map([&](std::optional<size_t> versus) { plan.versus = versus; })
        .and_then([&] { return tryFolder(options.output, interruption); })
        .and_then([&] { return addModels(options, own, plan); })
        .and_then([&] { return FileCache::open(options.cache, interruption); })
        .and_then([&](FileCache cache) { return measureAtlas(std::move(plan), std::move(cache)); })
        .and_then([&](const AtlasReport& report) {
            return writeAll(options, report, interruption).and_then([&] {
                return print(options.json ? atlasJson(report) : tableOf(report));
            });
        });
}

}  // namespace still::command
