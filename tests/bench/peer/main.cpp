// bench_peer SCENE: the same frames by another renderer on the same CPU, OpenGL ES on Mesa's
// llvmpipe or on SwiftShader, and the time they take. What is measured, and how the peer is made as
// fast as it can be: tests/bench/README.md.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <thread>

#include "demos/scenes/bench_scenes.h"
#include "demos/stillframe/json_report.h"
#include "demos/stillframe/options.h"
#include "demos/stillframe/peak_memory.h"
#include "demos/stillframe/png.h"
#include "demos/stillframe/scene_source.h"
#include "engine/load.h"
#include "tests/bench/peer/check.h"
#include "tests/bench/peer/measure.h"

namespace still::peer {
namespace {

using command::ExitCode;
using command::Failure;
using command::Json;
using command::Outcome;

/// Tells CTest that the test was skipped: this machine has no such driver.
constexpr int kSkipped = 77;
constexpr int kCheckedFrame = 15;

struct Options {
    std::string scene, driver = "llvmpipe", libraries, png, resolution = "1920x1080";
    std::vector<std::string> motions;
    int threads = int(std::max(1u, std::thread::hardware_concurrency()));
    int frames = 20;
    bool msaa = false, json = false, check = false;
};

Json timesJson(const PeerTimes& times) {
    Json json;
    json["stages"] = {
        {"depth", command::statisticsJson(times.depth_ms)},
        {"lambert", command::statisticsJson(times.lambert_ms)},
        {"gbuffer", command::statisticsJson(times.gbuffer_ms)},
        {"taa", command::statisticsJson(times.taa_ms)},
        {"output", command::statisticsJson(times.output_ms)},
    };
    if (!times.msaa_ms.empty()) {
        json["stages"]["msaa4"] = command::statisticsJson(times.msaa_ms);
    }
    json["total"] = command::statisticsJson(times.frame_ms);
    json["peak_rss_bytes"] = command::peakMemoryBytes();
    return json;
}

void printTimes(const std::string& scene, const char* motion, const Json& result) {
    std::printf("%s %s, min / median / p95 ms\n", scene.c_str(), motion);
    const auto line = [](const char* what, const Json& s) {
        std::printf("  %-8s %8.2f %8.2f %8.2f\n", what, s["min_ms"].get<double>(),
                    s["median_ms"].get<double>(), s["p95_ms"].get<double>());
    };
    for (const auto& [stage, times] : result["stages"].items()) {
        line(stage.c_str(), times);
    }
    line("total", result["total"]);
}

Json checkJson(const PictureCheck& check) {
    return {{"raw_db", check.raw_db},
            {"motion", check.motion},
            {"aliased_db", check.aliased_db},
            {"taa_db", check.taa_db},
            {"passes", check.passes()}};
}

void printCheck(const std::string& scene, const char* motion, const PictureCheck& check) {
    std::printf("%s %s: frame %.1f dB, motion %.2f %%; one sample %.1f dB, resolved %.1f dB%s\n",
                scene.c_str(), motion, check.raw_db, 100 * check.motion, check.aliased_db,
                check.taa_db, check.passes() ? "" : "  FAILED");
}

Outcome<std::vector<BenchMotion>> parseMotions(const std::vector<std::string>& names) {
    std::vector<BenchMotion> motions;
    for (BenchMotion motion : kBenchMotions) {
        if (names.empty() || std::find(names.begin(), names.end(), name(motion)) != names.end()) {
            motions.push_back(motion);
        }
    }
    return motions;
}

/// The whole run: scene, driver, then motion by motion.
class Run {
  public:
    Run(const Options& options, const Gl& gl, Scene scene, command::Size size)
        : options_(options), gl_(gl), scene_(std::move(scene)), size_(size) {}

    Outcome<ExitCode> all(const std::vector<BenchMotion>& motions) {
        if (options_.check) {
            whole_ = scene_;
        }
        Result<GpuScene> drawer = GpuScene::make(gl_, scene_);
        if (!drawer) {
            return command::fileError(drawer.error().message);
        }
        Result<Passes> passes =
            Passes::make(gl_, size_.width, size_.height, drawer->reversedDepth());
        if (!passes) {
            return command::fileError(passes.error().message);
        }
        command::resetPeakMemory();  // loading does not count against the peer
        for (BenchMotion motion : motions) {
            if (auto done = one(motion, *drawer, *passes); !done) {
                return command::fileError(done.error().message);
            }
        }
        if (!options_.png.empty()) {
            command::Interruption interruption;
            if (auto saved =
                    command::savePng(options_.png, passes->readHistory().view(), interruption);
                !saved) {
                return tl::make_unexpected(saved.error());
            }
        }
        if (options_.json) {
            std::printf("%s\n", Json{{"results", results_}}.dump(2).c_str());
        }
        return good_ ? ExitCode::ok : ExitCode::differs;
    }

  private:
    Result<void> one(BenchMotion motion, GpuScene& drawer, Passes& passes) {
        const std::optional<Scene> moved = benchScene(scene_, motion, size_.height);
        if (!moved) {
            return {};
        }
        PeerFrames peer{gl_, *moved, drawer, passes, size_.width, size_.height};
        Json json{
            {"scene", options_.scene}, {"motion", name(motion)},      {"width", size_.width},
            {"height", size_.height},  {"driver", options_.driver},   {"renderer", gl_.renderer},
            {"version", gl_.version},  {"threads", options_.threads}, {"frames", options_.frames}};
        if (options_.check) {
            const std::optional<Scene> whole = benchScene(whole_, motion, size_.height);
            const auto check = checkPictures(peer, *whole, kCheckedFrame, options_.threads);
            if (!check) {
                return tl::make_unexpected(check.error());
            }
            json["check"] = checkJson(*check);
            good_ = good_ && check->passes();
            if (!options_.json) {
                printCheck(options_.scene, name(motion), *check);
            }
        } else {
            const Result<PeerTimes> times = measure(peer, options_.frames, options_.msaa);
            if (!times) {
                return tl::make_unexpected(times.error());
            }
            json.update(timesJson(*times));
            if (!options_.json) {
                printTimes(options_.scene, name(motion), json);
            }
        }
        results_.push_back(std::move(json));
        return {};
    }

    const Options& options_;
    const Gl& gl_;
    Scene scene_;
    Scene whole_;  ///< with vertices and texels, to check against
    command::Size size_;
    Json results_ = Json::array();
    bool good_ = true;
};

void addOptions(CLI::App& app, Options& o) {
    app.add_option("SCENE", o.scene, "FILE.obj, FILE.json or builtin:NAME")->required();
    app.add_option("--motion", o.motions, "still, pan and objects, default all")
        ->delimiter(',')
        ->check(CLI::IsMember({"still", "pan", "objects"}));
    app.add_option("--resolution", o.resolution, "Default 1920x1080");
    app.add_option("--threads", o.threads, "Of the driver's rasterizer, default all cores")
        ->check(CLI::Range(1, 16));
    app.add_option("--frames", o.frames, "Measured for each figure, default 20")
        ->check(CLI::Range(1, 2000));
    app.add_option("--driver", o.driver, "llvmpipe (default) or swiftshader")
        ->check(CLI::IsMember({"llvmpipe", "swiftshader"}));
    app.add_option("--libraries", o.libraries,
                   "Folder with libEGL.so of ANGLE for swiftshader, default /usr/lib/chromium");
    app.add_option("--png", o.png, "Write the last resolved frame");
    app.add_flag("--msaa", o.msaa, "Measure the G-buffer with four samples a pixel as well");
    app.add_flag("--check", o.check, "Compare the pictures instead of taking times");
    app.add_flag("--json", o.json, "Print one JSON object");
}

int report(const Failure& failure) {
    std::fprintf(stderr, "bench_peer: %s\n", failure.message.c_str());
    return int(failure.code);
}

int run(int argc, char** argv) {
    CLI::App app("Draws Stillframe's scenes with OpenGL ES on the CPU and takes the time",
                 "bench_peer");
    Options options;
    addOptions(app, options);
    CLI11_PARSE(app, argc, argv);
    const Outcome<command::Size> size = command::parseResolution(options.resolution);
    if (!size) {
        return report(size.error());
    }
    const auto motions = parseMotions(options.motions);
    Outcome<Scene> scene = command::openScene(options.scene);
    if (!scene) {
        return report(scene.error());
    }
    frameForAspect(*scene, size->width, size->height);
    const Driver driver = options.driver == "llvmpipe" ? Driver::llvmpipe : Driver::swiftshader;
    const Result<Gl> gl = openGl(driver, options.libraries, options.threads);
    if (!gl) {
        report({ExitCode::file_error, options.driver + " is not here: " + gl.error().message});
        return kSkipped;
    }
    const Outcome<ExitCode> done = Run(options, *gl, std::move(*scene), *size).all(*motions);
    return done ? int(*done) : report(done.error());
}

}  // namespace
}  // namespace still::peer

int main(int argc, char** argv) {
    return still::peer::run(argc, argv);
}
