#include <SDL.h>

#include <catch2/catch.hpp>
#include <set>
#include <string>

#include "demos/viewer/script.h"

namespace still::viewer {
namespace {

using Kind = ScriptStep::Kind;

std::string errorOf(const std::string& text) {
    const auto steps = parseScript(text, "tour.txt");
    REQUIRE_FALSE(steps.has_value());
    CHECK(steps.error().code == command::ExitCode::usage);
    return steps.error().message;
}

}  // namespace

TEST_CASE("script: every command is read, blank lines and comments are passed over") {
    const auto steps = parseScript(
        "# a tour\n"
        "\n"
        "key ctrl+Q\r\n"
        "  keydown w\n"
        "keyup W\n"
        "mouse move 10 20\n"
        "mouse down\n"
        "mouse up middle\n"
        "mouse click 1 2 right\n"
        "mouse drag 1 2 -3 4\n"
        "mouse wheel -2\n"
        "drop a file.obj\n"
        "resize 640x360\n"
        "wait 7\n"
        "screenshot shots/one.png\n"
        "quit",
        "tour.txt");
    REQUIRE(steps.has_value());
    REQUIRE(steps->size() == 14);
    const auto& s = *steps;
    CHECK(s[0].kind == Kind::key);
    CHECK(s[0].key == Key{SDLK_q, true, false, false});
    CHECK(s[1].kind == Kind::key_down);
    CHECK(s[1].key == Key{SDLK_w, false, false, false});
    CHECK(s[2].kind == Kind::key_up);
    CHECK((s[3].kind == Kind::mouse_move && s[3].x == 10 && s[3].y == 20));
    CHECK((s[4].kind == Kind::mouse_down && s[4].button == MouseButton::left));
    CHECK((s[5].kind == Kind::mouse_up && s[5].button == MouseButton::middle));
    CHECK((s[6].kind == Kind::mouse_click && s[6].button == MouseButton::right));
    CHECK((s[7].kind == Kind::mouse_drag && s[7].to_x == -3 && s[7].to_y == 4));
    CHECK((s[8].kind == Kind::mouse_wheel && s[8].count == -2));
    CHECK((s[9].kind == Kind::drop && s[9].file == "a file.obj"));
    CHECK((s[10].kind == Kind::resize && s[10].x == 640 && s[10].y == 360));
    CHECK((s[11].kind == Kind::wait && s[11].count == 7));
    CHECK((s[12].kind == Kind::screenshot && s[12].file == "shots/one.png"));
    CHECK(s[13].kind == Kind::quit);
}

TEST_CASE("script: a bad line is one error with its number and what was expected") {
    CHECK(
        errorOf("wait 1\n\nwalk 3\n").starts_with("tour.txt:3: unknown command, expected one of "));
    CHECK(errorOf("wait 0") == "tour.txt:1: expected wait FRAMES");
    CHECK(errorOf("wait ten") == "tour.txt:1: expected wait FRAMES");
    CHECK(errorOf("wait 99999999999") == "tour.txt:1: expected wait FRAMES");
    CHECK(errorOf("wait") == "tour.txt:1: expected wait FRAMES");
    CHECK(errorOf("key nothing") == "tour.txt:1: expected key NAME, as in ctrl+q");
    CHECK(errorOf("key hyper+q") == "tour.txt:1: expected key NAME, as in ctrl+q");
    CHECK(errorOf("mouse fly 1 2").starts_with("tour.txt:1: unknown command"));
    CHECK(errorOf("mouse").starts_with("tour.txt:1: unknown command"));
    CHECK(errorOf("mouse move 1") == "tour.txt:1: expected mouse move X Y");
    CHECK(errorOf("mouse down thumb") == "tour.txt:1: expected mouse down [left|middle|right]");
    CHECK(errorOf("resize 0x5") == "tour.txt:1: expected resize WIDTHxHEIGHT");
    CHECK(errorOf("screenshot a.jpg") == "tour.txt:1: expected screenshot NAME.png");
    CHECK(errorOf("drop") == "tour.txt:1: expected drop FILE");
    CHECK(errorOf("quit now") == "tour.txt:1: expected quit nothing more");
}

TEST_CASE("script: steps become events, frame by frame") {
    ScriptPlayer player;
    const auto eventsOf = [&](const std::string& line) {
        return player.eventsOf(parseScript(line, "t")->at(0));
    };
    const auto key = eventsOf("key shift+a");
    REQUIRE(key.size() == 2);
    CHECK(key[0].at(0).type == SDL_KEYDOWN);
    CHECK(key[0].at(0).key.keysym.sym == SDLK_a);
    CHECK((key[0].at(0).key.keysym.mod & KMOD_SHIFT) != 0);
    CHECK(key[1].at(0).type == SDL_KEYUP);
    eventsOf("keydown shift");
    CHECK((eventsOf("key b")[0].at(0).key.keysym.mod & KMOD_SHIFT) != 0);
    eventsOf("keyup shift");
    CHECK((eventsOf("key b")[0].at(0).key.keysym.mod & KMOD_SHIFT) == 0);

    CHECK(eventsOf("wait 3").size() == 3);
    CHECK(eventsOf("screenshot a.png").empty());

    eventsOf("mouse move 5 5");
    const auto drag = eventsOf("mouse drag 10 20 50 60 right");
    CHECK(drag.front().at(0).motion.xrel == 5);
    CHECK(drag[1].at(0).type == SDL_MOUSEBUTTONDOWN);
    CHECK(drag.back().at(0).type == SDL_MOUSEBUTTONUP);
    CHECK(drag.back().at(0).button.x == 50);
    int x = 0;
    for (const auto& frame : drag) {
        for (const SDL_Event& event : frame) {
            x += event.type == SDL_MOUSEMOTION ? event.motion.xrel : 0;
        }
    }
    CHECK(x == 45);
}

TEST_CASE("keys: every key stands in the table once, and its name is read back") {
    std::set<std::string> names;
    for (const KeyBinding& binding : keyBindings()) {
        const std::string name = nameOf(binding.key);
        INFO(name);
        CHECK(names.insert(name).second);
        REQUIRE(keyNamed(name).has_value());
        CHECK(*keyNamed(name) == binding.key);
        CHECK(actionOf(binding.key) == binding.action);
    }
    CHECK(keyNamed("enter")->code == SDLK_RETURN);
    CHECK(keyNamed("ESC")->code == SDLK_ESCAPE);
    CHECK(keyNamed("+")->code == SDLK_PLUS);
    CHECK_FALSE(actionOf({SDLK_q, false, false, false}).has_value());
}

}  // namespace still::viewer
