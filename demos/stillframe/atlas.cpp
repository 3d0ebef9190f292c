#include "demos/stillframe/atlas.h"

#include <algorithm>
#include <memory>
#include <mutex>
#include <thread>

#include "demos/stillframe/atlas_page.h"
#include "demos/stillframe/atlas_summary.h"
#include "demos/stillframe/cell_store.h"
#include "demos/stillframe/progress.h"
#include "demos/stillframe/race.h"
#include "demos/stillframe/report.h"
#include "demos/stillframe/whole_file.h"
#include "engine/hash.h"

namespace still::command {
namespace {

constexpr const char* kKind = "cell 3";
constexpr const char* kRaceKind = "race 1";

Outcome<std::vector<const AtlasCase*>> parseCases(const std::string& text) {
    std::vector<const AtlasCase*> cases;
    for (const std::string& name : splitAtCommas(text)) {
        const AtlasCase* found = findAtlasCase(name);
        if (found == nullptr) {
            std::string known;
            for (const AtlasCase& atlas_case : atlasCases()) {
                known += (known.empty() ? "" : ", ") + atlas_case.name;
            }
            return usageError("--scenes: " + name + ": expected names out of " + known);
        }
        cases.push_back(found);
    }
    for (const AtlasCase& atlas_case : atlasCases()) {
        if (text.empty() && !atlas_case.slow) {
            cases.push_back(&atlas_case);
        }
    }
    return cases;
}

/// The bar, moved by whichever thread has finished something.
class SharedProgress {
  public:
    SharedProgress(int total, bool quiet) : bar_(total, quiet) {}
    void advance() {
        const std::lock_guard lock(mutex_);
        bar_.show(++done_);
    }

  private:
    std::mutex mutex_;
    ProgressBar bar_;
    int done_ = 0;
};

/// The first failure of a number of tasks, if any.
Outcome<void> firstFailure(const std::vector<Outcome<void>>& outcomes) {
    for (const Outcome<void>& outcome : outcomes) {
        if (!outcome) {
            return outcome;
        }
    }
    return {};
}

class AtlasRun {
  public:
    AtlasRun(AtlasPlan plan, FileCache cache)
        : plan_(std::move(plan)),
          cache_(std::move(cache)),
          program_(programHash()),
          workers_(std::max(1, int(std::thread::hardware_concurrency()))),
          progress_(std::max(1, stepsOf(plan_)), plan_.quiet) {
        report_.width = plan_.resolution.width;
        report_.height = plan_.resolution.height;
        report_.cases = plan_.cases;
        for (const Mode& mode : plan_.modes) {
            report_.modes.push_back(mode.name);
        }
        report_.versus = plan_.versus ? report_.modes[*plan_.versus] : "";
    }
    Outcome<AtlasReport> run();

  private:
    /// One for each reference, each cell and each race.
    static int stepsOf(const AtlasPlan& plan);
    Outcome<void> runCase(const AtlasCase& atlas_case);
    Outcome<void> makeReferences(PreparedCase& prepared, size_t segment);
    Outcome<std::vector<SegmentMeasures>> cell(const PreparedCase& prepared, const Mode& mode);
    Outcome<std::vector<SegmentTimes>> times(const PreparedCase& prepared);
    std::string contentOf(const PreparedCase& prepared) const;
    uint64_t keyOf(const PreparedCase& prepared, const Mode& mode) const;
    uint64_t raceKeyOf(const PreparedCase& prepared) const;

    AtlasPlan plan_;
    FileCache cache_;
    uint64_t program_;
    Workers workers_;
    SharedProgress progress_;
    AtlasReport report_;
};

int AtlasRun::stepsOf(const AtlasPlan& plan) {
    size_t steps = 0;
    for (const AtlasCase* atlas_case : plan.cases) {
        steps += plan.modes.size() + (plan.versus ? 1 : 0);
        for (const AtlasSegment& segment : atlas_case->segments) {
            steps += comparedFrames(segment).size();
        }
    }
    return int(steps);
}

Outcome<AtlasReport> AtlasRun::run() {
    for (const AtlasCase* atlas_case : report_.cases) {
        if (auto done = runCase(*atlas_case); !done) {
            return tl::make_unexpected(done.error());
        }
    }
    return std::move(report_);
}

Outcome<void> AtlasRun::runCase(const AtlasCase& atlas_case) {
    PreparedCase prepared{
        &atlas_case, atlas_case.make(), {.width = report_.width, .height = report_.height}, {}};
    prepared.segments.resize(atlas_case.segments.size());
    for (size_t i = 0; i < atlas_case.segments.size(); ++i) {
        if (auto made = makeReferences(prepared, i); !made) {
            return made;
        }
    }
    findRevealed(prepared);
    std::vector<std::vector<SegmentMeasures>> cells(plan_.modes.size());
    std::vector<Outcome<void>> outcomes(plan_.modes.size());
    workers_.parallelFor(int(plan_.modes.size()), 1, [&](int begin, int, int) {
        const size_t i = size_t(begin);
        outcomes[i] =
            cell(prepared, plan_.modes[i]).map([&](std::vector<SegmentMeasures> measures) {
                cells[i] = std::move(measures);
            });
        progress_.advance();
    });
    if (auto measured = firstFailure(outcomes); !measured) {
        return measured;
    }
    const auto raced = plan_.versus ? times(prepared) : std::vector<SegmentTimes>();
    if (!raced) {
        return tl::make_unexpected(raced.error());
    }
    for (size_t s = 0; s < atlas_case.segments.size(); ++s) {
        for (size_t i = 0; i < cells.size(); ++i) {
            AtlasResult result{atlas_case.name, atlas_case.segments[s].name, report_.modes[i],
                               std::move(cells[i][s])};
            if (plan_.versus && (*raced)[s]) {
                result.time_share = (*(*raced)[s])[i].share;
            }
            report_.results.push_back(std::move(result));
        }
    }
    return {};
}

Outcome<void> AtlasRun::makeReferences(PreparedCase& prepared, size_t segment) {
    const AtlasSegment& what = prepared.atlas->segments[segment];
    const std::vector<int> frames = comparedFrames(what);
    auto& compared = prepared.segments[segment];
    compared.resize(frames.size());
    std::vector<Outcome<void>> outcomes(frames.size());
    const auto make = [&](ReferenceMaker& maker, size_t i) {
        const Size size = sizeAt(*prepared.atlas, plan_.resolution, frames[i]);
        maker.resize(size.width, size.height);
        outcomes[i] = maker.make(frames[i]).map([&](Reference reference) {
            compared[i] = {frames[i], std::move(reference), {}};
        });
        progress_.advance();
    };
    // The first one by all threads, since that of a scene that stands still is all that there is;
    // then each thread makes some.
    const int samples = std::min(what.ssaa_samples, plan_.samples);
    ReferenceMaker first(prepared.scene, prepared.view, samples, cache_, workers_);
    make(first, 0);
    std::vector<std::unique_ptr<ReferenceMaker>> makers(size_t(workers_.threads()));
    Workers alone(1, Schedule::serial);
    workers_.parallelFor(int(frames.size()) - 1, 1, [&](int begin, int, int worker) {
        auto& maker = makers[size_t(worker)];
        if (!maker) {
            maker = std::make_unique<ReferenceMaker>(prepared.scene, prepared.view, samples, cache_,
                                                     alone);
        }
        make(*maker, size_t(begin) + 1);
    });
    return firstFailure(outcomes);
}

/// All that decides what is rendered and what it is compared with, but for the mode.
std::string AtlasRun::contentOf(const PreparedCase& prepared) const {
    std::string text = hex(program_) + " " + prepared.atlas->name + " " +
                       std::to_string(prepared.view.width) + " " +
                       std::to_string(prepared.view.height);
    for (const auto& segment : prepared.segments) {
        text += " |";
        for (const auto& frame : segment) {
            text += " " + hex(frame.reference.key);
        }
    }
    return text;
}

uint64_t AtlasRun::keyOf(const PreparedCase& prepared, const Mode& mode) const {
    return hashBytes(std::string(kKind) + " " + mode.name + " " + contentOf(prepared));
}

uint64_t AtlasRun::raceKeyOf(const PreparedCase& prepared) const {
    std::string text = std::string(kRaceKind) + " " + report_.versus;
    for (const std::string& mode : report_.modes) {
        text += " " + mode;
    }
    return hashBytes(text + " " + contentOf(prepared));
}

Outcome<std::vector<SegmentMeasures>> AtlasRun::cell(const PreparedCase& prepared,
                                                     const Mode& mode) {
    const uint64_t key = keyOf(prepared, mode);
    const auto stored = program_ != 0 ? cache_.load(key) : std::nullopt;
    if (auto known = stored ? cellFromBytes(*stored) : std::nullopt) {
        return std::move(*known);
    }
    auto measured = measureCell(prepared, mode);
    if (measured && program_ != 0) {
        if (auto kept = cache_.store(key, cellBytes(*measured)); !kept) {
            return tl::make_unexpected(kept.error());
        }
    }
    return measured;
}

Outcome<std::vector<SegmentTimes>> AtlasRun::times(const PreparedCase& prepared) {
    const uint64_t key = raceKeyOf(prepared);
    const auto stored = program_ != 0 ? cache_.load(key) : std::nullopt;
    if (auto known = stored ? timesFromBytes(*stored) : std::nullopt) {
        progress_.advance();
        return std::move(*known);
    }
    auto measured =
        race(*prepared.atlas, prepared.scene, plan_.modes, *plan_.versus, plan_.resolution);
    progress_.advance();
    if (program_ != 0) {
        if (auto kept = cache_.store(key, timesBytes(measured)); !kept) {
            return tl::make_unexpected(kept.error());
        }
    }
    return measured;
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

Outcome<AtlasReport> measureAtlas(AtlasPlan plan, FileCache cache) {
    return AtlasRun(std::move(plan), std::move(cache)).run();
}

Outcome<void> atlas(const AtlasOptions& options, Interruption& interruption) {
    AtlasPlan plan{.resolution = options.resolution,
                   .samples = options.samples > 0 ? options.samples : AtlasPlan::kMaxSamples,
                   .quiet = options.quiet};
    return parseCases(options.scenes)
        .map([&](std::vector<const AtlasCase*> cases) { plan.cases = std::move(cases); })
        .and_then([&] { return parseModes(options.presets, "--presets"); })
        .map([&](std::vector<Mode> modes) { plan.modes = std::move(modes); })
        .and_then([&] { return placeOf(options.versus, plan.modes); })
        .map([&](std::optional<size_t> versus) { plan.versus = versus; })
        .and_then([&] { return tryFolder(options.output, interruption); })
        .and_then([&] { return FileCache::open(options.cache, interruption); })
        .and_then([&](FileCache cache) { return measureAtlas(std::move(plan), std::move(cache)); })
        .and_then([&](const AtlasReport& report) {
            return writeAll(options, report, interruption).and_then([&] {
                return print(options.json ? atlasJson(report)
                             : report.versus.empty()
                                 ? std::string()
                                 : summaryLines(summaryOf(report), report.versus));
            });
        });
}

}  // namespace still::command
