// determinism [--update | --few | --report] [--table FILE]
// Renders the built-in scenes with every SIMD target, scheduler and thread count and compares the
// hashes of all stages with the committed table. Exit code: 0 equal, 1 some pixels differ, 2 the
// table or a scene cannot be had.
// --report runs every SIMD target on one thread and on several and prints for programs, with tabs
// in between: SCENE TARGET HASH TIME. HASH is over all stages and frames, that of the first run
// that differs from the table if there is one; TIME is the processor time on one thread in
// milliseconds. The lines of the target "table" hold what is expected.

#include <cstdio>
#include <cstring>
#include <ctime>
#include <string>
#include <vector>

#include "demos/scenes/builtin.h"
#include "engine/hash.h"
#include "tests/determinism/hash_table.h"

namespace still::determinism {
namespace {

/// Odd sizes, so that the last tiles and vectors are cut.
struct Case {
    const char* scene;
    int width, height, frames;
    const char* preset = "still";
    int late_ratio_fx8 = 0;  ///< from frame 3 on; 0: the preset's

    /// In the table.
    std::string name() const {
        return scene + (std::strcmp(preset, "still") == 0 ? "" : ":" + std::string(preset));
    }
};
constexpr Case kCases[] = {
    {"triangle", 65, 47, 4},
    {"cubes", 321, 179, 6},
    {"checker", 321, 179, 4},
    {"fence", 321, 179, 4},
    {"glass", 257, 131, 5},
    {"lights", 257, 131, 4},
    {"zoo", 321, 179, 6},
    {"pan", 321, 179, 5},
    {"courtyard", 321, 179, 4},
    {"cornell", 129, 97, 4},
    {"penumbra", 161, 93, 5},
    {"contact", 129, 67, 3},
    {"pan", 321, 179, 5, "quality"},
    {"zoo", 321, 179, 6, "performance", 435},
    {"fence", 257, 131, 4, "ultra"},
    {"glass", 257, 131, 3, "bicubic"},
    {"cubes", 257, 131, 3, "edge"},
};

struct Configuration {
    SimdTarget simd = SimdTarget::scalar;
    Schedule schedule = Schedule::serial;
    int threads = 1;
    Shading shading = Shading::deferred;

    std::string text() const {
        const char* kSchedules[] = {"pooled", "serial", "shuffled"};
        return std::string(name(simd)) + ", " + kSchedules[int(schedule)] + ", " +
               std::to_string(threads) + " threads, " +
               (shading == Shading::forward ? "forward" : "deferred");
    }
};

/// How many ways to run each scene.
enum class Extent {
    all,          ///< all combinations
    few,          ///< of each kind one: enough to compare compilers
    each_target,  ///< every SIMD target alone and with threads
};

std::vector<Configuration> configurations(Extent extent) {
    if (extent == Extent::few) {
        std::vector<Configuration> list{
            {SimdTarget::scalar, Schedule::serial, 1},
            {bestSimdTarget(), Schedule::shuffled, 1, Shading::forward}};
        if (bestSimdTarget() != SimdTarget::scalar) {
            list.push_back({bestSimdTarget(), Schedule::pooled, 2});
        }
        return list;
    }
    std::vector<Configuration> list;
    for (SimdTarget simd : availableSimdTargets()) {
        list.push_back({simd, Schedule::serial, 1});
        if (extent == Extent::each_target) {
            list.push_back({simd, Schedule::pooled, 3, Shading::forward});
            continue;
        }
        list.push_back({simd, Schedule::serial, 1, Shading::forward});
        list.push_back({simd, Schedule::shuffled, 1});
        for (int threads : {1, 2, 3, 8}) {
            list.push_back({simd, Schedule::pooled, threads});
        }
    }
    return list;
}

SceneRecord render(const Case& c, const Scene& scene, const Configuration& configuration) {
    Workers workers(configuration.threads, configuration.schedule, 42);
    FrameSettings settings;
    settings.width = c.width;
    settings.height = c.height;
    settings.simd = configuration.simd;
    settings.shading = configuration.shading;
    settings.planes = {.normal = true, .motion = true};
    settings.fresh_gbuffer = true;
    settings.policy = findPreset(c.preset)->policy;
    FrameLoop loop(scene, settings, workers);
    SceneRecord record{c.name(), {}};
    for (int frame = 0; frame < c.frames; ++frame) {
        if (frame == 3 && c.late_ratio_fx8 > 0) {
            loop.setRatio(c.late_ratio_fx8);
        }
        record.frames.push_back(hashOf(loop.render(frame)));
    }
    return record;
}

/// Prints the first difference and returns whether there is one.
bool differs(const Case& c, const SceneRecord& expected, const SceneRecord& found,
             const Configuration& configuration) {
    const int tiles_x = (c.width + kTileSize - 1) / kTileSize;
    for (size_t frame = 0; frame < found.frames.size(); ++frame) {
        const std::string text =
            differenceLine(expected.frames[frame], found.frames[frame], tiles_x);
        if (!text.empty()) {
            std::fprintf(stderr, "%s, frame %zu, %s\n    with %s\n", c.name().c_str(), frame,
                         text.c_str(), configuration.text().c_str());
            return true;
        }
    }
    return false;
}

/// What --report says of one scene and SIMD target.
struct ReportLine {
    SimdTarget simd = SimdTarget::scalar;
    uint64_t hash = 0;
    double time_ms = 0;
    bool equal = true;
};

/// Takes the run into its target's line: the time of the first one, the hash of it or of the first
/// that differs.
void note(std::vector<ReportLine>& report, const ReportLine& run) {
    for (ReportLine& line : report) {
        if (line.simd == run.simd) {
            if (line.equal && !run.equal) {
                line.hash = run.hash;
                line.equal = false;
            }
            return;
        }
    }
    report.push_back(run);
}

void print(const Case& c, const SceneRecord& expected, const std::vector<ReportLine>& report) {
    std::printf("%s\ttable\t%s\t0\n", c.name().c_str(), hex(digest(expected)).c_str());
    for (const ReportLine& line : report) {
        std::printf("%s\t%s\t%s\t%.1f\n", c.name().c_str(), std::string(name(line.simd)).c_str(),
                    hex(line.hash).c_str(), line.time_ms);
    }
    std::fflush(stdout);
}

struct Options {
    bool update = false, report = false;
    Extent extent = Extent::all;
    std::string table = STILL_SOURCE_DIR "/tests/determinism/hashes.txt";
};

int update(const Options& options) {
    Table table;
    for (const Case& c : kCases) {
        const Result<Scene> scene = builtinScene(c.scene);
        if (!scene) {
            std::fprintf(stderr, "%s\n", scene.error().message.c_str());
            return 2;
        }
        table.push_back(render(c, *scene, {}));
    }
    if (const Result<void> written = writeTable(options.table, table); !written) {
        std::fprintf(stderr, "%s\n", written.error().message.c_str());
        return 2;
    }
    std::printf("wrote %s\n", options.table.c_str());
    return 0;
}

const SceneRecord* find(const Table& table, const Case& c) {
    for (const SceneRecord& record : table) {
        if (record.scene == c.name() && record.frames.size() == size_t(c.frames)) {
            return &record;
        }
    }
    return nullptr;
}

int check(const Options& options) {
    const Result<Table> table = readTable(options.table);
    if (!table) {
        std::fprintf(stderr, "%s\n", table.error().message.c_str());
        return 2;
    }
    int runs = 0, failures = 0;
    for (const Case& c : kCases) {
        const Result<Scene> scene = builtinScene(c.scene);
        const SceneRecord* expected = find(*table, c);
        if (!scene || expected == nullptr) {
            std::fprintf(stderr, "%s: no such scene or not in the table, expected %d frames\n",
                         c.name().c_str(), c.frames);
            return 2;
        }
        std::vector<ReportLine> report;
        for (const Configuration& configuration : configurations(options.extent)) {
            const std::clock_t start = std::clock();
            const SceneRecord found = render(c, *scene, configuration);
            const double time_ms = double(std::clock() - start) * 1000 / CLOCKS_PER_SEC;
            const bool equal = !differs(c, *expected, found, configuration);
            note(report, {configuration.simd, digest(found), time_ms, equal});
            failures += equal ? 0 : 1;
            ++runs;
        }
        if (options.report) {
            print(c, *expected, report);
        }
    }
    std::fprintf(options.report ? stderr : stdout, "%d of %d runs equal the table\n",
                 runs - failures, runs);
    return failures == 0 ? 0 : 1;
}

}  // namespace
}  // namespace still::determinism

int main(int argc, char** argv) {
    still::determinism::Options options;
    for (int k = 1; k < argc; ++k) {
        if (std::strcmp(argv[k], "--update") == 0) {
            options.update = true;
        } else if (std::strcmp(argv[k], "--few") == 0) {
            options.extent = still::determinism::Extent::few;
        } else if (std::strcmp(argv[k], "--report") == 0) {
            options.report = true;
            options.extent = still::determinism::Extent::each_target;
        } else if (std::strcmp(argv[k], "--table") == 0 && k + 1 < argc) {
            options.table = argv[++k];
        } else {
            std::fprintf(stderr,
                         "usage: determinism [--update | --few | --report] [--table FILE]\n");
            return 2;
        }
    }
    return options.update ? still::determinism::update(options)
                          : still::determinism::check(options);
}
