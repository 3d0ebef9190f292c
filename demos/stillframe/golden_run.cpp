#include "demos/stillframe/golden_run.h"

#include <algorithm>
#include <charconv>
#include <numeric>

#include "demos/scenes/builtin.h"
#include "demos/stillframe/file_cache.h"
#include "demos/stillframe/mode.h"
#include "demos/stillframe/options.h"
#include "demos/stillframe/scene_source.h"

namespace still::command {
namespace {

constexpr int kMaxShards = 1000000;

/// "I/N" into `options`.
Outcome<void> parseShard(const std::string& text, golden::Options& options) {
    const char* const end = text.data() + text.size();
    const auto [slash, error] = std::from_chars(text.data(), end, options.shard);
    if (error == std::errc() && slash != end && *slash == '/') {
        const auto [stop, error_n] = std::from_chars(slash + 1, end, options.shards);
        if (error_n == std::errc() && stop == end && options.shard >= 1 &&
            options.shard <= options.shards && options.shards <= kMaxShards) {
            return {};
        }
    }
    return usageError("--shard: " + text + ": expected I/N, part I of N, I from 1 to N");
}

Outcome<void> chooseCases(GoldenRun& run) {
    const auto chosen = golden::chosenCases(run.manifest, run.options);
    if (!chosen) {
        return usageError("--only: " + chosen.error().message);
    }
    run.cases = *chosen;
    return {};
}

void startProgress(GoldenRun& run, bool quiet) {
    const int frames = std::accumulate(
        run.cases.begin(), run.cases.end(), 0,
        [](int sum, const golden::Case* one) { return sum + int(one->frames.size()); });
    run.progress.emplace(std::max(1, frames), quiet);
    run.options.frame_done = [&run] { run.progress->show(++run.frames_done); };
}

}  // namespace

void GoldenRun::finish() {
    progress.reset();
    options.frame_done = {};
    printWarnings(warnings);
    warnings.clear();
}

Outcome<std::unique_ptr<GoldenRun>> openGolden(const GoldenOptions& options) {
    auto run = std::make_unique<GoldenRun>();
    run->options.only = splitAtCommas(options.only);
    run->options.threads = options.threads;
    run->options.builtin = builtinScene;
    run->options.cache_folder = usersCacheFolder();
    run->options.allow_outside = options.limits.allow_outside;
    run->options.max_memory_bytes = options.limits.max_memory_bytes;
    if (!options.quiet) {
        run->options.warn = [&warnings = run->warnings](const std::string& warning) {
            if (std::find(warnings.begin(), warnings.end(), warning) == warnings.end()) {
                warnings.push_back(warning);
            }
        };
    }
    return (options.shard.empty() ? Outcome<void>() : parseShard(options.shard, run->options))
        .and_then([&] { return parseSimd(options.simd); })
        .map([&](SimdTarget simd) { run->options.simd = simd; })
        .and_then([&] { return fromResult(golden::readManifest(options.folder)); })
        .map([&](golden::Manifest manifest) {
            run->manifest = std::move(manifest);
            if (!options.quiet) {
                run->warnings = run->manifest.warnings;
            }
        })
        .and_then([&] { return chooseCases(*run); })
        .map([&] {
            startProgress(*run, options.quiet);
            return std::move(run);
        });
}

}  // namespace still::command
