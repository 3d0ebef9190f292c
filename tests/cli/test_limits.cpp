// Limits that are refused with their numbers, memory and disks that end, and files that would lead
// elsewhere or do something.

#include <catch2/catch.hpp>
#include <string>

#include "demos/stillframe/memory_limit.h"
#include "engine/image_file.h"
#include "tests/cli/shell.h"
#include "tests/support/data_path.h"

namespace still::test {
namespace {

using Names = std::vector<std::string>;

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// An error: the code, one line about it that says `what`, no new file.
void checkRefused(const TempFolder& folder, const std::string& command, int code,
                  const std::string& what) {
    const Names before = filesIn(folder.path());
    const Ran ran = shell(folder.path(), command);
    INFO(command << "\n" << ran.err);
    CHECK(ran.code == code);
    CHECK(isOneErrorLine(ran.err));
    CHECK(has(ran.err, what));
    CHECK(ran.out.empty());
    CHECK(filesIn(folder.path()) == before);
}

bool exists(const TempFolder& folder, const std::string& command) {
    return shell(folder.path(), "command -v " + command).code == 0;
}

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const std::string kManifest =
    R"({"cases": [{"name": "a", "scene": "builtin:zoo", "resolution": [400, 300]}]})";

/// Every command that renders a scene, of 400 × 300 pixels, into the folder.
const Names kRenderers{
    "render builtin:zoo --resolution 400x300 -o x.png",
    "golden record .",
    "atlas --scenes wires-still --presets raw --resolution 400x300 --samples 1 -o found",
    "chart builtin:zoo --resolution 400x300 --frames 4 --samples 1 -o found",
    "bench builtin:zoo --resolution 400x300 --frames 4",
};

/// A scene that takes little memory, 2000 times the same mesh of 4900 vertices, and much more
/// when it is drawn: places on the screen of all of them, 150 MB.
void writeCrowd(const TempFolder& folder) {
    constexpr int kSide = 70;
    std::string obj;
    for (int i = 0; i < kSide * kSide; ++i) {
        obj += "v " + std::to_string(i % kSide) + " 0 " + std::to_string(i / kSide) + "\n";
    }
    for (int i = 1; i < kSide * (kSide - 1); ++i) {
        obj += "f " + std::to_string(i) + " " + std::to_string(i + 1) + " " +
               std::to_string(i + kSide) + "\n";
    }
    folder.write("one.obj", obj);
    std::string json = R"({"objects": [{"obj": "one.obj"})";
    for (int i = 1; i < 2000; ++i) {
        json += R"(,{"obj": "one.obj"})";
    }
    folder.write("crowd.json", json + "]}");
}

/// Says so where it does not.
bool capsMemory() {
    if (!command::kCapsMemory) {
        WARN("memory is not capped under sanitizers: skipped");
    }
    return command::kCapsMemory;
}

/// A cache that is not in the test's folder.
std::string withCache(const TempFolder& cache) {
    return "export XDG_CACHE_HOME='" + cache.path().string() + "'; ";
}

}  // namespace

TEST_CASE("limits: --max-memory takes sizes and nothing else", "[cli]") {
    const TempFolder folder;
    const std::string render = "stillframe render builtin:triangle --hash --max-memory ";
    for (const char* size : {"500M", "0.5G", "500m", "1T", "900000000"}) {
        CHECK(shell(folder.path(), render + size + " --resolution 8x8").code == 0);
    }
    for (const char* size : {"''", "0", "-1G", "M", "1K", "1X", "1GB", "1e9", "nan", "9999999T"}) {
        checkRefused(folder, render + size, 2, "--max-memory: ");
    }
}

TEST_CASE("limits: pictures that need more memory than is allowed are refused with both numbers",
          "[cli]") {
    const TempFolder folder, cache;
    folder.write("golden.json", kManifest);
    for (const std::string& renderer : kRenderers) {
        if (renderer.starts_with("golden")) {
            continue;
        }
        checkRefused(folder, withCache(cache) + "stillframe " + renderer + " --max-memory 20M", 3,
                     "at 400x300: needs about ");
    }
    checkRefused(folder, withCache(cache) + "stillframe golden record . --max-memory 20M", 3,
                 "golden.json: /cases/0 at 400x300: needs about ");
    checkRefused(folder,
                 "stillframe render builtin:triangle --resolution 8192x8192 --max-memory 2G "
                 "-o x.png",
                 3, ", 2.0 GB are allowed (--max-memory)");
}

TEST_CASE("limits: memory that ends while frames are made ends in one line", "[cli]") {
    if (!capsMemory()) {
        return;
    }
    const TempFolder folder;
    writeCrowd(folder);
    folder.write("old.png", "old");
    CHECK(shell(folder.path(), "stillframe info crowd.json --max-memory 100M").code == 0);
    // By the cap, and by the system's own.
    for (const char* command :
         {"stillframe render crowd.json --resolution 64x64 --max-memory 100M -o ",
          "ulimit -d 100000; stillframe render crowd.json --resolution 64x64 -o "}) {
        for (const char* file : {"old.png", "x.gif", "x.y4m", "x.apng"}) {
            checkRefused(folder, std::string(command) + file, 3, "not enough memory");
        }
    }
    CHECK(contentsOf(folder.path() / "old.png") == "old");
}

TEST_CASE("limits: a video that ends without memory leaves neither file nor ffmpeg", "[cli]") {
    if (!capsMemory()) {
        return;
    }
    const TempFolder folder;
    if (!exists(folder, "ffmpeg")) {
        WARN("no ffmpeg here: skipped");
        return;
    }
    writeCrowd(folder);
    checkRefused(folder,
                 "stillframe render crowd.json --resolution 64x64 --frames 9 --max-memory 100M "
                 "-o x.mp4",
                 3, "not enough memory");
    CHECK(shell(folder.path(), "ps -o args= | grep -c '[f]fmpeg.*" + folder.path().string() + "'")
              .out == "0\n");
    // ffmpeg is not held to our cap: this is less than what it takes.
    const Ran ran = shell(folder.path(),
                          "stillframe render builtin:cubes --frames 3 --resolution 320x180 "
                          "--threads 1 --max-memory 60M -o x.mp4");
    INFO(ran.err);
    CHECK(ran.code == 0);
}

TEST_CASE("limits: threads that cannot be started end in one line", "[cli]") {
    if (!capsMemory()) {
        return;
    }
    const TempFolder folder;
    checkRefused(folder,
                 "stillframe render builtin:triangle --threads 256 --max-memory 400M -o x.png", 3,
                 "cannot start a thread");
}

TEST_CASE("limits: a scene that takes all memory while it is read ends in one line", "[cli]") {
    if (!capsMemory()) {
        return;
    }
    const TempFolder folder;
    // A value of JSON takes two bytes here and a hundred in memory.
    std::string many = "{\"cuts\": [0";
    for (int i = 0; i < 1000000; ++i) {
        many += ",0";
    }
    folder.write("many.json", many + "]}");
    checkRefused(folder, "stillframe info many.json --max-memory 80M", 3,
                 "many.json: its values need more than the 80.0 MB of memory");
    // Nobody knows beforehand what a face of so many corners becomes.
    std::string fan = kTriangle + "f";
    for (int i = 0; i < 2000000; ++i) {
        fan += " 1 2 3";
    }
    folder.write("fan.obj", fan + "\n");
    checkRefused(folder, "stillframe info fan.obj --max-memory 80M", 3, "not enough memory");
    folder.write("wide.ppm", "P6 8000 8000 255\n");
    folder.write("wide.json",
                 R"({"objects": [{"shape": "box", "material": {"image": "wide.ppm"}}]})");
    checkRefused(folder, "stillframe info wide.json --max-memory 80M", 3,
                 "wide.ppm: needs about 976.6 MB of memory, 80.0 MB are allowed");
}

TEST_CASE("limits: a full disk leaves what was there, whatever is written", "[cli]") {
    const TempFolder folder, cache;
    folder.write("golden.json", kManifest);
    folder.write("a.hashes", "old");
    const std::string full = "ulimit -f 1; ";
    for (const char* output :
         {"x.png --dump depth,id", "x.apng --frames 2", "x.y4m --frames 2", "x.gif --frames 2"}) {
        checkRefused(
            folder,
            full + "stillframe render builtin:zoo --aa none --resolution 400x300 -o " + output, 3,
            ": cannot write");
    }
    checkRefused(folder, full + "stillframe golden record .", 3, ": cannot write");
    CHECK(contentsOf(folder.path() / "a.hashes") == "old");
    std::filesystem::create_directory(folder.path() / "found");
    for (const std::string& renderer : kRenderers) {
        if (has(renderer, "found")) {
            const Ran ran =
                shell(folder.path(), withCache(cache) + full + "stillframe " + renderer);
            INFO(renderer << "\n" << ran.err);
            CHECK(ran.code == 3);
            CHECK(isOneErrorLine(ran.err));
            CHECK(filesIn(folder.path() / "found").empty());
        }
    }
}

TEST_CASE("limits: a signal ends every command that writes and leaves whole files", "[cli]") {
    if (!exists(TempFolder(), "timeout")) {
        WARN("no timeout program here: skipped");
        return;
    }
    for (const char* arguments :
         {"golden record .", "chart builtin:courtyard -o found", "atlas -o found"}) {
        const TempFolder folder, cache;
        folder.write("golden.json", R"({"cases": [{"name": "a", "scene": "builtin:courtyard",
                                         "resolution": [640, 360], "frames": 10000}]})");
        std::filesystem::create_directory(folder.path() / "found");
        const Ran ran =
            shell(folder.path(), withCache(cache) +
                                     "timeout --preserve-status -s TERM 0.7 " STILL_PROGRAM " " +
                                     arguments + " --quiet");
        INFO(arguments << "\n" << ran.err);
        CHECK(ran.code == 143);
        CHECK(filesIn(folder.path() / "found").empty());
        for (const std::string& name : filesIn(folder.path())) {
            INFO(name);
            CHECK((name == "golden.json" || name == "found" ||
                   readImageFile(folder.path() / name).has_value()));
        }
    }
}

TEST_CASE("limits: files outside of the scene's folder are read with --allow-outside only",
          "[cli]") {
    const TempFolder folder;
    folder.write("secret.obj", kTriangle);
    folder.write("scene/out.json", R"({"obj": "../secret.obj"})");
    folder.write("scene/golden.json",
                 R"({"cases": [{"name": "a", "scene": "../secret.obj", "resolution": [8, 8]}]})");
    folder.write("scene/m.obj", "mtllib ../secret.mtl\n" + kTriangle);
    folder.write("secret.mtl", "newmtl a\n");
    for (const char* command :
         {"render scene/out.json --resolution 8x8 -o x.png", "info scene/out.json",
          "bench scene/out.json --frames 4 --resolution 8x8", "golden record scene"}) {
        checkRefused(folder, std::string("stillframe ") + command, 3,
                     "found ../secret.obj; --allow-outside permits others");
        CHECK(
            shell(folder.path(), std::string("stillframe ") + command + " --allow-outside").code ==
            0);
        std::filesystem::remove(folder.path() / "x.png");
    }
    // An OBJ does without, as without files that are missing.
    const std::string render = "stillframe render scene/m.obj --hash --resolution 8x8";
    const Ran without = shell(folder.path(), render);
    CHECK(without.code == 0);
    CHECK(has(without.err, "--allow-outside"));
    CHECK(shell(folder.path(), render + " --allow-outside").err.empty());
    // What stands on the command line is not asked about, nor what a pipe names beside it.
    CHECK(shell(folder.path(), "cd scene; stillframe render ../secret.obj --hash").code == 0);
    CHECK(shell(folder.path() / "scene",
                "stillframe render - --hash --resolution 8x8 <m.obj 2>&1 | grep -c allow-outside")
              .out == "1\n");
}

TEST_CASE("limits: names of files and scenes are never run, nor taken for options", "[cli]") {
    const TempFolder folder;
    const std::string evil = "$(touch ran);touch ran|touch ran&`touch ran`";
    folder.write(evil + ".obj",
                 "mtllib " + evil + ".mtl\no " + evil + "\nusemtl " + evil + "\n" + kTriangle);
    folder.write(evil + ".mtl", "newmtl " + evil + "\nmap_Kd " + evil + ".png\n");
    const std::string scene = "'" + evil + ".obj'";
    const std::string small = " --resolution 16x16 --frames 2";
    Names outputs{"{model}.png", "{model}.gif", "./-x.png", "-loglevel.gif"};
    if (exists(folder, "ffmpeg")) {
        outputs.insert(outputs.end(), {"{model}.mp4", "-i.mp4", "concat:x.mp4", "%d:|x.mp4"});
    }
    for (const std::string& output : outputs) {
        INFO(output);
        const Names before = filesIn(folder.path());
        const Ran ran = shell(folder.path(),
                              "stillframe render " + scene + small + " '--output=" + output + "'");
        INFO(ran.err);
        const bool numbered = has(output, "%d");  // all frames go into one file: refused
        CHECK(ran.code == (numbered ? 2 : 0));
        CHECK((filesIn(folder.path()).size() > before.size()) == !numbered);
    }
    CHECK(shell(folder.path(), "stillframe info " + scene).code == 0);
    folder.write("red.json", R"({"objects": [{"shape": "box"}], "views": [
        {"name": "a\u001b[31m\nb", "eye": [0, 0, 5], "target": [0, 0, 0]}]})");
    const Ran info = shell(folder.path(), "stillframe info red.json");
    CHECK(has(info.out, "a?[31m?b"));
    CHECK_FALSE(has(info.out, "\x1B"));
    for (const std::string& name : filesIn(folder.path())) {
        CHECK(name != "ran");
    }
}

}  // namespace still::test
