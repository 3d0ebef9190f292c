#pragma once
// A script plays the part of mouse and keyboard: the same events as from people, one drawn frame at
// a time, so that what is seen depends on no clock.

#include <SDL_events.h>

#include <string>
#include <vector>

#include "demos/stillframe/outcome.h"
#include "demos/viewer/keys.h"

namespace still::viewer {

enum class MouseButton {
    left = SDL_BUTTON_LEFT,
    middle = SDL_BUTTON_MIDDLE,
    right = SDL_BUTTON_RIGHT
};

/// One line of a script; which fields count depends on `kind`.
struct ScriptStep {
    enum class Kind {
        key,
        key_down,
        key_up,
        mouse_move,
        mouse_down,
        mouse_up,
        mouse_click,
        mouse_drag,
        mouse_wheel,
        drop,
        resize,
        wait,
        screenshot,
        quit,
    };
    Kind kind = Kind::quit;
    Key key{};
    MouseButton button = MouseButton::left;
    int x = 0, y = 0;        ///< resize: the size
    int to_x = 0, to_y = 0;  ///< mouse_drag
    int count = 0;           ///< wait: frames; mouse_wheel: notches, > 0 away from the hand
    std::string file{};      ///< drop, screenshot
};

/// One command a line; empty lines and those that begin with # are passed over. The commands are in
/// README.md. The error names file, line and what was expected.
command::Outcome<std::vector<ScriptStep>> parseScript(const std::string& text,
                                                      const std::string& file);

/// Turns steps into events, keeping mouse and held keys between them.
class ScriptPlayer {
  public:
    /// The events of a step frame by frame: each inner list comes before a drawn frame. Empty for
    /// those that draw nothing: screenshot and quit.
    /// Events of dropped files own their text, as SDL's do.
    std::vector<std::vector<SDL_Event>> eventsOf(const ScriptStep& step);

  private:
    SDL_Event keyEvent(const Key& key, bool down);
    SDL_Event buttonEvent(MouseButton button, bool down) const;
    SDL_Event motionTo(int x, int y);
    std::vector<std::vector<SDL_Event>> drag(const ScriptStep& step);

    int x_ = 0, y_ = 0;
    uint16_t modifiers_ = 0;
};

}  // namespace still::viewer
