#include "demos/viewer/keys.h"

#include <SDL_keyboard.h>

#include <algorithm>
#include <array>

namespace still::viewer {
namespace {

constexpr Key plain(SDL_Keycode code) {
    return {code, false, false, false};
}
constexpr Key ctrl(SDL_Keycode code) {
    return {code, true, false, false};
}
constexpr Key shift(SDL_Keycode code) {
    return {code, false, true, false};
}

// Where f3d has a key for it, that one.
constexpr std::array kBindings{
    KeyBinding{plain(SDLK_h), Action::help, "this list"},
    KeyBinding{ctrl(SDLK_q), Action::quit, "quit"},
    KeyBinding{plain(SDLK_TAB), Action::hide_ui, "hide or show all panels"},

    KeyBinding{plain(SDLK_a), Action::next_mode, "next anti-aliasing of the pane under the mouse"},
    KeyBinding{shift(SDLK_a), Action::previous_mode, "previous one"},
    KeyBinding{plain(SDLK_v), Action::next_view, "next view of the pane under the mouse"},
    KeyBinding{shift(SDLK_v), Action::previous_view, "previous one"},
    KeyBinding{plain(SDLK_s), Action::split, "one pane or two"},
    KeyBinding{plain(SDLK_m), Action::magnifier, "magnifier off, x4, x8, x16"},
    KeyBinding{plain(SDLK_ESCAPE), Action::forget_pixel, "forget the picked pixel"},

    KeyBinding{plain(SDLK_g), Action::grid, "grid"},
    KeyBinding{plain(SDLK_x), Action::axes, "axes"},
    KeyBinding{plain(SDLK_e), Action::edges, "edges of the triangles"},
    KeyBinding{plain(SDLK_t), Action::tiles, "borders of the tiles"},
    KeyBinding{plain(SDLK_r), Action::arrows, "arrows of motion"},

    KeyBinding{plain(SDLK_z), Action::fps, "frames per second"},
    KeyBinding{plain(SDLK_n), Action::name, "name and size"},
    KeyBinding{plain(SDLK_p), Action::taa_panel, "panel: anti-aliasing and its settings"},
    KeyBinding{plain(SDLK_c), Action::times_panel, "panel: time of every stage"},
    KeyBinding{plain(SDLK_i), Action::story_panel, "panel: story of the picked pixel"},

    KeyBinding{plain(SDLK_SPACE), Action::play, "play or pause"},
    KeyBinding{plain(SDLK_PERIOD), Action::step_forward, "one frame forward"},
    KeyBinding{plain(SDLK_COMMA), Action::step_back, "one frame back"},
    KeyBinding{plain(SDLK_HOME), Action::first_frame, "to the first frame"},

    KeyBinding{plain(SDLK_RETURN), Action::reset_camera, "the scene's own camera"},
    KeyBinding{plain(SDLK_f), Action::frame_all, "frame everything"},
    KeyBinding{plain(SDLK_1), Action::front, "look from the front"},
    KeyBinding{plain(SDLK_3), Action::right, "from the right"},
    KeyBinding{plain(SDLK_7), Action::top, "from above"},
    KeyBinding{plain(SDLK_9), Action::isometric, "from a corner"},
    KeyBinding{plain(SDLK_5), Action::orthographic, "parallel projection or perspective"},
    KeyBinding{plain(SDLK_PAGEDOWN), Action::next_named_view, "next view of the scene"},
    KeyBinding{plain(SDLK_PAGEUP), Action::previous_named_view, "previous one"},
    KeyBinding{plain(SDLK_d), Action::keep_fps, "dynamic resolution: keep the frame rate"},

    KeyBinding{plain(SDLK_LEFT), Action::previous_file, "previous file of the folder"},
    KeyBinding{plain(SDLK_RIGHT), Action::next_file, "next file of the folder"},
    KeyBinding{plain(SDLK_UP), Action::reload, "read the file again"},
    KeyBinding{plain(SDLK_F12), Action::screenshot, "screenshot, as NAME.shot-N.png"},
    KeyBinding{ctrl(SDLK_F12), Action::screenshot_picture, "the same without panels"},
    KeyBinding{ctrl(SDLK_s), Action::save_cameras,
               "save the camera's path, as NAME.cameras-N.json"},
};

constexpr std::array kMouse{
    MouseHelp{"left drag", "orbit, or move the divider"},
    MouseHelp{"click", "pick a pixel"},
    MouseHelp{"Shift or middle drag", "pan"},
    MouseHelp{"wheel", "nearer and farther; with Ctrl to the cursor"},
    MouseHelp{"middle click", "orbit around what is there"},
    MouseHelp{"hold right", "look around; W A S D fly, Q E down and up, Shift faster"},
    MouseHelp{"drop a file", "open it"},
};

std::string lower(std::string_view text) {
    std::string out(text);
    std::transform(out.begin(), out.end(), out.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
    return out;
}

SDL_Keycode codeNamed(const std::string& name) {
    struct Alias {
        std::string_view name;
        SDL_Keycode code;
    };
    constexpr std::array kAliases{Alias{"enter", SDLK_RETURN}, Alias{"esc", SDLK_ESCAPE},
                                  Alias{"shift", SDLK_LSHIFT}, Alias{"ctrl", SDLK_LCTRL},
                                  Alias{"alt", SDLK_LALT}};
    for (const Alias& alias : kAliases) {
        if (lower(name) == alias.name) {
            return alias.code;
        }
    }
    return SDL_GetKeyFromName(name.c_str());
}

}  // namespace

std::span<const KeyBinding> keyBindings() {
    return kBindings;
}
std::span<const MouseHelp> mouseHelp() {
    return kMouse;
}

std::optional<Action> actionOf(const Key& key) {
    for (const KeyBinding& binding : kBindings) {
        if (binding.key == key) {
            return binding.action;
        }
    }
    return std::nullopt;
}

std::optional<Key> keyNamed(std::string_view name) {
    Key key;
    for (size_t plus = name.find('+'); plus != std::string_view::npos && plus + 1 < name.size();
         plus = name.find('+')) {
        const std::string held = lower(name.substr(0, plus));
        bool& flag = held == "ctrl" ? key.ctrl : held == "shift" ? key.shift : key.alt;
        if (held != "ctrl" && held != "shift" && held != "alt") {
            return std::nullopt;
        }
        flag = true;
        name.remove_prefix(plus + 1);
    }
    key.code = codeNamed(std::string(name));
    return key.code == SDLK_UNKNOWN ? std::nullopt : std::optional(key);
}

std::string nameOf(const Key& key) {
    return std::string(key.ctrl ? "Ctrl+" : "") + (key.shift ? "Shift+" : "") +
           (key.alt ? "Alt+" : "") + SDL_GetKeyName(key.code);
}

}  // namespace still::viewer
