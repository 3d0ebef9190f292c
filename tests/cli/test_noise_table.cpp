// The suite of noise: its table, what time buys, and the command.

#include <catch2/catch.hpp>
#include <memory>

#include "demos/stillframe/case_references.h"
#include "demos/stillframe/equal_time.h"
#include "demos/stillframe/noise_table.h"
#include "tests/cli/shell.h"
#include "tests/support/data_path.h"
#include "tests/support/test_scene.h"

namespace still::test {
namespace {

using namespace command;

AtlasResult cellOf(const char* preset, std::optional<double> flicker) {
    AtlasResult result{"room", "still", preset, {}, {}, {}};
    result.measures.flicker = flicker;
    result.measures.frames = {{31, 5.1, 0.9, 0.1}, {32, 2.55, 0.95, 0.1}};
    return result;
}

/// A scene of the smallest kind that is lit by samples.
AtlasCase smallCase() {
    const AtlasCase* cornell = findAtlasCase("cornell");
    REQUIRE(cornell != nullptr);
    AtlasCase small = *cornell;
    small.segments[0].first = 3;
    small.segments[0].last = 5;
    return small;
}

}  // namespace

TEST_CASE("noise table: worst frames, shares of the base, and no row for the base", "[cli]") {
    AtlasReport report;
    report.noise = true;
    report.modes = {"raw", "still"};
    report.results = {cellOf("raw", 0.2), cellOf("still", 0.01)};
    CHECK(noiseTableOf(report).empty());
    report.versus = "raw";
    report.results[1].equal_time = EqualTime{.samples = 90, .frames = 1, .rms = 5.2, .ssim = 0.8};
    const std::vector<NoiseRow> rows = noiseTableOf(report);
    REQUIRE(rows.size() == 1);
    CHECK(rows[0].preset == "still");
    CHECK(rows[0].ssim == 0.9);
    CHECK(rows[0].rmse == Approx(0.02));
    CHECK(*rows[0].flicker == Approx(0.05));
    CHECK_FALSE(rows[0].trail.has_value());
    CHECK(rows[0].equal_time_rms == Approx(5.1));
    CHECK(noiseLines(rows).find("beaten") != std::string::npos);
    CHECK(atlasJson(report).find("\"own_rmse\":0.02") != std::string::npos);

    report.results[0].measures.flicker = {};
    CHECK_FALSE(noiseTableOf(report)[0].flicker.has_value());
}

TEST_CASE("equal time: a scene at rest is given the samples of all frames so far", "[cli]") {
    const TempFolder folder;
    Interruption interruption;
    const auto cache = FileCache::open((folder.path() / "cache").string(), interruption);
    REQUIRE(cache.has_value());
    const AtlasCase atlas = smallCase();
    PreparedCase prepared{&atlas, atlas.make(), {.width = 64, .height = 36}, {}};
    prepared.segments.resize(1);
    Workers workers(2);
    int steps = 0;
    REQUIRE(makeReferences(prepared, 0, 64, *cache, workers, [&] { ++steps; }));
    CHECK(steps == 3);
    CHECK(filesIn(folder.path() / "cache").size() == 1);  // one picture for all frames
    for (const CaseFrame& frame : prepared.segments[0]) {
        CHECK(frame.reference.key == prepared.segments[0][0].reference.key);
        CHECK(frame.reference.picture.width() == 64);
    }

    const EqualTime bought = measureEqualTime(prepared, 0, 2.1);
    CHECK(bought.samples == 9);  // 4 frames
    CHECK(bought.frames == 1);
    CHECK(measureEqualTime(prepared, 0, 16).rms == 0);  // the reference itself
    CHECK(measureEqualTime(prepared, 0, 16).ssim == 1);
    CHECK(bought.rms > 0);
}

TEST_CASE("atlas: the suite of noise has its own columns and table", "[cli]") {
    const TempFolder folder;
    const std::string run =
        "stillframe atlas --suite noise --scenes switch-off --samples 16 --resolution 64x36 "
        "--cache cache --output out ";
    const Ran ran = shell(folder.path(), run);
    INFO(ran.err);
    REQUIRE(ran.code == 0);
    CHECK(ran.out.starts_with("scene "));
    CHECK(ran.out.find("\nswitch-off     event    still ") != std::string::npos);
    const std::string json = contentsOf(folder.path() / "out" / "atlas.json");
    CHECK(json.find("\"noise\": [") != std::string::npos);
    CHECK(json.find("\"equal_time\":{\"samples\":") != std::string::npos);
    CHECK(json.find("\"preset\":\"raw:denoise=off\"") != std::string::npos);
}

TEST_CASE("atlas: people's own scenes are cases of the suite of noise, and of no other", "[cli]") {
    const TempFolder folder;
    folder.write("sky.json", R"({"lights": {"ambient": {"bounce": true}}})");
    const std::string rest =
        " --presets raw:denoise=off,still --samples 4 --resolution 48x27 --cache cache "
        "--output out --lights sky.json --scenes cornell --model builtin:cubes";
    const Ran ran = shell(folder.path(), "stillframe atlas --suite noise" + rest);
    INFO(ran.err);
    REQUIRE(ran.code == 0);
    CHECK(ran.out.find("\ncubes ") != std::string::npos);
    const Ran refused = shell(folder.path(), "stillframe atlas" + rest);
    CHECK(refused.code == 2);
    CHECK(isOneErrorLine(refused.err));
    const Ran missing =
        shell(folder.path(), "stillframe atlas --suite noise --output out --model missing.obj");
    CHECK(missing.code == 3);
    CHECK(isOneErrorLine(missing.err));
}

}  // namespace still::test
