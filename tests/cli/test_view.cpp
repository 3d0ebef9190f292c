// `stillframe view`, played by scripts, without a screen.

#include <catch2/catch.hpp>
#include <filesystem>
#include <map>
#include <optional>

#include "engine/image_file.h"
#include "tests/cli/shell.h"
#include "tests/support/data_path.h"

namespace still::test {
namespace {

namespace fs = std::filesystem;

Ran view(const TempFolder& folder, const std::string& script, const std::string& more = "",
         const std::string& scene = "builtin:cubes") {
    folder.write("script.txt", script);
    return shell(folder.path(), "SDL_VIDEODRIVER=dummy stillframe view " + scene +
                                    " --script script.txt --resolution 200x120 " + more);
}

/// Runs a command with a screen of its own; nothing when there is no Xvfb here.
std::optional<Ran> underXvfb(const TempFolder& folder, const std::string& command) {
    if (shell(folder.path(), "command -v Xvfb").code != 0) {
        WARN("skipped: Xvfb is not installed");
        return std::nullopt;
    }
    return shell(folder.path(),
                 "mkfifo number\n"
                 "Xvfb -displayfd 3 -screen 0 1280x800x24 -nolisten tcp 3>number 2>/dev/null &\n"
                 "read -r screen <number\n"
                 "DISPLAY=:$screen SDL_VIDEODRIVER=x11 " +
                     command +
                     "\n"
                     "code=$?\n"
                     "kill $!\n"
                     "exit $code\n");
}

}  // namespace

TEST_CASE("view: a script takes screenshots of the window, in its size") {
    const TempFolder folder;
    const Ran ran = view(folder,
                         "wait 2\nscreenshot one.png\nresize 160x100\nwait 1\nkey s\n"
                         "screenshot two.png\nquit\nscreenshot never.png\n");
    CHECK(ran.code == 0);
    CHECK(ran.out.empty());
    CHECK(ran.err.empty());
    CHECK(filesIn(folder.path()) == std::vector<std::string>{"one.png", "script.txt", "two.png"});
    const auto one = readImageFile(folder.path() / "one.png");
    const auto two = readImageFile(folder.path() / "two.png");
    REQUIRE((one && two));
    CHECK((one->width() == 200 && one->height() == 120));
    CHECK((two->width() == 160 && two->height() == 100));
}

TEST_CASE("view: without a screen there is an error, not a window that nobody sees") {
    const TempFolder folder;
    folder.write("script.txt", "quit\n");
    const Ran ran = shell(folder.path(),
                          "unset DISPLAY WAYLAND_DISPLAY SDL_VIDEODRIVER\n"
                          "stillframe view builtin:cubes --script script.txt");
    CHECK(ran.code == 3);
    CHECK(ran.err.find("stillframe: cannot open a window: ") != std::string::npos);
}

TEST_CASE("view: the same script gives the same bytes on other threads and drivers") {
    const std::string script =
        "mouse drag 60 60 90 50\nkey space\nkey p\nwait 5\nscreenshot a.png\n";
    const TempFolder one, other;
    CHECK(view(one, script, "--threads 1").code == 0);
    other.write("script.txt", script);
    CHECK(shell(other.path(),
                "SDL_VIDEODRIVER=offscreen stillframe view builtin:cubes --script script.txt "
                "--resolution 200x120 --threads 3")
              .code == 0);
    CHECK(contentsOf(one.path() / "a.png") == contentsOf(other.path() / "a.png"));
}

TEST_CASE("view: a window on a screen shows the bytes that are shown without one") {
    const std::string script =
        "wait 2\nmouse drag 60 60 90 50\nkey s\nkey p\nresize 240x140\nwait 3\n"
        "screenshot a.png\n";
    const TempFolder screen, none;
    screen.write("script.txt", script);
    const auto ran = underXvfb(screen,
                               "stillframe view builtin:cubes --script script.txt "
                               "--resolution 200x120");
    if (!ran) {
        return;
    }
    INFO(ran->err);
    REQUIRE(ran->code == 0);
    REQUIRE(view(none, script).code == 0);
    CHECK(contentsOf(screen.path() / "a.png") == contentsOf(none.path() / "a.png"));
}

TEST_CASE("view: the tour shows everything there is, on a screen and without one", "[slow]") {
    const fs::path data = fs::path(STILL_SOURCE_DIR) / "tests" / "data";
    const TempFolder screen, none;
    for (const TempFolder* folder : {&screen, &none}) {
        for (const char* name : {"quad.obj", "quad.mtl"}) {
            fs::copy_file(data / name, folder->path() / name);
        }
        folder->write("broken.obj", "v 1 2\nf 1 2 3\n");
    }
    const std::string command = "stillframe view builtin:courtyard --resolution 960x540 --script " +
                                (data / "viewer_tour.txt").string();
    const Ran without = shell(none.path(), "SDL_VIDEODRIVER=dummy " + command);
    INFO(without.err);
    REQUIRE(without.code == 0);
    std::map<std::string, std::string> picture_of_bytes;
    for (const std::string& name : filesIn(none.path())) {
        if (name.ends_with(".png")) {  // every one shows something else
            const auto [same, added] =
                picture_of_bytes.emplace(contentsOf(none.path() / name), name);
            INFO(name << " and " << same->second);
            CHECK(added);
        }
    }
    CHECK(picture_of_bytes.size() == 30);
    const auto on_screen = underXvfb(screen, command);
    if (on_screen) {
        INFO(on_screen->err);
        REQUIRE(on_screen->code == 0);
        for (const auto& [bytes, name] : picture_of_bytes) {
            INFO(name);
            CHECK(contentsOf(screen.path() / name) == bytes);
        }
    }
}

TEST_CASE("view: a saved camera path is rendered again to the very picture that was seen") {
    const TempFolder folder;
    // While it plays, each of the last two commands draws one frame.
    const Ran ran = view(folder,
                         "wait 2\nmouse drag 60 60 90 50\nkey space\nwait 3\nmouse wheel 1\n"
                         "wait 2\nkeydown ctrl+F12\nkeydown ctrl+s\n",
                         "--aa taa:variance");
    REQUIRE(ran.code == 0);
    const std::string cameras = contentsOf(folder.path() / "cubes.cameras-1.json");
    int frames = 0;
    for (size_t at = 0; (at = cameras.find("\"view\"", at)) != std::string::npos; ++at) {
        ++frames;
    }
    CHECK(frames > 15);
    const Ran rendered =
        shell(folder.path(),
              "stillframe render builtin:cubes --cameras cubes.cameras-1.json --aa taa:variance "
              "--output again.png --frames 1 --start " +
                  std::to_string(frames - 2));
    CHECK(rendered.err.empty());
    REQUIRE(rendered.code == 0);
    CHECK(contentsOf(folder.path() / "again.png") ==
          contentsOf(folder.path() / "cubes.shot-1.png"));
}

TEST_CASE("view: what is wrong is one line, and nothing is opened") {
    const TempFolder folder;
    const Ran bad_line = view(folder, "wait 1\n\nwalk\n");
    CHECK(bad_line.code == 2);
    CHECK(isOneErrorLine(bad_line.err));
    CHECK(bad_line.err.find("script.txt:3: ") != std::string::npos);
    const Ran no_scene = view(folder, "wait 1\n", "", "none.obj");
    CHECK(no_scene.code == 3);
    CHECK(isOneErrorLine(no_scene.err));
    const Ran no_mode = view(folder, "wait 1\n", "--aa nothing");
    CHECK(no_mode.code == 2);
    CHECK(isOneErrorLine(no_mode.err));
    const Ran no_folder = view(folder, "screenshot none/a.png\n");
    CHECK(no_folder.code == 3);
    CHECK(isOneErrorLine(no_folder.err));
    const Ran no_script =
        shell(folder.path(), "SDL_VIDEODRIVER=dummy stillframe view builtin:cubes --script none");
    CHECK(no_script.code == 3);
    CHECK(isOneErrorLine(no_script.err));
    const Ran no_driver = shell(
        folder.path(), "SDL_VIDEODRIVER=nothing stillframe view builtin:cubes --script script.txt");
    CHECK(no_driver.code == 3);
    CHECK(isOneErrorLine(no_driver.err));
}

}  // namespace still::test
