// What goes wrong is said in one line with the right exit code, and leaves nothing half-written.

#include <unistd.h>

#include <catch2/catch.hpp>

#include "engine/image_file.h"
#include "tests/cli/shell.h"
#include "tests/support/data_path.h"

namespace still::test {
namespace {

using Names = std::vector<std::string>;

/// An error: the code, one line about it, nothing on standard output, no new file.
void checkFails(const TempFolder& folder, const std::string& command, int code) {
    const Names before = filesIn(folder.path());
    const Ran ran = shell(folder.path(), command);
    INFO(command << "\n" << ran.err);
    CHECK(ran.code == code);
    CHECK(isOneErrorLine(ran.err));
    CHECK(ran.out.empty());
    CHECK(filesIn(folder.path()) == before);
}

const std::string kTriangle = "stillframe render builtin:triangle ";

}  // namespace

TEST_CASE("command: help and version are answers, not errors", "[cli]") {
    const TempFolder folder;
    for (const char* command :
         {"stillframe --help", "stillframe render --help", "stillframe compare --help",
          "stillframe presets --help", "stillframe --version"}) {
        const Ran ran = shell(folder.path(), command);
        CHECK(ran.code == 0);
        CHECK_FALSE(ran.out.empty());
        CHECK(ran.err.empty());
    }
}

TEST_CASE("command: what cannot be meant is refused with code 2", "[cli]") {
    const TempFolder folder;
    for (const char* arguments :
         {"", "paint", "render", "render builtin:triangle", "render builtin:nowhere --hash",
          "compare", "compare a.png", "compare a.png b.{frame}.png",
          "compare a.png b.png --diff d.jpg"}) {
        checkFails(folder, std::string("stillframe ") + arguments, 2);
    }
    for (const char* arguments : {"-o x.jpg",
                                  "-o x",
                                  "-o ''",
                                  "-o x.png --resolution 0x0",
                                  "-o x.png --resolution 100000x100000",
                                  "-o x.png --resolution 8193x8",
                                  "-o x.png --resolution 5",
                                  "-o x.png --resolution 5x5x5",
                                  "-o x.png --resolution ' 5x5'",
                                  "-o x.png --frames 0",
                                  "-o x.png --frames many",
                                  "-o x.png --start -1",
                                  "-o x.png --aa msaa",
                                  "-o x.png --aa taa:",
                                  "-o x.png --aa taa:nobody",
                                  "-o x.png --aa taa:still,fast",
                                  "-o x.png --aa none --taa alpha=0.1",
                                  "-o x.png --aa fxaa --taa alpha=0.1",
                                  "-o x.png --taa alpha",
                                  "-o x.png --taa alpha=",
                                  "-o x.png --taa alpha=2",
                                  "-o x.png --taa alpha=0.1,,sigma=1",
                                  "-o x.png --taa beta=0.1",
                                  "-o x.png --taa jitter=halton",
                                  "-o x.png --dump confidence --aa fxaa",
                                  "-o x.png --aa ssaa:0",
                                  "-o x.png --aa ssaa:65537",
                                  "-o x.png --dump depth,feelings",
                                  "-o x.png --dump confidence --aa none",
                                  "-o x.png --simd abacus",
                                  "-o x.png --shading lazy",
                                  "-o x.png --threads 0",
                                  "-o x.png --view nowhere",
                                  "-o x.png --fps 0",
                                  "-o x.png --samples 0",
                                  "-o x.png --samples 4 --frames 2",
                                  "-o x.png --cameras c.json --orbit 90",
                                  "-o x.png --orbit nan",
                                  "-o - --hash",
                                  "-o - --json",
                                  "-o - --frames 2 --no-background",
                                  "-o x.gif --no-background",
                                  "-o x.mp4 --no-background",
                                  "-o - --watch",
                                  "-o x.png --watch",
                                  "-o x.png --no-background --background-color 0,0,0",
                                  "--no-background --hash",
                                  "-o x.png --background-color red",
                                  "-o x.png --background-color 0,0",
                                  "-o x.png --background-color 0,0,2",
                                  "-o x.png --background-color '#12345'",
                                  "-o x.png --background-color '#12345g'",
                                  "-o x.png --background-color '#-1-1-1'",
                                  "-o x.png --up 0,0,0",
                                  "-o x.png --up +W",
                                  "-o x.png --up nan,0,1",
                                  "-o x.png --camera-position 1,2",
                                  "-o x.png --camera-position 1e10,0,0",
                                  "-o x.png --camera-position 1,2,3,",
                                  "-o x.png --camera-position 1,2,3 --camera-focal-point 1,2,3",
                                  "-o x.png --camera-view-angle 0",
                                  "-o x.png --camera-view-angle 171",
                                  "-o x.png --camera-zoom-factor 0",
                                  "-o x.png --camera-azimuth-angle nan",
                                  "-o x.png --exposure 17",
                                  "-o x.png --exposure nan",
                                  "-o x.png --turntable --orbit 10",
                                  "-o x.png --cameras c.json --turntable",
                                  "-o x.png --cameras c.json --up +Z",
                                  "-o x.png --cameras c.json --camera-zoom-factor 2",
                                  "builtin:cubes -o x.png",
                                  "builtin:cubes -o -",
                                  "builtin:triangle -o {model}.png",
                                  "- - --hash",
                                  "-o x.gif --reference r.png",
                                  "-o - --dump id",
                                  "--hash --dump id",
                                  "-o x.{frame}.gif",
                                  "-o x.%d.{frame}.png",
                                  "-o {frame}/x.png",
                                  "-o x.png --unknown"}) {
        checkFails(folder, kTriangle + arguments, 2);
    }
}

TEST_CASE("command: the limits of the size are named", "[cli]") {
    const TempFolder folder;
    const Ran ran = shell(folder.path(), kTriangle + "--hash --resolution 100000x100000");
    CHECK(ran.err.find("100000x100000") != std::string::npos);
    CHECK(ran.err.find("from 1 to 8192") != std::string::npos);
}

TEST_CASE("command: files that cannot be read are refused with code 3", "[cli]") {
    const TempFolder folder;
    folder.write("broken.json", "{\"objects\": [");
    folder.write("broken.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99\n");
    folder.write("picture.png", "not a picture");
    for (const char* arguments :
         {"none.obj", "none.json", "noextension", ".", "''", "broken.json",
          "builtin:triangle --cameras none.json", "builtin:triangle --cameras broken.json",
          "\"$(printf 'two\\nlines.obj')\""}) {
        checkFails(folder, std::string("stillframe render --hash ") + arguments, 3);
    }
    for (const char* arguments :
         {"none.png picture.png", "picture.png picture.png", "none.{frame}.png none.{frame}.png"}) {
        checkFails(folder, std::string("stillframe compare ") + arguments, 3);
    }
}

TEST_CASE("command: files that cannot be written are refused with code 3", "[cli]") {
    const TempFolder folder;
    folder.write("file", "");
    std::filesystem::create_directory(folder.path() / "folder.png");
    for (const char* name : {"nowhere/x.png", "file/x.png", "folder.png", "nowhere/x.gif",
                             "nowhere/x.mp4", "/proc/x.png"}) {
        checkFails(folder, kTriangle + "-o " + name, 3);
    }
    checkFails(folder, "PATH=/nowhere; " + kTriangle + "-o x.mp4", 3);
    if (geteuid() != 0) {
        std::filesystem::create_directory(folder.path() / "locked");
        checkFails(folder, "chmod a-w locked; " + kTriangle + "-o locked/x.png", 3);
    }
}

TEST_CASE("command: a full disk leaves no half-written file and keeps the old one", "[cli]") {
    const TempFolder folder;
    const std::string big = "stillframe render builtin:zoo --aa none --resolution 400x300 ";
    const std::string full = "ulimit -f 1; " + big;  // files of at most 512 or 1024 bytes
    for (const char* name : {"x.png", "x.gif", "x.%d.png --frames 2"}) {
        checkFails(folder, full + "-o " + name, 3);
    }
    folder.write("old.png", "old");
    checkFails(folder, full + "-o old.png", 3);
    CHECK(contentsOf(folder.path() / "old.png") == "old");
    if (shell(folder.path(), "command -v ffmpeg").code == 0) {
        checkFails(folder, full + "-o x.mp4 --frames 3", 3);
    }
}

TEST_CASE("command: results that cannot be printed are an error", "[cli]") {
    const TempFolder folder;
    if (!std::filesystem::exists("/dev/full")) {
        WARN("no /dev/full here: skipped");
        return;
    }
    for (const char* arguments : {"-o -", "--hash", "--json"}) {
        checkFails(folder, kTriangle + arguments + " >/dev/full", 3);
    }
}

TEST_CASE("command: a signal ends the program and takes its unfinished files away", "[cli]") {
    const TempFolder folder;
    if (shell(folder.path(), "command -v timeout").code != 0) {
        WARN("no timeout program here: skipped");
        return;
    }
    const bool video = shell(folder.path(), "command -v ffmpeg").code == 0;
    for (const auto& [name, number] : {std::pair{"INT", 2}, {"TERM", 15}, {"HUP", 1}}) {
        for (const char* file : {"x.gif", "x.mp4", "x.apng", "x.y4m"}) {
            if (!video && std::string(file) == "x.mp4") {
                continue;
            }
            const Ran ran = shell(
                folder.path(),
                std::string("timeout --preserve-status -s ") + name +
                    " 0.5 " STILL_PROGRAM " render builtin:cubes --frames 1000000 -o " + file);
            CHECK(ran.code == 128 + number);
            CHECK(filesIn(folder.path()).empty());
        }
    }
}

TEST_CASE("command: a signal leaves only whole pictures of a sequence", "[cli]") {
    const TempFolder folder;
    if (shell(folder.path(), "command -v timeout").code != 0) {
        WARN("no timeout program here: skipped");
        return;
    }
    const Ran ran =
        shell(folder.path(), "timeout --preserve-status -s INT 0.7 " STILL_PROGRAM
                             " render builtin:cubes --resolution 400x300 --frames 100000 -o x.png");
    CHECK(ran.code == 130);
    const Names names = filesIn(folder.path());
    CHECK_FALSE(names.empty());
    for (const std::string& name : names) {
        INFO(name);
        CHECK(name.ends_with(".png"));
        CHECK(readImageFile(folder.path() / name).has_value());
        CHECK(contentsOf(folder.path() / name).ends_with(std::string("IEND\xAE\x42\x60\x82")));
    }
}

TEST_CASE("command: --quiet keeps warnings to itself, not errors", "[cli]") {
    const TempFolder folder;
    folder.write("t.obj", "mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    for (const char* command : {"render t.obj --hash --resolution 8x8", "info t.obj",
                                "bench t.obj --frames 4 --resolution 8x8"}) {
        const std::string base = std::string("stillframe ") + command;
        const Ran loud = shell(folder.path(), base);
        INFO(command << "\n" << loud.err);
        CHECK(loud.code == 0);
        CHECK(loud.err.find("none.mtl") != std::string::npos);
        const Ran quiet = shell(folder.path(), base + " --quiet");
        CHECK(quiet.code == 0);
        CHECK(quiet.err.empty());
        CHECK_FALSE(quiet.out.empty());
    }
    checkFails(folder, "stillframe render none.obj --hash --quiet", 3);
    checkFails(folder, "stillframe info none.obj --quiet", 3);
    checkFails(folder, "stillframe completion fish", 2);
}

}  // namespace still::test
