#include "demos/viewer/viewer.h"

#include <algorithm>

#include "demos/stillframe/clock.h"
#include "demos/stillframe/scene_source.h"
#include "demos/viewer/panels.h"
#include "engine/load.h"

namespace still::viewer {
namespace {

constexpr double kPollPeriod_s = 0.25;
constexpr int kMessageFrames = 180;
constexpr int kRowGrain = 32;

inspect::SessionSettings sessionSettings(const ViewerSettings& settings) {
    inspect::SessionSettings session;
    session.width = settings.size.width;
    session.height = settings.size.height;
    session.tone_map = settings.tone_map;
    session.simd = settings.simd;
    session.clock_ms = command::nowMs;
    session.ticks = command::nowTicks;
    return session;
}

Scene framed(Scene scene, int width, int height) {
    frameForAspect(scene, width, height);
    return scene;
}

bool samePose(const CameraPose& a, const CameraPose& b) {
    return a.eye == b.eye && a.target == b.target && a.up == b.up && a.fov_y_deg == b.fov_y_deg;
}

}  // namespace

Viewer::Viewer(Scene scene, const std::string& name, const ViewerSettings& settings,
               Workers& workers)
    : settings_(settings),
      workers_(workers),
      session_(framed(std::move(scene), settings.size.width, settings.size.height),
               sessionSettings(settings), workers),
      tried_(name) {
    session_.pane(0).mode = settings.mode;
    desk_.scene_name = name;
    desk_.width = settings.size.width;
    desk_.height = settings.size.height;
    desk_.say("H lists all keys", false);
    watch_.watch(session_.scene().files);
}

/// Opens a scene, or the same one `again`; when that fails, the old one stays.
void Viewer::open(const std::string& name, bool again) {
    tried_ = name;
    command::Outcome<Scene> scene = command::openScene(name, settings_.load, settings_.lights);
    if (!scene) {
        desk_.say(scene.error().message, true);
        return;
    }
    std::string text = again ? "read again" : "";
    if (!scene->warnings.empty()) {
        text = scene->warnings.front();
        if (scene->warnings.size() > 1) {
            text += " (and " + std::to_string(scene->warnings.size() - 1) + " more warnings)";
        }
    }
    desk_.say(text, !scene->warnings.empty());
    session_.setScene(framed(std::move(*scene), desk_.width, desk_.height), again);
    desk_.scene_name = name;
    desk_.view = -1;
    watch_.watch(session_.scene().files);
}

void Viewer::openNeighbour(int step) {
    const std::vector<std::string> names = neighboursOf(tried_);
    const auto at = std::find(names.begin(), names.end(), tried_);
    const auto count = ptrdiff_t(names.size());
    open(names[size_t((at - names.begin() + step + count) % count)], false);
}

void Viewer::takeFileRequests() {
    Requests& requests = desk_.requests;
    if (requests.open) {
        open(*requests.open, false);
    } else if (requests.file_step != 0) {
        openNeighbour(requests.file_step);
    } else if (requests.reload) {
        open(tried_, tried_ == desk_.scene_name);
    }
    requests.open.reset();
    requests.file_step = 0;
    requests.reload = false;
}

void Viewer::pollFiles(double seconds) {
    since_poll_s_ += seconds;
    if (since_poll_s_ < kPollPeriod_s) {
        return;
    }
    since_poll_s_ = 0;
    if (watch_.poll()) {
        open(desk_.scene_name, true);
    }
}

void Viewer::handle(const SDL_Event& event) {
    ui_.handle(event);
    if (event.type == SDL_WINDOWEVENT && event.window.event == SDL_WINDOWEVENT_SIZE_CHANGED) {
        desk_.width = std::clamp(event.window.data1, 1, kMaxTargetSize);
        desk_.height = std::clamp(event.window.data2, 1, kMaxTargetSize);
        session_.resize(desk_.width, desk_.height);
        return;
    }
    if (event.type == SDL_QUIT) {
        desk_.requests.quit = true;
    }
    controls_.handle(event, ui_.wantsMouse(), ui_.wantsKeys());
}

/// Rows of RGB become rows of the window.
void Viewer::paint(ImageView<const Rgb8> picture) {
    canvas_.resize(picture.width, picture.height);
    const ImageView<Xrgb8> out = canvas_.view();
    workers_.parallelFor(picture.height, kRowGrain, [&](int begin, int end, int) {
        for (int y = begin; y < end; ++y) {
            const Rgb8* from = picture.row(y);
            Xrgb8* to = out.row(y);
            for (int x = 0; x < picture.width; ++x) {
                to[x] = Xrgb8{from[x].r} << 16 | Xrgb8{from[x].g} << 8 | Xrgb8{from[x].b};
            }
        }
    });
}

bool Viewer::draw(double seconds) {
    takeFileRequests();
    pollFiles(seconds);
    controls_.advance(seconds);
    session_.look().magnifier.x = desk_.mouse_x;
    session_.look().magnifier.y = desk_.mouse_y;
    moving_ = session_.playing() || !samePose(last_pose_, session_.rig().pose());
    last_pose_ = session_.rig().pose();

    const double begin_ms = command::nowMs();
    const inspect::Drawn drawn = session_.draw();
    const double drawn_ms = command::nowMs();
    picture_ = drawn.image;
    paint(drawn.image);
    ageMessage();
    ui_.begin({desk_.width, desk_.height}, seconds);
    showPanels(desk_);
    ui_.end();
    ui_.draw(canvas_.view());
    takeTimes(drawn_ms - begin_ms, command::nowMs() - drawn_ms + show_ms_);
    return drawn.changed;
}

/// Good news goes by itself, after so many frames: a script sees the same as a person.
void Viewer::ageMessage() {
    message_frames_ = desk_.message == aged_message_ ? message_frames_ + 1 : 0;
    aged_message_ = desk_.message;
    if (message_frames_ > kMessageFrames && !desk_.message_is_error) {
        desk_.message.clear();
    }
}

void Viewer::takeTimes(double draw_ms, double panels_ms) {
    StageTimes sum;
    for (int pane = 0; pane < (session_.look().split ? 2 : 1); ++pane) {
        const StageTimes& times = session_.report(pane).times;
        sum.transform_bin_ms += times.transform_bin_ms;
        sum.raster_ms += times.raster_ms;
        sum.light_ms += times.light_ms + times.denoise_ms;
        sum.taa_ms += times.taa_ms;
        sum.output_ms += times.output_ms;
    }
    const double stages_ms =
        sum.transform_bin_ms + sum.raster_ms + sum.light_ms + sum.taa_ms + sum.output_ms;
    desk_.times.add(
        {float(sum.transform_bin_ms), float(sum.raster_ms), float(sum.light_ms), float(sum.taa_ms),
         float(sum.output_ms), float(std::max(draw_ms - stages_ms, 0.0)), float(panels_ms)},
        draw_ms + panels_ms);
    // What stands still is finished at its own pace, and costs less with every frame.
    if (settings_.keeps_fps && desk_.keep_fps && moving_) {
        session_.setRenderScale(resolution_.next(session_.renderScale(), draw_ms + panels_ms,
                                                 panels_ms, desk_.wanted_fps));
    }
}

void Viewer::present(const std::function<void(ImageView<const Xrgb8>)>& show) {
    const double begin_ms = command::nowMs();
    show(canvas_.view());
    show_ms_ = command::nowMs() - begin_ms;
}

Image<Rgb8> Viewer::screenshot(bool panels) const {
    Image<Rgb8> out(canvas_.width(), canvas_.height());
    for (int y = 0; y < out.height(); ++y) {
        for (int x = 0; x < out.width(); ++x) {
            const Xrgb8 pixel = canvas_.at(x, y);
            out.at(x, y) = panels ? Rgb8{uint8_t(pixel >> 16), uint8_t(pixel >> 8), uint8_t(pixel)}
                                  : picture_.at(x, y);
        }
    }
    return out;
}

bool Viewer::idle() const {
    return !session_.playing() && !controls_.busy();
}

Requests Viewer::takeRequests() {
    Requests taken;
    std::swap(taken.quit, desk_.requests.quit);
    std::swap(taken.screenshot, desk_.requests.screenshot);
    std::swap(taken.screenshot_picture, desk_.requests.screenshot_picture);
    std::swap(taken.save_cameras, desk_.requests.save_cameras);
    return taken;
}

}  // namespace still::viewer
