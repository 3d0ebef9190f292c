#include "demos/viewer/controls.h"

#include <algorithm>
#include <cstdlib>
#include <glm/geometric.hpp>

namespace still::viewer {
namespace {

/// Presses that move no further are clicks.
constexpr int kClickSlack_px = 3;
constexpr int kDividerReach_px = 5;
/// A drag over the height of the window.
constexpr double kOrbitTurns = 0.5, kLookTurns = 0.25;
/// What a notch of the wheel adds to the distance, and to the speed of flying.
constexpr double kNotch = 0.1, kFaster = 0.25;
/// Flying covers the distance of what was looked at in so many seconds; Shift is faster by this.
constexpr double kApproach_s = 2, kFast = 4;

/// As much more as less in the other direction; without pow(), which differs between machines.
double grown(double share, double notches) {
    return notches < 0 ? 1 / (1 - share * notches) : 1 + share * notches;
}

}  // namespace

bool Controls::busy() const {
    return drag_ == Drag::look && (forward_ || back_ || left_ || right_ || up_ || down_);
}

bool Controls::onDivider(int x) const {
    const inspect::Look& look = desk_.session.look();
    return look.split && std::abs(x - int(look.divider * desk_.width + 0.5)) <= kDividerReach_px;
}

bool* Controls::flightKey(SDL_Keycode code) {
    switch (code) {
        case SDLK_w:
            return &forward_;
        case SDLK_s:
            return &back_;
        case SDLK_a:
            return &left_;
        case SDLK_d:
            return &right_;
        case SDLK_e:
            return &up_;
        case SDLK_q:
            return &down_;
        default:
            return nullptr;
    }
}

void Controls::handleKey(const SDL_KeyboardEvent& event, bool panel_has_keys) {
    modifiers_ = event.keysym.mod;
    const bool down = event.state == SDL_PRESSED;
    bool* flight = flightKey(event.keysym.sym);
    if (flight != nullptr && (flying() || !down)) {
        *flight = down;
    }
    if (!down || panel_has_keys || (flying() && flight != nullptr)) {
        return;
    }
    const Key key{event.keysym.sym, (modifiers_ & KMOD_CTRL) != 0, (modifiers_ & KMOD_SHIFT) != 0,
                  (modifiers_ & KMOD_ALT) != 0};
    const auto action = actionOf(key);
    const bool steps = action == Action::step_forward || action == Action::step_back;
    if (action && (event.repeat == 0 || steps)) {
        desk_.perform(*action);
    }
}

void Controls::press(const SDL_MouseButtonEvent& event) {
    if (drag_ != Drag::none) {
        return;
    }
    button_ = event.button;
    from_x_ = event.x;
    from_y_ = event.y;
    if (event.button == SDL_BUTTON_LEFT) {
        drag_ = onDivider(event.x)               ? Drag::divider
                : (modifiers_ & KMOD_SHIFT) != 0 ? Drag::pan
                                                 : Drag::press;
    } else if (event.button == SDL_BUTTON_MIDDLE) {
        drag_ = Drag::press_middle;
    } else if (event.button == SDL_BUTTON_RIGHT) {
        drag_ = Drag::look;
        const CameraPose& pose = desk_.session.rig().pose();
        distance_ = glm::distance(pose.eye, pose.target);
    }
}

void Controls::release(const SDL_MouseButtonEvent& event) {
    if (event.button != button_) {
        return;
    }
    if (drag_ == Drag::press) {
        desk_.session.pick(event.x, event.y);
        desk_.shown.story = desk_.session.look().picked.has_value();
    } else if (drag_ == Drag::press_middle) {
        middleClick(event.x, event.y);
    }
    drag_ = Drag::none;
    button_ = 0;
    forward_ = back_ = left_ = right_ = up_ = down_ = false;
}

void Controls::middleClick(int x, int y) {
    if (const auto point = desk_.session.surfaceAt(x, y)) {
        desk_.session.steer().centre(point->position);
    }
}

void Controls::move(const SDL_MouseMotionEvent& event) {
    desk_.mouse_x = event.x;
    desk_.mouse_y = event.y;
    inspect::Session& session = desk_.session;
    const bool moved = std::abs(event.x - from_x_) > kClickSlack_px ||
                       std::abs(event.y - from_y_) > kClickSlack_px;
    if (drag_ == Drag::press && moved) {
        drag_ = Drag::orbit;
    } else if (drag_ == Drag::press_middle && moved) {
        drag_ = Drag::pan;
    }
    const double height = std::max(desk_.height, 1);
    const double right = event.xrel / height, down = event.yrel / height;
    switch (drag_) {
        case Drag::orbit:  // the scene follows the hand
            return session.steer().orbit(-right * kOrbitTurns, down * kOrbitTurns);
        case Drag::pan:
            return session.steer().pan(-right, down);
        case Drag::look:
            return session.steer().look(right * kLookTurns, -down * kLookTurns);
        case Drag::divider:
            session.look().divider =
                std::clamp(double(event.x) / std::max(desk_.width, 1), 0.0, 1.0);
            return;
        default:
            return;
    }
}

void Controls::wheel(const SDL_MouseWheelEvent& event) {
    const double notches = double(event.preciseY);
    if (flying()) {
        speed_ = std::clamp(speed_ * grown(kFaster, notches), 0.01, 100.0);
        return;
    }
    const double factor = grown(kNotch, -notches);
    if ((modifiers_ & KMOD_CTRL) != 0) {
        if (const auto point = desk_.session.surfaceAt(desk_.mouse_x, desk_.mouse_y)) {
            desk_.session.steer().dollyTo(point->position, factor);
            return;
        }
    }
    desk_.session.steer().dolly(factor);
}

void Controls::handle(const SDL_Event& event, bool panel_has_mouse, bool panel_has_keys) {
    const bool free = !panel_has_mouse || drag_ != Drag::none;
    switch (event.type) {
        case SDL_KEYDOWN:
        case SDL_KEYUP:
            return handleKey(event.key, panel_has_keys);
        case SDL_MOUSEMOTION:
            return move(event.motion);
        case SDL_MOUSEBUTTONDOWN:
            return free ? press(event.button) : void();
        case SDL_MOUSEBUTTONUP:
            return release(event.button);
        case SDL_MOUSEWHEEL:
            return free ? wheel(event.wheel) : void();
        case SDL_DROPFILE:
            desk_.requests.open = event.drop.file;
            return;
        default:
            return;
    }
}

void Controls::advance(double seconds) {
    if (!busy()) {
        return;
    }
    const double step =
        distance_ / kApproach_s * speed_ * seconds * ((modifiers_ & KMOD_SHIFT) != 0 ? kFast : 1);
    const auto along = [step](bool positive, bool negative) {
        return step * (int(positive) - int(negative));
    };
    desk_.session.steer().fly(along(right_, left_), along(up_, down_), along(forward_, back_));
}

}  // namespace still::viewer
