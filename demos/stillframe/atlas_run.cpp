// Cases one after the other, their cells on all cores, what was measured kept in the cache.

#include <algorithm>
#include <memory>
#include <mutex>
#include <thread>

#include "demos/stillframe/atlas.h"
#include "demos/stillframe/case_references.h"
#include "demos/stillframe/cell_store.h"
#include "demos/stillframe/progress.h"
#include "demos/stillframe/race.h"
#include "engine/hash.h"

namespace still::command {
namespace {

constexpr const char* kKind = "cell 3";
constexpr const char* kRaceKind = "race 1";

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
        report_.noise = plan_.noise;
        report_.versus = plan_.versus ? report_.modes[*plan_.versus] : "";
    }
    Outcome<AtlasReport> run();

  private:
    /// One for each reference, each cell and each race.
    static int stepsOf(const AtlasPlan& plan);
    Outcome<void> runCase(const AtlasCase& atlas_case);
    /// Of each mode, of each segment.
    using Cells = std::vector<std::vector<SegmentMeasures>>;
    Outcome<Cells> measureCells(const PreparedCase& prepared);
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
        if (auto made = makeReferences(prepared, i, plan_.samples, cache_, workers_,
                                       [&] { progress_.advance(); });
            !made) {
            return made;
        }
    }
    findRevealed(prepared);
    auto cells = measureCells(prepared);
    const auto raced = cells && plan_.versus ? times(prepared) : std::vector<SegmentTimes>();
    if (!cells || !raced) {
        return tl::make_unexpected(!cells ? cells.error() : raced.error());
    }
    for (size_t s = 0; s < atlas_case.segments.size(); ++s) {
        for (size_t i = 0; i < cells->size(); ++i) {
            AtlasResult result{atlas_case.name, atlas_case.segments[s].name, report_.modes[i],
                               std::move((*cells)[i][s])};
            if (plan_.versus && (*raced)[s]) {
                result.time_share = (*(*raced)[s])[i].share;
            }
            if (plan_.noise && result.time_share && i != *plan_.versus) {
                result.equal_time = measureEqualTime(prepared, s, *result.time_share);
            }
            report_.results.push_back(std::move(result));
        }
    }
    return {};
}

Outcome<AtlasRun::Cells> AtlasRun::measureCells(const PreparedCase& prepared) {
    Cells cells(plan_.modes.size());
    std::vector<Outcome<void>> outcomes(plan_.modes.size());
    workers_.parallelFor(int(plan_.modes.size()), 1, [&](int begin, int, int) {
        const size_t i = size_t(begin);
        outcomes[i] =
            cell(prepared, plan_.modes[i]).map([&](std::vector<SegmentMeasures> measures) {
                cells[i] = std::move(measures);
            });
        progress_.advance();
    });
    for (const Outcome<void>& outcome : outcomes) {
        if (!outcome) {
            return tl::make_unexpected(outcome.error());
        }
    }
    return cells;
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
    std::string text = std::string(kRaceKind) + " " + report_.versus + " " +
                       std::to_string(plan_.time_resolution.width) + " " +
                       std::to_string(plan_.time_resolution.height);
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
        race(*prepared.atlas, prepared.scene, plan_.modes, *plan_.versus, plan_.time_resolution);
    progress_.advance();
    if (program_ != 0) {
        if (auto kept = cache_.store(key, timesBytes(measured)); !kept) {
            return tl::make_unexpected(kept.error());
        }
    }
    return measured;
}

}  // namespace

Outcome<AtlasReport> measureAtlas(AtlasPlan plan, FileCache cache) {
    return AtlasRun(std::move(plan), std::move(cache)).run();
}

}  // namespace still::command
