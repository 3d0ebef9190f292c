#include "demos/stillframe/atlas.h"

#include <algorithm>
#include <memory>
#include <mutex>
#include <thread>

#include "demos/stillframe/atlas_page.h"
#include "demos/stillframe/cell_store.h"
#include "demos/stillframe/progress.h"
#include "demos/stillframe/report.h"
#include "demos/stillframe/whole_file.h"
#include "engine/hash.h"

namespace still::command {
namespace {

constexpr const char* kKind = "cell 1";

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
    AtlasRun(Size resolution, std::vector<const AtlasCase*> cases, std::vector<Mode> modes,
             FileCache cache, bool quiet)
        : modes_(std::move(modes)),
          cache_(std::move(cache)),
          program_(programHash()),
          workers_(std::max(1, int(std::thread::hardware_concurrency()))),
          progress_(std::max(1, stepsOf(cases, modes_)), quiet) {
        report_.width = resolution.width;
        report_.height = resolution.height;
        report_.cases = std::move(cases);
        for (const Mode& mode : modes_) {
            report_.modes.push_back(mode.name);
        }
    }
    Outcome<AtlasReport> run();

  private:
    /// One for each reference and each cell.
    static int stepsOf(const std::vector<const AtlasCase*>& cases, const std::vector<Mode>& modes);
    Outcome<void> runCase(const AtlasCase& atlas_case);
    Outcome<void> makeReferences(PreparedCase& prepared, size_t segment);
    Outcome<std::vector<SegmentMeasures>> cell(const PreparedCase& prepared, const Mode& mode);
    uint64_t keyOf(const PreparedCase& prepared, const Mode& mode) const;

    std::vector<Mode> modes_;
    FileCache cache_;
    uint64_t program_;
    Workers workers_;
    SharedProgress progress_;
    AtlasReport report_;
};

int AtlasRun::stepsOf(const std::vector<const AtlasCase*>& cases, const std::vector<Mode>& modes) {
    size_t steps = 0;
    for (const AtlasCase* atlas_case : cases) {
        steps += modes.size();
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
    std::vector<std::vector<SegmentMeasures>> cells(modes_.size());
    std::vector<Outcome<void>> outcomes(modes_.size());
    workers_.parallelFor(int(modes_.size()), 1, [&](int begin, int, int) {
        const size_t i = size_t(begin);
        outcomes[i] = cell(prepared, modes_[i]).map([&](std::vector<SegmentMeasures> measures) {
            cells[i] = std::move(measures);
        });
        progress_.advance();
    });
    for (size_t s = 0; s < atlas_case.segments.size(); ++s) {
        for (size_t i = 0; i < cells.size() && s < cells[i].size(); ++i) {
            report_.results.push_back({atlas_case.name, atlas_case.segments[s].name, modes_[i].name,
                                       std::move(cells[i][s])});
        }
    }
    return firstFailure(outcomes);
}

Outcome<void> AtlasRun::makeReferences(PreparedCase& prepared, size_t segment) {
    const AtlasSegment& what = prepared.atlas->segments[segment];
    const std::vector<int> frames = comparedFrames(what);
    auto& compared = prepared.segments[segment];
    compared.resize(frames.size());
    std::vector<Outcome<void>> outcomes(frames.size());
    std::vector<std::unique_ptr<ReferenceMaker>> makers(size_t(workers_.threads()));
    Workers alone(1, Schedule::serial);
    workers_.parallelFor(int(frames.size()), 1, [&](int begin, int, int worker) {
        auto& maker = makers[size_t(worker)];
        if (!maker) {
            maker = std::make_unique<ReferenceMaker>(prepared.scene, prepared.view,
                                                     what.ssaa_samples, cache_, alone);
        }
        const size_t i = size_t(begin);
        const Size size = sizeAt(*prepared.atlas, prepared.view, frames[i]);
        maker->resize(size.width, size.height);
        outcomes[i] = maker->make(frames[i]).map([&](Reference reference) {
            compared[i] = {frames[i], std::move(reference), {}};
        });
        progress_.advance();
    });
    return firstFailure(outcomes);
}

uint64_t AtlasRun::keyOf(const PreparedCase& prepared, const Mode& mode) const {
    const AtlasCase& atlas_case = *prepared.atlas;
    std::string text = std::string(kKind) + " " + hex(program_) + " " + atlas_case.name + " " +
                       mode.name + " " + std::to_string(prepared.view.width) + " " +
                       std::to_string(prepared.view.height);
    for (const auto& segment : prepared.segments) {
        text += " |";
        for (const auto& frame : segment) {
            text += " " + hex(frame.reference.key);
        }
    }
    return hashBytes(text);
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

Outcome<AtlasReport> measureAtlas(std::vector<const AtlasCase*> cases, std::vector<Mode> modes,
                                  Size resolution, FileCache cache, bool quiet) {
    return AtlasRun(resolution, std::move(cases), std::move(modes), std::move(cache), quiet).run();
}

Outcome<void> atlas(const AtlasOptions& options, Interruption& interruption) {
    auto cases = parseCases(options.scenes);
    auto modes = parseModes(options.presets, "--presets");
    if (!cases || !modes) {
        return tl::make_unexpected(!cases ? cases.error() : modes.error());
    }
    return tryFolder(options.output, interruption)
        .and_then([&] { return FileCache::open(options.cache, interruption); })
        .and_then([&](FileCache cache) {
            return measureAtlas(std::move(*cases), std::move(*modes), options.resolution,
                                std::move(cache), options.quiet);
        })
        .and_then([&](const AtlasReport& report) {
            return writeAll(options, report, interruption).and_then([&] {
                return options.json ? print(atlasJson(report)) : Outcome<void>();
            });
        });
}

}  // namespace still::command
