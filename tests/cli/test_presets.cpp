// Ways of anti-aliasing as the command line names them.

#include <catch2/catch.hpp>
#include <set>

#include "demos/stillframe/options.h"
#include "tests/cli/shell.h"
#include "tests/support/data_path.h"

namespace still::test {
namespace {

Ran render(const TempFolder& folder, const std::string& arguments) {
    return shell(folder.path(), "stillframe render --resolution 60x40 " + arguments);
}

}  // namespace

TEST_CASE("presets: taa means the preset still, names mean theirs", "[cli]") {
    const auto plain = command::parseAntiAliasing("taa");
    REQUIRE(plain.has_value());
    CHECK(plain->preset == "still");
    CHECK(plain->policy == TaaPolicy{});
    for (const TaaPreset& preset : taaPresets()) {
        const auto named = command::parseAntiAliasing("taa:" + std::string(preset.name));
        REQUIRE(named.has_value());
        CHECK(named->mode == AntiAliasing::taa);
        CHECK(named->policy == preset.policy);
    }
    CHECK(command::parseAntiAliasing("fxaa")->mode == AntiAliasing::fxaa);
}

TEST_CASE("presets: settings are applied over the preset, in order", "[cli]") {
    const TaaPolicy variance = findPreset("variance")->policy;
    CHECK(*command::parseTaaSettings("", variance) == variance);
    const auto changed =
        command::parseTaaSettings("sigma=2,jitter=r2,scramble=on,sigma=1.25", variance);
    REQUIRE(changed.has_value());
    TaaPolicy expected = variance;
    expected.sigma_fx8 = 320;
    expected.jitter = JitterPattern::r2;
    expected.scramble = true;
    CHECK(*changed == expected);
    const auto message = [&](const std::string& text) {
        return command::parseTaaSettings(text, variance).error().message;
    };
    CHECK(message("alpha=7") == "--taa: alpha=7: alpha takes 0 ... 1");
    CHECK(message("sigma=1,hue=3").starts_with("--taa: hue=3: expected KEY=VALUE with a key of "));
}

TEST_CASE("presets: the list names every preset and every setting", "[cli]") {
    const TempFolder folder;
    const std::string lines = shell(folder.path(), "stillframe presets").out;
    const std::string json = shell(folder.path(), "stillframe presets --json").out;
    const std::string help = shell(folder.path(), "stillframe render --help").out;
    for (const TaaPreset& preset : taaPresets()) {
        CHECK(lines.find("  " + std::string(preset.name) + " ") != std::string::npos);
        CHECK(lines.find(preset.about) != std::string::npos);
        CHECK(json.find("\"name\": \"" + std::string(preset.name) + "\"") != std::string::npos);
    }
    for (const TaaPolicyKey& key : taaPolicyKeys()) {
        CHECK(lines.find("  " + std::string(key.name) + " ") != std::string::npos);
        CHECK(help.find("  " + std::string(key.name) + " ") != std::string::npos);
        CHECK(json.find("\"name\": \"" + std::string(key.name) + "\"") != std::string::npos);
    }
}

TEST_CASE("presets: every way renders, each its own picture, threads and SIMD aside", "[cli]") {
    const TempFolder folder;
    std::set<std::string> pictures;
    const std::vector<std::string> ways{
        "none",
        "fxaa",
        "ssaa:4",
        "taa:basic",
        "taa:variance",
        "taa:ema-consistent",
        "taa --taa jitter=halton8,scramble=on",
        "taa --taa mip_bias=-1.5",
        "taa:basic --taa history=catmull-rom16,dering=on,rectification=off",
        "taa:basic --taa motion=camera,blend=velocity,velocity_alpha=0.05",
        "taa:fsr-like --taa sharpness=1,tone=linear,partial=on"};
    for (const std::string& way : ways) {
        const std::string base = "builtin:zoo --hash --start 3 --aa " + way;
        const Ran ran = render(folder, base);
        CAPTURE(way);
        CHECK(ran.code == 0);
        CHECK(ran.err.empty());
        pictures.insert(ran.out.substr(0, ran.out.find(" color")));
        CHECK(render(folder, base + " --threads 3 --simd scalar").out == ran.out);
    }
    CHECK(pictures.size() == ways.size());
}

TEST_CASE("presets: the report says which one, and confidence is written with each", "[cli]") {
    const TempFolder folder;
    const std::string json =
        render(folder, "builtin:cubes --json --aa taa:basic --taa alpha=0.2").out;
    CHECK(json.find("\"anti_aliasing\": \"taa:basic\"") != std::string::npos);
    CHECK(json.find("\"preset\": \"basic\"") != std::string::npos);
    CHECK(json.find("\"taa\": \"alpha=0.2\"") != std::string::npos);
    const std::string raw = render(folder, "builtin:cubes --json --aa none").out;
    CHECK(raw.find("\"anti_aliasing\": \"none\"") != std::string::npos);
    CHECK(raw.find("preset") == std::string::npos);
    for (const char* preset : {"still", "inside"}) {
        CHECK(render(folder,
                     "builtin:cubes -o x.png --dump confidence --aa taa:" + std::string(preset))
                  .code == 0);
    }
    CHECK(filesIn(folder.path()) == std::vector<std::string>{"x.confidence.png", "x.png"});
}

}  // namespace still::test
