#pragma once
// The keys, in one table: what they do, and what the help and the README say about them.

#include <SDL_keycode.h>

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace still::viewer {

enum class Action {
    help,
    quit,
    hide_ui,
    next_mode,
    previous_mode,
    next_view,
    previous_view,
    split,
    magnifier,
    forget_pixel,
    grid,
    axes,
    edges,
    tiles,
    arrows,
    fps,
    name,
    taa_panel,
    times_panel,
    story_panel,
    play,
    step_forward,
    step_back,
    first_frame,
    reset_camera,
    frame_all,
    front,
    right,
    top,
    isometric,
    orthographic,
    next_named_view,
    previous_named_view,
    keep_fps,
    previous_file,
    next_file,
    reload,
    screenshot,
    screenshot_picture,
    save_cameras,
};

/// A key with what is held besides.
struct Key {
    SDL_Keycode code = SDLK_UNKNOWN;
    bool ctrl = false, shift = false, alt = false;
    friend bool operator==(const Key&, const Key&) = default;
};

struct KeyBinding {
    Key key;
    Action action;
    std::string_view text;  ///< for the help
};

/// In the order of the help.
std::span<const KeyBinding> keyBindings();

std::optional<Action> actionOf(const Key& key);

/// "Ctrl+Q" and "Q", "Space", "F12": SDL's names, in any case, and enter, esc, ctrl, shift, alt.
/// Nothing when there is no such key.
std::optional<Key> keyNamed(std::string_view name);
std::string nameOf(const Key& key);

/// What the mouse does, in the form of the key table.
struct MouseHelp {
    std::string_view gesture, text;
};
std::span<const MouseHelp> mouseHelp();

}  // namespace still::viewer
