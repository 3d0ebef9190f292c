#pragma once
// The viewer without its window: events in, pixels out.

#include <functional>
#include <string>

#include "demos/stillframe/outcome.h"
#include "demos/viewer/controls.h"
#include "demos/viewer/desk.h"
#include "demos/viewer/dynamic_resolution.h"
#include "demos/viewer/file_watch.h"
#include "demos/viewer/ui.h"
#include "engine/load.h"

namespace still::viewer {

struct ViewerSettings {
    command::Size size{1280, 720};
    inspect::Mode mode{};  ///< of the first pane
    ToneMap tone_map = ToneMap::none;
    SimdTarget simd = bestSimdTarget();
    LoadOptions load{};    ///< of all scenes
    std::string lights{};  ///< see openScene(); of all scenes
    /// The frame rate is kept by measured times; else what is drawn depends on events alone.
    bool keeps_fps = true;
};

class Viewer {
  public:
    /// `name` is the scene's, as openScene() takes it. `workers` must outlive the viewer.
    Viewer(Scene scene, const std::string& name, const ViewerSettings& settings, Workers& workers);

    void handle(const SDL_Event& event);

    /// Draws the next frame, `seconds` > 0 after the one before. True when the picture of the scene
    /// is, or may be, another one.
    bool draw(double seconds);
    /// What `show` is busy with counts as time of the window.
    void present(const std::function<void(ImageView<const Xrgb8>)>& show);

    /// With panels, as in the window; and without.
    ImageView<const Xrgb8> canvas() const { return canvas_.view(); }
    Image<Rgb8> screenshot(bool panels) const;

    /// Nothing changes by itself: it may wait for events.
    bool idle() const;
    bool flying() const { return controls_.flying(); }

    /// What was asked for since the last call and is not the viewer's own work.
    Requests takeRequests();
    Desk& desk() { return desk_; }
    const Desk& desk() const { return desk_; }

  private:
    void open(const std::string& name, bool again);
    void openNeighbour(int step);
    void takeFileRequests();
    void pollFiles(double seconds);
    void ageMessage();
    void takeTimes(double draw_ms, double panels_ms);
    void paint(ImageView<const Rgb8> picture);

    ViewerSettings settings_;
    Workers& workers_;
    inspect::Session session_;
    Desk desk_{session_};
    Controls controls_{desk_};
    Ui ui_;
    FileWatch watch_;
    DynamicResolution resolution_;
    std::string tried_;  ///< the scene that was last opened, or failed to
    ImageView<const Rgb8> picture_;
    Image<Xrgb8> canvas_;
    double since_poll_s_ = 0;
    double show_ms_ = 0;      ///< of the last present()
    int message_frames_ = 0;  ///< that the message has been shown for
    std::string aged_message_;
    CameraPose last_pose_{};
    bool moving_ = false;  ///< the camera, or time
};

}  // namespace still::viewer
