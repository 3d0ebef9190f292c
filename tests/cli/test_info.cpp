// `stillframe info` and `stillframe completion`.

#include <catch2/catch.hpp>

#include "tests/cli/shell.h"
#include "tests/support/data_path.h"

namespace still::test {
namespace {

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// What the shell offers for a line; one a line, sorted.
std::string offered(const TempFolder& folder, const std::string& line) {
    const Ran ran = shell(folder.path(),
                          "stillframe completion bash >c.bash; bash -c '"
                          "source ./c.bash; COMP_LINE=$1; COMP_POINT=${#COMP_LINE}; "
                          "_stillframe; printf \"%s\\n\" \"${COMPREPLY[@]}\"' - '" +
                              line + "' | sort");
    INFO(line);
    CHECK(ran.code == 0);
    CHECK(ran.err.empty());
    return ran.out;
}

}  // namespace

TEST_CASE("info: counts, features and code paths of a scene", "[cli]") {
    const TempFolder folder;
    folder.write("grey.ppm", "P6 2 2 255\nabcabcabcabc");
    folder.write("s.json", R"({"objects": [
        {"shape": "box", "translation": {"keys": [{"frame": 0, "value": [0, 0, 0]},
                                                  {"frame": 9, "value": [3, 0, 0]}]}},
        {"shape": "box", "material": {"image": "grey.ppm"}},
        {"shape": "box", "material": {"specular": [1, 1, 1], "opacity": 0.5}},
        {"shape": "plane", "material": {"height": {"image": "grey.ppm", "scale": 0.1}}}],
        "cuts": [5], "views": [{"name": "side", "eye": [9, 0, 0], "target": [0, 0, 0]}]})");
    const Ran lines = shell(folder.path(), "stillframe info s.json");
    CHECK(lines.code == 0);
    CHECK(lines.err.empty());
    CHECK(has(lines.out, "in 4 objects"));
    CHECK(has(lines.out, "views      side"));
    CHECK(has(lines.out, "changes    objects, cuts"));
    CHECK(has(lines.out, "kernels    plain 12, textured 12, lit 12, parallax 2 (triangles)"));
    const Ran json = shell(folder.path(), "stillframe info s.json --json");
    CHECK(json.code == 0);
    for (const char* part :
         {"\"triangles\": 38", "\"still\": false", "\"stochastic_transparency\": 1",
          "\"height_maps\": 1", "\"use\": \"colour\"", "\"use\": \"height\"", "\"objects\": true",
          "\"camera\": false", "\"cuts\": 1"}) {
        INFO(part);
        CHECK(has(json.out, part));
    }
}

TEST_CASE("info: a scene at rest says so, and all built-in scenes can be told of", "[cli]") {
    const TempFolder folder;
    CHECK(has(shell(folder.path(), "stillframe info builtin:triangle").out, "changes    nothing"));
    CHECK(has(shell(folder.path(), "stillframe info builtin:triangle --json").out,
              "\"still\": true"));
    CHECK(has(shell(folder.path(), "stillframe info builtin:lights").out, "points"));
    CHECK(has(shell(folder.path(), "stillframe info builtin:cornell").out,
              "0 points, 1 rectangles, ambient with bounce (sampled)"));
    CHECK(has(shell(folder.path(), "stillframe info builtin:fence").out, "alpha test"));
    const Ran pipe = shell(folder.path(),
                           "printf 'v 0 0 0\\nv 1 0 0\\nv 0 1 0\\nf 1 2 3\\n' | stillframe info -");
    CHECK(has(pipe.out, "triangles  1 in 1 objects"));
}

TEST_CASE("completion: commands, options, values and scenes are offered by bash", "[cli]") {
    const TempFolder folder;
    if (shell(folder.path(), "command -v bash").code != 0) {
        WARN("no bash here: skipped");
        return;
    }
    folder.write("model.obj", "");
    CHECK(offered(folder, "stillframe re") == "render\n");
    CHECK(offered(folder, "stillframe render --turn") == "--turntable\n");
    CHECK(offered(folder, "stillframe render x.obj --tone-map ") == "none\nreinhard\n");
    CHECK(offered(folder, "stillframe render x.obj --tone-map=r") == "reinhard\n");
    CHECK(offered(folder, "stillframe render mo") == "model.obj\n");
    CHECK(offered(folder, "stillframe render x.obj -o mo") == "model.obj\n");
    // bash cuts words at ':', so the answer is what follows it.
    CHECK(offered(folder, "stillframe render builtin:court") == "courtyard\n");
    CHECK(has(offered(folder, "stillframe render x.obj --aa "), "taa:still\n"));
    CHECK(has(offered(folder, "stillframe render x.obj --simd "), "scalar\n"));
    CHECK(offered(folder, "stillframe golden ver") == "verify\n");
    CHECK(offered(folder, "stillframe golden verify --sh") == "--shard\n");
    CHECK(offered(folder, "stillframe completion ") == "bash\n");
    CHECK(offered(folder, "stillframe render x.obj --fps ") == "\n");
}

TEST_CASE("completion: every option of every command is known", "[cli]") {
    const TempFolder folder;
    const std::string script = shell(folder.path(), "stillframe completion bash").out;
    for (const char* command : {"render", "compare", "info", "atlas", "chart", "bench"}) {
        const Ran help = shell(folder.path(), std::string("stillframe ") + command +
                                                  " --help | grep -o '^  [^ ]*--[a-z-]*' | "
                                                  "grep -o -e '--[a-z-]*'");
        CHECK_FALSE(help.out.empty());
        std::string option;
        for (const char c : help.out) {
            if (c != '\n') {
                option += c;
                continue;
            }
            INFO(command << " " << option);
            CHECK(has(script, " " + option));
            option.clear();
        }
    }
}

}  // namespace still::test
