// `stillframe bench`, as a whole, and its parts.

#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <numeric>
#include <random>

#include "demos/scenes/bench_scenes.h"
#include "demos/scenes/builtin.h"
#include "demos/stillframe/bench.h"
#include "demos/stillframe/bench_probe_kernels.h"
#include "demos/stillframe/bench_run.h"
#include "demos/stillframe/bench_scaling.h"
#include "demos/stillframe/statistics.h"
#include "engine/hash.h"
#include "tests/cli/shell.h"
#include "tests/support/data_path.h"

namespace still::test {
namespace {

using command::FrameWork;
using command::simulatedMs;
using Json = nlohmann::json;

FrameWork randomWork(std::mt19937& random) {
    FrameWork frame{double(random() % 100) / 10, {}};
    frame.sections.resize(random() % 5);
    for (auto& section : frame.sections) {
        section.resize(random() % 40);
        for (double& grain_ms : section) {
            grain_ms = double(random() % 1000) / 100;
        }
    }
    return frame;
}

}  // namespace

TEST_CASE("statistics: the median and the 95th percentile are those of the sorted values",
          "[cli]") {
    const auto check = [](std::vector<double> values, double min, double median, double p95) {
        std::mt19937 random(3);
        std::shuffle(values.begin(), values.end(), random);
        const command::Statistics s = command::statisticsOf(values);
        CHECK(s.min == min);
        CHECK(s.median == median);
        CHECK(s.p95 == p95);
    };
    check({7}, 7, 7, 7);
    check({1, 2}, 1, 1.5, 2);
    check({1, 2, 10}, 1, 2, 10);
    std::vector<double> hundred(100);
    std::iota(hundred.begin(), hundred.end(), 1.0);
    check(hundred, 1, 50.5, 95);
    hundred.resize(20);
    check(hundred, 1, 10.5, 19);
}

TEST_CASE("scaling: one worker takes the work, many take the span, more are never slower",
          "[cli]") {
    std::mt19937 random(4);
    for (int round = 0; round < 200; ++round) {
        const FrameWork frame = randomWork(random);
        const double work_ms = workMs(frame), span_ms = spanMs(frame);
        CHECK(simulatedMs(frame, 1) == Approx(work_ms));
        CHECK(simulatedMs(frame, 40) == Approx(span_ms));
        for (int workers = 2; workers < 40; ++workers) {
            const double time_ms = simulatedMs(frame, workers);
            // Graham's bounds of any schedule that leaves nobody idle while there is work.
            const double parallel_ms = work_ms - frame.serial_ms;
            CHECK(time_ms >= span_ms - 1e-9);
            CHECK(time_ms >= frame.serial_ms + parallel_ms / workers - 1e-9);
            CHECK(time_ms <= span_ms + parallel_ms / workers + 1e-9);
        }
    }
}

TEST_CASE("scaling: grains go in order to whoever is free", "[cli]") {
    // Two workers: 3 and 1; the second goes on with 2 and meets the first; 4 is alone.
    CHECK(simulatedMs({10, {{3, 1, 2, 4}}}, 2) == 17);
    // The long one last: one worker waits.
    CHECK(simulatedMs({0, {{1, 1, 6}, {2}}}, 2) == 9);
}

TEST_CASE("scaling: what a recorder hears of adds up to the frame", "[cli]") {
    Workers workers(1);
    command::WorkRecorder recorder;
    volatile double sink = 1;
    const auto spin = [&](int rounds) {
        for (int i = 0; i < rounds * 20000; ++i) {
            sink = sink * 1.0000001;
        }
    };
    workers.observe(&recorder);
    recorder.beginFrame();
    const double start_ms = command::threadTimeMs();
    spin(5);
    workers.parallelFor(6, 2, [&](int begin, int, int) { spin(begin == 2 ? 40 : 10); });
    workers.parallelFor(1, 1, [&](int, int, int) { spin(10); });
    const FrameWork frame = recorder.endFrame();
    const double all_ms = command::threadTimeMs() - start_ms;
    REQUIRE(frame.sections.size() == 2);
    REQUIRE(frame.sections[0].size() == 3);
    REQUIRE(frame.sections[1].size() == 1);
    CHECK(frame.sections[0][1] > frame.sections[0][0]);
    CHECK(frame.sections[0][1] > frame.sections[0][2]);
    CHECK(frame.serial_ms > 0);
    CHECK(workMs(frame) == Approx(all_ms).epsilon(0.02));
}

TEST_CASE("bench: thread counts are numbers with commas", "[cli]") {
    CHECK(command::parseThreads("3").value() == std::vector<int>{3});
    CHECK(command::parseThreads("1,2,256").value() == std::vector<int>{1, 2, 256});
    CHECK(command::parseThreads("").value().size() == 1);
    for (const char* text : {"0", "257", "1,", ",1", "1;2", "two", "-1", "1 ,2", "1,,2"}) {
        INFO(text);
        CHECK_FALSE(command::parseThreads(text).has_value());
    }
}

TEST_CASE("bench: probes say how much they did", "[cli]") {
    const command::ProbeKernels& kernels = command::probeKernels();
    alignas(4096) static uint8_t from[8192], to[8192];
    for (size_t i = 0; i < sizeof from; ++i) {
        from[i] = uint8_t(i * 7);
    }
    for (const auto copy : {kernels.copy, kernels.stream}) {
        std::fill_n(to, sizeof to, uint8_t{0});
        copy(from, to, sizeof to);
        CHECK(std::equal(from, from + sizeof from, to));
    }
    if (bestSimdTarget() == SimdTarget::scalar) {
        return;
    }
    alignas(64) int16_t shorts[128];
    std::fill_n(shorts, 128, int16_t{100});
    const double once = kernels.add(1, shorts);
    CHECK(once >= 8 * command::kProbeChains);
    CHECK(kernels.add(1000, shorts) == 1000 * once);
    CHECK(kernels.mulHigh(1000, shorts) == 1000 * once);
    alignas(64) float floats[128];
    std::fill_n(floats, 128, 1.0f);
    CHECK(kernels.divide(10, floats) == 5 * once);
    std::vector<int32_t> texels(command::kProbeTexels, 3);
    alignas(64) int32_t words[128] = {};
    const double gathered = kernels.gather(texels.data(), 50, words);
    CHECK(std::accumulate(words, words + 64, 0.0) == 3 * gathered);
}

TEST_CASE("bench: a finished picture is measured apart, and counts nothing", "[cli]") {
    const Scene scene = *benchScene(*builtinScene("cubes"), BenchMotion::still, 36);
    FrameSettings settings;
    settings.width = 64;
    settings.height = 36;
    const auto results = command::measureCase({.scene = "cubes",
                                               .motion = "still",
                                               .content = &scene,
                                               .settings = settings,
                                               .threads = {1, 2},
                                               .frames = 80});
    REQUIRE(results.size() == 4);
    Workers workers(1);
    FrameLoop loop(scene, settings, workers);
    for (size_t i : {0u, 2u}) {
        const command::BenchResult &still = results[i], &frozen = results[i + 1];
        CHECK(still.motion == "still");
        CHECK(still.frames.size() == 44);  // 20 … 63
        CHECK(still.counters.triangles == scene.triangleCount());
        CHECK(still.tiles_skipped == 0);
        CHECK(still.history_taps == 64 * 64 * 36);
        CHECK(still.bytes[3] > 0);
        CHECK(still.scaling.has_value());
        CHECK(frozen.motion == "frozen");
        CHECK(frozen.frames.size() == 16);
        CHECK(frozen.counters.triangles == 0);
        CHECK(frozen.tiles_skipped == 1);
        CHECK(frozen.history_taps == 0);
        CHECK(std::accumulate(frozen.bytes.begin(), frozen.bytes.end(), 0.0) == 0);
        CHECK_FALSE(frozen.scaling.has_value());
        CHECK(frozen.frames[0].hash == hashPlane(loop.render(79).output));
        CHECK(still.frames[3].frame == 23);
        CHECK(still.frames[3].hash == hashPlane(loop.render(23).output));
    }
}

TEST_CASE("bench: a run prints a result for every motion, with the hashes that render gives",
          "[cli]") {
    const TempFolder folder;
    const Ran ran = shell(folder.path(),
                          "stillframe bench builtin:bench-mid --frames 4 --resolution 96x54 "
                          "--threads 1,2 --json");
    INFO(ran.err);
    REQUIRE(ran.code == 0);
    const Json json = Json::parse(ran.out);
    REQUIRE(json["results"].size() == 6);
    for (const Json& result : json["results"]) {
        CHECK(result["scene"] == "builtin:bench-mid");
        CHECK(result["width"] == 96);
        CHECK(result["frames"] == 3);
        double sum_ms = 0;
        for (const char* stage : {"transform", "bin", "visibility", "shade", "taa", "output"}) {
            const Json& times = result["stages"][stage];
            CHECK(times["min_ms"] > 0);
            CHECK(times["min_ms"] <= times["median_ms"]);
            CHECK(times["median_ms"] <= times["p95_ms"]);
            sum_ms += times["min_ms"].get<double>();
        }
        CHECK(result["total"]["p95_ms"] > sum_ms);
        CHECK(result["counters"]["triangles"] == result["triangles"]);
        CHECK(result["counters"]["pixels_shaded"] > 96 * 54 / 2);
        CHECK(result["scaling"]["simulated"][0]["speedup"].get<double>() == Approx(1));
        CHECK_FALSE(result.contains("peak_rss_bytes"));  // two were measured side by side
        CHECK(result["hashes"].size() == 3);
    }
    for (size_t i = 0; i < 6; i += 2) {  // threads make no difference
        CHECK(json["results"][i]["hashes"] == json["results"][i + 1]["hashes"]);
    }
    REQUIRE(json["machine"].size() == 2);
    CHECK(json["machine"][0]["copy_gb_s"] > 0);
    // `objects` is the scene as it is.
    const Ran rendered = shell(folder.path(),
                               "stillframe render builtin:bench-mid --frames 4 --resolution 96x54 "
                               "--json --hash");
    const Json hashes = Json::parse(rendered.out)["hashes"];
    CHECK(json["results"][4]["motion"] == "objects");
    CHECK(json["results"][4]["hashes"][2]["output"] == hashes[3]["output"]);
}

TEST_CASE("bench: people get tables, and cameras come from a file", "[cli]") {
    const TempFolder folder;
    std::string frames;
    for (int i = 0; i < 4; ++i) {
        frames += std::string(i == 0 ? "" : ",") + "{\"view\":[1,0,0,0,0,1,0,0,0,0,1,0," +
                  std::to_string(0.01 * i) +
                  ",0,-10,1],\"proj\":[1,0,0,0,0,1.7,0,0,0,0,-1.01,-1,0,0,-1,0]}";
    }
    folder.write("cameras.json", "{\"width\":80,\"height\":45,\"frames\":[" + frames + "]}");
    const Ran ran = shell(folder.path(),
                          "stillframe bench builtin:triangle --frames 4 --threads 1 "
                          "--cameras cameras.json");
    INFO(ran.err);
    REQUIRE(ran.code == 0);
    const auto has = [&](const std::string& part) {
        return ran.out.find(part) != std::string::npos;
    };
    CHECK(has("builtin:triangle, still: 1 triangles, 80x45, 1 thread,"));
    CHECK(has("builtin:triangle, pan"));
    CHECK_FALSE(has("builtin:triangle, objects"));
    CHECK(has("  visibility "));
    CHECK(has("peak memory"));
    CHECK(has("output "));
    CHECK(has("memory copy"));
}

TEST_CASE("bench: what cannot be meant or read is refused in one line", "[cli]") {
    const TempFolder folder;
    const auto refused = [&](const std::string& arguments, int code) {
        const Ran ran = shell(folder.path(), "stillframe bench " + arguments);
        INFO(arguments << "\n" << ran.err);
        CHECK(ran.code == code);
        CHECK(isOneErrorLine(ran.err));
        CHECK(ran.out.empty());
    };
    refused("builtin:nowhere", 2);
    refused("builtin:triangle --threads 0", 2);
    refused("builtin:triangle --frames 3", 2);
    refused("builtin:triangle --resolution 0x5", 2);
    refused("builtin:triangle --simd abacus", 2);
    refused("missing.obj", 3);
    refused("builtin:triangle --cameras missing.json", 3);
}

}  // namespace still::test
