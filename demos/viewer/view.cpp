// The window's loop, by people or by a script, and the files that leave the viewer.

#include "demos/viewer/view.h"

#include <SDL.h>

#include <algorithm>
#include <filesystem>
#include <thread>

#include "demos/stillframe/clock.h"
#include "demos/stillframe/file_cache.h"
#include "demos/stillframe/png.h"
#include "demos/stillframe/scene_source.h"
#include "demos/stillframe/whole_file.h"
#include "demos/viewer/script.h"
#include "demos/viewer/viewer.h"
#include "demos/viewer/window.h"
#include "engine/anti_aliasing.h"
#include "engine/camera.h"
#include "engine/read_file.h"

namespace still::viewer {
namespace {

using command::Interruption;
using command::Outcome;

constexpr double kScriptFrame_s = 1.0 / 60;
constexpr double kMostFps = 60;  // faster only warms the room
/// Panels need a few frames after an event until nothing in them moves.
constexpr int kSettleFrames = 4;
constexpr int kIdle_ms = 200;

std::string stemOf(const std::string& scene) {
    const size_t colon = scene.find(':');
    return scene.starts_with("builtin:") ? scene.substr(colon + 1)
                                         : std::filesystem::path(scene).stem().string();
}

/// NAME.KIND-N.EXTENSION in the current folder, with the first number that is free.
std::string freeName(const std::string& scene, const std::string& kind,
                     const std::string& extension) {
    for (int number = 1;; ++number) {
        const std::string name =
            stemOf(scene) + "." + kind + "-" + std::to_string(number) + extension;
        std::error_code error;
        if (!std::filesystem::exists(name, error)) {
            return name;
        }
    }
}

/// One run of the viewer in its window.
class Run {
  public:
    Run(Window window, Viewer& viewer, Interruption& interruption)
        : window_(std::move(window)), viewer_(viewer), interruption_(interruption) {}

    Outcome<void> byPeople();
    Outcome<void> byScript(const std::vector<ScriptStep>& steps);

  private:
    void drawAndShow(double seconds);
    void handle(SDL_Event& event);
    void waitOrPoll();
    void serve();
    void saveCameras();
    Outcome<void> step(const ScriptStep& step);

    Window window_;
    Viewer& viewer_;
    Interruption& interruption_;
    ScriptPlayer player_;
    std::string title_;
    int settle_ = kSettleFrames;
    bool drawn_ = false, quit_ = false;
};

void Run::handle(SDL_Event& event) {
    viewer_.handle(event);
    if (event.type == SDL_DROPFILE) {
        SDL_free(event.drop.file);
    }
    settle_ = kSettleFrames;
}

void Run::drawAndShow(double seconds) {
    if (viewer_.draw(seconds)) {
        settle_ = std::max(settle_, 1);
    }
    viewer_.present([&](ImageView<const Xrgb8> picture) { window_.show(picture); });
    drawn_ = true;
    if (title_ != viewer_.desk().scene_name) {
        title_ = viewer_.desk().scene_name;
        window_.setTitle(title_ + " - stillframe");
    }
    serve();
}

void Run::saveCameras() {
    Desk& desk = viewer_.desk();
    const CameraFile cameras = desk.session.recording(0);
    const std::string name = freeName(desk.scene_name, "cameras", ".json");
    const auto saved = command::writeWholeFiles({{name, cameraFileText(cameras)}}, interruption_);
    desk.say(saved ? name + ": " + std::to_string(cameras.frames.size()) + " frames"
                   : saved.error().message,
             !saved);
}

void Run::serve() {
    const Requests requests = viewer_.takeRequests();
    quit_ |= requests.quit;
    if (requests.screenshot || requests.screenshot_picture) {
        const std::string name = freeName(viewer_.desk().scene_name, "shot", ".png");
        const Image<Rgb8> picture = viewer_.screenshot(!requests.screenshot_picture);
        const auto saved = command::savePng(name, picture.view(), interruption_);
        viewer_.desk().say(saved ? name : saved.error().message, !saved);
    }
    if (requests.save_cameras) {
        saveCameras();
    }
}

void Run::waitOrPoll() {
    SDL_Event event;
    if (viewer_.idle() && settle_ == 0) {
        if (SDL_WaitEventTimeout(&event, kIdle_ms) == 0) {
            return;
        }
        handle(event);
    }
    while (SDL_PollEvent(&event) != 0) {
        handle(event);
    }
    settle_ = std::max(settle_ - 1, 0);
}

Outcome<void> Run::byPeople() {
    double last_ms = command::nowMs();
    bool held = false;
    while (!quit_) {
        waitOrPoll();
        if (held != viewer_.flying()) {
            held = viewer_.flying();
            window_.holdMouse(held);
        }
        const double now_ms = command::nowMs();
        drawAndShow(std::clamp((now_ms - last_ms) / 1000, 1e-4, 0.25));
        last_ms = now_ms;
        const double left_ms = 1000 / kMostFps - (command::nowMs() - now_ms);
        if (left_ms >= 1) {
            SDL_Delay(Uint32(left_ms));
        }
    }
    return {};
}

Outcome<void> Run::step(const ScriptStep& step) {
    for (std::vector<SDL_Event>& events : player_.eventsOf(step)) {
        SDL_Event real;
        while (SDL_PollEvent(&real) != 0) {  // the window is kept alive; people are not heard
            quit_ |= real.type == SDL_QUIT;
            if (real.type == SDL_DROPFILE) {
                SDL_free(real.drop.file);
            }
        }
        for (SDL_Event& event : events) {
            handle(event);
        }
        drawAndShow(kScriptFrame_s);
    }
    if (step.kind == ScriptStep::Kind::resize) {
        window_.setSize({step.x, step.y});
    }
    if (step.kind == ScriptStep::Kind::screenshot) {
        if (!drawn_) {
            drawAndShow(kScriptFrame_s);
        }
        return command::savePng(step.file, viewer_.screenshot(true).view(), interruption_);
    }
    quit_ |= step.kind == ScriptStep::Kind::quit;
    return {};
}

Outcome<void> Run::byScript(const std::vector<ScriptStep>& steps) {
    for (const ScriptStep& next : steps) {
        if (quit_) {
            break;
        }
        if (Outcome<void> done = step(next); !done) {
            return done;
        }
    }
    return {};
}

Outcome<ViewerSettings> settingsOf(const ViewOptions& options) {
    return command::parseAntiAliasing(options.anti_aliasing)
        .and_then([&](const AntiAliasingChoice& choice) {
            return command::parseTaaSettings(options.taa, choice.policy)
                .map([&](const TaaPolicy& policy) {
                    ViewerSettings settings;
                    settings.size = options.resolution;
                    settings.mode = {choice.mode, policy, choice.ssaa_samples};
                    settings.tone_map =
                        options.tone_map == "reinhard" ? ToneMap::reinhard : ToneMap::none;
                    settings.lights = options.lights;
                    settings.keeps_fps = options.script.empty();
                    settings.load = command::loadOptions(
                        options.limits,
                        options.no_cache ? std::filesystem::path() : command::usersCacheFolder());
                    return settings;
                });
        });
}

Outcome<std::vector<ScriptStep>> readScript(const std::string& file) {
    if (file.empty()) {
        return std::vector<ScriptStep>{};
    }
    return command::fromResult(readFile(file)).and_then([&](const std::string& text) {
        return parseScript(text, file);
    });
}

}  // namespace

Outcome<void> view(const ViewOptions& options, Interruption& interruption) {
    const Outcome<ViewerSettings> settings = settingsOf(options);
    const Outcome<std::vector<ScriptStep>> steps = readScript(options.script);
    if (!settings || !steps) {
        return tl::make_unexpected(settings ? steps.error() : settings.error());
    }
    Outcome<Scene> scene = command::openScene(options.scene, settings->load, options.lights);
    if (!scene) {
        return tl::make_unexpected(scene.error());
    }
    command::printWarnings(scene->warnings);
    const auto [width, height] = options.resolution;
    if (auto fits = command::checkFrameMemory(options.scene, *scene,
                                              {.width = width, .height = height}, options.limits);
        !fits) {
        return fits;
    }
    Outcome<Window> window = Window::open(options.scene, options.resolution);
    if (!window) {
        return tl::make_unexpected(window.error());
    }
    const int cores = std::max(1, int(std::thread::hardware_concurrency()));
    Workers workers(options.threads > 0 ? options.threads : cores);
    Viewer viewer(std::move(*scene), options.scene, *settings, workers);
    Run run(std::move(*window), viewer, interruption);
    return options.script.empty() ? run.byPeople() : run.byScript(*steps);
}

}  // namespace still::viewer
