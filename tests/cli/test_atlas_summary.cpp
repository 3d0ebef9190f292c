// What the atlas says of all its cells together, and the names of its columns.

#include <catch2/catch.hpp>
#include <cmath>

#include "demos/stillframe/atlas_summary.h"
#include "demos/stillframe/cell_store.h"
#include "demos/stillframe/mode.h"
#include "tests/cli/shell.h"
#include "tests/support/data_path.h"

namespace still::test {
namespace {

using namespace command;

AtlasResult cellOf(const char* scene, const char* segment, const char* preset, double psnr,
                   double flip, std::optional<double> share) {
    AtlasResult result{scene, segment, preset, {}, share};
    result.measures.psnr = psnr;
    result.measures.flip = flip;
    return result;
}

const SummaryRow& rowOf(const std::vector<SummaryRow>& rows, const std::string& segment,
                        const std::string& preset) {
    for (const SummaryRow& row : rows) {
        if (row.segment == segment && row.preset == preset) {
            return row;
        }
    }
    FAIL("no row " << segment << " " << preset);
    return rows.front();
}

}  // namespace

TEST_CASE("atlas summary: decibels are averaged, ratios by their geometric mean", "[cli]") {
    AtlasReport report;
    report.modes = {"still", "quality"};
    report.results = {cellOf("a", "still", "still", 40, 0.02, 1.0),
                      cellOf("a", "still", "quality", 38, 0.04, 0.5),
                      cellOf("b", "still", "still", 30, 0.1, 1.0),
                      cellOf("b", "still", "quality", 31, 0.05, 0.25),
                      cellOf("a", "moving", "still", 30, 0.1, {}),
                      cellOf("a", "moving", "quality", 27, 0.1, {})};
    CHECK(summaryOf(report).empty());
    report.versus = "still";
    const std::vector<SummaryRow> rows = summaryOf(report);
    CHECK(rows.size() == 6);  // still, moving, all × two presets
    const SummaryRow& still = rowOf(rows, "still", "quality");
    CHECK(still.cells == 2);
    CHECK(still.psnr_db == Approx(-0.5));
    CHECK(still.flip == Approx(1.0));
    CHECK(*still.time == Approx(std::sqrt(0.125)));
    CHECK(still.worst_scene == "a");
    CHECK(still.worst_db == Approx(-2));
    const SummaryRow& moving = rowOf(rows, "moving", "quality");
    CHECK(moving.psnr_db == Approx(-3));
    CHECK_FALSE(moving.time.has_value());
    const SummaryRow& all = rowOf(rows, "all", "quality");
    CHECK(all.cells == 3);
    CHECK(all.psnr_db == Approx(-4.0 / 3));
    CHECK(*all.time == Approx(std::sqrt(0.125)));
    for (const char* segment : {"still", "moving", "all"}) {
        const SummaryRow& base = rowOf(rows, segment, "still");
        CHECK(base.psnr_db == 0);
        CHECK(base.flip == 1);
    }
}

TEST_CASE("atlas summary: errors that nobody sees are equal", "[cli]") {
    AtlasReport report;
    report.modes = {"still", "quality"};
    report.versus = "still";
    report.results = {cellOf("a", "still", "still", 100, 0, {}),
                      cellOf("a", "still", "quality", 61, 0.0004, {})};
    const SummaryRow& row = rowOf(summaryOf(report), "all", "quality");
    CHECK(row.psnr_db == 0);
    CHECK(row.flip == 1);
}

TEST_CASE("race times: they come back as they went, also those that were not taken", "[cli]") {
    const std::vector<SegmentTimes> times{std::nullopt,
                                          std::vector<RaceTime>{{1.0 / 3, 1}, {2, 0.1}}};
    const auto back = timesFromBytes(timesBytes(times));
    REQUIRE(back.has_value());
    REQUIRE(back->size() == 2);
    CHECK_FALSE((*back)[0].has_value());
    REQUIRE((*back)[1]->size() == 2);
    CHECK((*(*back)[1])[0].ms == 1.0 / 3);
    CHECK((*(*back)[1])[1].share == 0.1);
    CHECK_FALSE(timesFromBytes("2 1 ").has_value());
}

TEST_CASE("modes: names take settings after colons", "[cli]") {
    const auto modes =
        parseModes("still,raw:denoise=off,basic:alpha=0.5:sharpness=0.25,ssaa:4:denoise=off", "-p");
    REQUIRE(modes.has_value());
    REQUIRE(modes->size() == 4);
    CHECK((*modes)[0].denoise == Denoise::svgf);
    CHECK((*modes)[1].anti_aliasing == AntiAliasing::none);
    CHECK((*modes)[1].settings({}).denoise == Denoise::off);
    CHECK((*modes)[2].name == "basic:alpha=0.5:sharpness=0.25");
    CHECK((*modes)[2].policy.alpha_q15 == 16384);
    CHECK((*modes)[2].policy.sharpness_q15 == 8192);
    CHECK((*modes)[2].policy.method == findPreset("basic")->policy.method);
    CHECK((*modes)[3].ssaa_samples == 4);
    CHECK((*modes)[3].denoise == Denoise::off);
    for (const char* wrong : {"best", "still:denoise=maybe", "raw:alpha=0.1", "basic:alpha",
                              "basic:alpha=x", "basic:=", "=", ":", "raw=3", "ssaa:0"}) {
        INFO(wrong);
        const auto refused = parseModes(wrong, "--presets");
        REQUIRE_FALSE(refused.has_value());
        CHECK(refused.error().code == ExitCode::usage);
        CHECK(refused.error().message.starts_with("--presets: " + std::string(wrong) + ": "));
    }
}

TEST_CASE("atlas: --versus prints a table of means, or has it in the JSON", "[cli]") {
    const TempFolder folder;
    const std::string run =
        "stillframe atlas --scenes wires-still,disocclusion --presets raw,still --versus still "
        "--samples 16 --resolution 96x54 --cache cache --output out ";
    const Ran table = shell(folder.path(), run);
    INFO(table.err);
    REQUIRE(table.code == 0);
    CHECK(table.out.starts_with("against still, geometric means\n"));
    for (const char* segment : {"first", "still", "moving", "all"}) {
        CHECK(table.out.find("\n" + std::string(segment) + " ") != std::string::npos);
    }
    const Ran json = shell(folder.path(), run + "--json --time-resolution 64x36");
    CHECK(json.out.find("\"versus\": \"still\",\n\"summary\": [") != std::string::npos);
    CHECK(json.out.find("\"time_share\":1.0") != std::string::npos);
    CHECK(json.out.find("\"time_share\":null") != std::string::npos);  // a single frame

    const Ran refused =
        shell(folder.path(), "stillframe atlas --presets raw,still --versus fast --output other");
    CHECK(refused.code == 2);
    CHECK(isOneErrorLine(refused.err));
}

}  // namespace still::test
