#pragma once
// Mouse and keys on the scene.

#include <SDL_events.h>

#include "demos/viewer/desk.h"

namespace still::viewer {

class Controls {
  public:
    explicit Controls(Desk& desk) : desk_(desk) {}

    /// `panel_has_mouse`, `panel_has_keys`: a panel takes what is pressed now. What was begun on
    /// the scene stays the scene's until it is let go.
    void handle(const SDL_Event& event, bool panel_has_mouse, bool panel_has_keys);
    /// Flies on while keys are held.
    void advance(double seconds);

    bool flying() const { return drag_ == Drag::look; }
    /// Something goes on without further events.
    bool busy() const;

  private:
    enum class Drag { none, press, orbit, pan, press_middle, look, divider };

    void handleKey(const SDL_KeyboardEvent& event, bool panel_has_keys);
    void press(const SDL_MouseButtonEvent& event);
    void release(const SDL_MouseButtonEvent& event);
    void move(const SDL_MouseMotionEvent& event);
    void wheel(const SDL_MouseWheelEvent& event);
    void middleClick(int x, int y);
    bool onDivider(int x) const;
    bool* flightKey(SDL_Keycode code);

    Desk& desk_;
    Drag drag_ = Drag::none;
    uint8_t button_ = 0;           ///< that began the drag
    int from_x_ = 0, from_y_ = 0;  ///< where
    uint16_t modifiers_ = 0;       ///< as of the last key
    bool forward_ = false, back_ = false, left_ = false, right_ = false, up_ = false, down_ = false;
    double distance_ = 1;  ///< to the target when flying began
    double speed_ = 1;     ///< of flying, set by the wheel
};

}  // namespace still::viewer
