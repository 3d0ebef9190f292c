// A run that is cut into parts, here or on several machines, gives the bytes of the whole run.

#include <algorithm>
#include <catch2/catch.hpp>
#include <sstream>

#include "tests/cli/shell.h"
#include "tests/support/data_path.h"

namespace still::test {
namespace {

/// A camera that flies, a ball that rolls through a fence, a light that fades, a cut at frame 40.
const std::string kMoving = R"({"objects": [
    {"name": "floor", "shape": "plane", "scale": 6, "material": {"diffuse": [0.4, 0.4, 0.5]}},
    {"name": "ball", "shape": "sphere", "material": {"diffuse": [0.9, 0.3, 0.1]}, "translation":
     {"keys": [{"frame": 0, "value": [-2, 1, 0]}, {"frame": 96, "value": [2, 1, 0]}]}},
    {"name": "post", "shape": "box", "scale": [0.1, 2, 0.1], "translation": [0, 1, 1]}],
    "camera": {"target": [0, 0.7, 0], "eye": {"keys": [{"frame": 0, "value": [-1, 2, 6]},
     {"frame": 39, "value": [0, 2, 5]}, {"frame": 40, "value": [4, 1, 4]},
     {"frame": 96, "value": [5, 2, 2]}]}},
    "lights": {"ambient": {"colour": [0.3, 0.3, 0.3]}, "directional": {"direction": [1, -2, -1],
     "intensity": {"keys": [{"frame": 60, "value": 1}, {"frame": 70, "value": 0.5}]}}},
    "background": {"srgb": [0.5, 0.7, 0.9]}, "cuts": [40]})";

std::vector<std::string> linesOf(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) {
        lines.push_back(line);
    }
    return lines;
}

/// The line of the READMEs that begins like this, with what the test needs instead.
std::string readmeCommand(const std::string& begin, const std::string& part,
                          const std::string& instead) {
    const std::filesystem::path source(STILL_SOURCE_DIR);
    const std::string first_readme = contentsOf(source / "README.md");
    for (std::string line : linesOf(contentsOf(source / "demos/stillframe/README.md"))) {
        if (line.starts_with(begin)) {
            REQUIRE(first_readme.find("\n" + line + "\n") != std::string::npos);
            REQUIRE(line.find(part) != std::string::npos);
            line.replace(line.find(part), part.size(), instead);
            return "PATH=\"$(dirname '" STILL_PROGRAM "'):$PATH\" " + line;
        }
    }
    FAIL("the README has no line that begins with " << begin);
    return {};
}

bool hasParallel(const TempFolder& folder) {
    const bool there = shell(folder.path(), "parallel --version").code == 0;
    if (!there) {
        WARN("no GNU parallel here: its example is not tested");
    }
    return there;
}

}  // namespace

TEST_CASE("parts: --start K --frames N gives those frames of the whole run, in every stage",
          "[cli]") {
    const TempFolder folder;
    folder.write("scene.json", kMoving);
    const std::string base = "stillframe render scene.json --resolution 70x40 --hash ";
    for (const char* mode : {"taa:still", "taa:tiny", "taa:variance", "taa:ema-consistent",
                             "taa:intel", "none", "fxaa", "ssaa:3"}) {
        const std::string way = base + "--aa " + mode;
        const auto whole = linesOf(shell(folder.path(), way + " --frames 50").out);
        REQUIRE(whole.size() == 50);
        for (const auto& [start, count] : {std::pair(0, 7), std::pair(7, 1), std::pair(8, 30),
                                           std::pair(38, 5), std::pair(40, 1), std::pair(43, 7)}) {
            INFO(mode << " from " << start << ", " << count);
            const auto part =
                linesOf(shell(folder.path(), way + " --start " + std::to_string(start) +
                                                 " --frames " + std::to_string(count) +
                                                 " --threads " + std::to_string(1 + start % 3))
                            .out);
            CHECK(part == std::vector(whole.begin() + start, whole.begin() + start + count));
        }
    }
}

TEST_CASE("parts: an orbit goes on in the next part when --orbit-frames tells its length",
          "[cli]") {
    const TempFolder folder;
    const std::string base =
        "stillframe render builtin:cubes --resolution 60x40 --hash --orbit 50 ";
    const auto whole = linesOf(shell(folder.path(), base + "--frames 7").out);
    REQUIRE(whole.size() == 7);
    for (int start = 0; start < 7; ++start) {
        const auto part = shell(
            folder.path(), base + "--frames 1 --orbit-frames 7 --start " + std::to_string(start));
        CHECK(part.out == whole[size_t(start)] + "\n");
    }
}

TEST_CASE("parts: a frame of a scene at rest is not finished when it is part of a run", "[cli]") {
    const TempFolder folder;
    const std::string base = "stillframe render builtin:triangle --resolution 60x40 --hash ";
    const auto whole = linesOf(shell(folder.path(), base + "--frames 3").out);
    REQUIRE(whole.size() == 3);
    for (int start = 0; start < 3; ++start) {
        const std::string from = "--frames 1 --start " + std::to_string(start);
        CHECK(shell(folder.path(), base + from).out == whole[size_t(start)] + "\n");
        CHECK(shell(folder.path(), base + from + " --samples 64").out !=
              whole[size_t(start)] + "\n");
    }
}

TEST_CASE("parts: GNU parallel renders a run in parts as the README says, byte for byte", "[cli]") {
    const TempFolder folder;
    if (!hasParallel(folder)) {
        return;
    }
    folder.write("scene.json", kMoving);
    const std::string scene = "render scene.json", small = scene + " --resolution 64x36";
    const Ran ran = shell(folder.path(), readmeCommand("parallel stillframe render", scene, small));
    INFO(ran.err);
    REQUIRE(ran.code == 0);
    REQUIRE(shell(folder.path(), "mkdir whole && stillframe " + small +
                                     " --frames 96 --output whole/f.{frame:4}.png")
                .code == 0);
    const auto names = filesIn(folder.path() / "whole");
    REQUIRE(names.size() == 96);
    for (const std::string& name : names) {
        CHECK(contentsOf(folder.path() / name) == contentsOf(folder.path() / "whole" / name));
    }
}

TEST_CASE("parts: GNU parallel verifies golden pictures in shards as the README says", "[cli]") {
    const TempFolder folder;
    if (!hasParallel(folder)) {
        return;
    }
    folder.write("golden/scene.json", kMoving);
    std::string cases;
    for (int i = 0; i < 6; ++i) {
        cases += (i > 0 ? ", " : "") +
                 ("{\"name\": \"c" + std::to_string(i) +
                  "\", \"scene\": \"scene.json\", \"resolution\": [64, 36], \"start\": ") +
                 std::to_string(i) + "}";
    }
    folder.write("golden/golden.json", "{\"cases\": [" + cases + "]}");
    REQUIRE(shell(folder.path(), "stillframe golden record golden --quiet").code == 0);
    const std::string verify = readmeCommand("parallel stillframe golden", "verify", "verify");
    const Ran equal = shell(folder.path(), verify);
    INFO(equal.out << equal.err);
    CHECK(equal.code == 0);
    int compared = 0;
    for (const std::string& line : linesOf(equal.out)) {
        compared += std::stoi(line);  // "2 cases: 2 equal"
    }
    CHECK(compared == 6);
    // Case 4 is the second of the first of four shards.
    REQUIRE(shell(folder.path(),
                  "rm golden/c4.hashes && cp golden/c3.hashes golden/c4.hashes && "
                  "sed -i 's/^3 /4 /' golden/c4.hashes")
                .code == 0);
    const Ran different = shell(folder.path(), verify);
    CHECK(different.code == 1);
    CHECK(different.out.find("c4: frame 4: ") != std::string::npos);
    CHECK(filesIn(folder.path() / "golden/out") ==
          std::vector<std::string>{"c4.actual.png", "report-1-of-4.html"});
}

}  // namespace still::test
