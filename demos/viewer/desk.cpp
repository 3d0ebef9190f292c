#include "demos/viewer/desk.h"

#include <algorithm>
#include <vector>

namespace still::viewer {
namespace {

using inspect::Look;
using inspect::PaneSettings;
using inspect::Session;

int wrapped(int value, int count) {
    return ((value % count) + count) % count;
}

void toggle(bool& flag) {
    flag = !flag;
}

/// The way of anti-aliasing before or after the pane's in the list of names; of one that is not in
/// it, the first.
void turnMode(PaneSettings& pane, int step) {
    const std::vector<std::string> names = inspect::modeNames();
    const auto at = std::find(names.begin(), names.end(), inspect::nameOf(pane.mode));
    const int index = at == names.end() ? 0 : int(at - names.begin()) + step;
    pane.mode = *inspect::modeNamed(names[size_t(wrapped(index, int(names.size())))]);
}

void turnView(PaneSettings& pane, int step) {
    const auto views = inspect::allViews();
    pane.view = views[size_t(wrapped(int(pane.view) + step, int(views.size())))].view;
}

}  // namespace

void TimeHistory::add(const std::array<float, kStages>& times_ms, double frame_ms_now) {
    for (size_t stage = 0; stage < kStages; ++stage) {
        std::rotate(stage_ms[stage].begin(), stage_ms[stage].begin() + 1, stage_ms[stage].end());
        stage_ms[stage].back() = times_ms[stage];
    }
    constexpr double kNew = 0.1;
    frame_ms = frame_ms == 0 ? frame_ms_now : frame_ms + (frame_ms_now - frame_ms) * kNew;
}

void Desk::say(std::string text, bool is_error) {
    message = std::move(text);
    message_is_error = is_error;
}

void Desk::toggleMagnifier() {
    inspect::Magnifier& magnifier = session.look().magnifier;
    if (!magnifier.on) {
        magnifier.on = true;
        magnifier.factor = 4;
    } else if (magnifier.factor < 16) {
        magnifier.factor *= 2;
    } else {
        magnifier.on = false;
    }
}

void Desk::showView(int step) {
    const int count = int(session.scene().views.size());
    if (count == 0) {
        say("the scene has no views", false);
        return;
    }
    view = view < 0 ? (step > 0 ? 0 : count - 1) : wrapped(view + step, count);
    session.showView(size_t(view));
    say("view " + session.scene().views[size_t(view)].name, false);
}

void Desk::performPane(Action action) {
    Look& look = session.look();
    PaneSettings& pane = session.pane(session.paneAt(mouse_x));
    switch (action) {
        case Action::next_mode:
        case Action::previous_mode:
            return turnMode(pane, action == Action::next_mode ? 1 : -1);
        case Action::next_view:
        case Action::previous_view:
            return turnView(pane, action == Action::next_view ? 1 : -1);
        case Action::split:
            return toggle(look.split);
        case Action::magnifier:
            return toggleMagnifier();
        case Action::forget_pixel:
            return look.picked.reset();
        case Action::grid:
            return toggle(look.overlays.grid);
        case Action::axes:
            return toggle(look.overlays.axes);
        case Action::edges:
            return toggle(look.overlays.edges);
        case Action::tiles:
            return toggle(look.overlays.tiles);
        case Action::arrows:
            return toggle(look.overlays.arrows);
        default:
            return performView(action);
    }
}

void Desk::performView(Action action) {
    switch (action) {
        case Action::reset_camera:
            return session.resetCamera();
        case Action::frame_all:
            return session.frameAll();
        case Action::front:
            return session.lookFrom({0, 0, 1});
        case Action::right:
            return session.lookFrom({1, 0, 0});
        case Action::top:
            return session.lookFrom({0, 1, 0});
        case Action::isometric:
            return session.lookFrom({1, 1, 1});
        case Action::orthographic:
            return session.steer().setOrthographic(!session.rig().pose().orthographic);
        case Action::next_named_view:
        case Action::previous_named_view:
            return showView(action == Action::next_named_view ? 1 : -1);
        case Action::keep_fps:
            toggle(keep_fps);
            return keep_fps ? void() : session.resetRenderScale();
        default:
            return performTime(action);
    }
}

void Desk::performTime(Action action) {
    switch (action) {
        case Action::play:
            return session.play(!session.playing());
        case Action::step_forward:
            return session.step(1);
        case Action::step_back:
            return session.step(-1);
        case Action::first_frame:
            return session.scrub(0);
        default:
            return;
    }
}

void Desk::perform(Action action) {
    switch (action) {
        case Action::help:
            return toggle(shown.help);
        case Action::hide_ui:
            return toggle(shown.ui);
        case Action::fps:
            return toggle(shown.fps);
        case Action::name:
            return toggle(shown.name);
        case Action::taa_panel:
            return toggle(shown.taa);
        case Action::times_panel:
            return toggle(shown.times);
        case Action::story_panel:
            return toggle(shown.story);
        case Action::quit:
            requests.quit = true;
            return;
        case Action::previous_file:
        case Action::next_file:
            requests.file_step = action == Action::next_file ? 1 : -1;
            return;
        case Action::reload:
            requests.reload = true;
            return;
        case Action::screenshot:
            requests.screenshot = true;
            return;
        case Action::screenshot_picture:
            requests.screenshot_picture = true;
            return;
        case Action::save_cameras:
            requests.save_cameras = true;
            return;
        default:
            return performPane(action);
    }
}

}  // namespace still::viewer
