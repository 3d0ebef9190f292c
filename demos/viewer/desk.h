#pragma once
// What the parts of the viewer share: the session, what is open, and what somebody has asked for.

#include <array>
#include <optional>
#include <string>

#include "demos/inspect/session.h"
#include "demos/viewer/keys.h"

namespace still::viewer {

/// Times of the last frames, for the graph.
struct TimeHistory {
    static constexpr size_t kLength = 120;
    static constexpr size_t kStages =
        7;  ///< transform and bin, raster, light, taa, output, the rest, panels

    std::array<std::array<float, kLength>, kStages> stage_ms{};  ///< oldest first
    double frame_ms = 0;  ///< running mean, from one drawn frame to the next

    void add(const std::array<float, kStages>& times_ms, double frame_ms_now);
};

/// Panels and lines that are shown.
struct Shown {
    bool ui = true;  ///< false hides all of them
    bool help = false, fps = false, name = true;
    bool taa = false, times = false, story = false;
};

/// What is done after the frame, by who owns files and window.
struct Requests {
    bool quit = false, reload = false;
    bool screenshot = false, screenshot_picture = false, save_cameras = false;
    int file_step = 0;  ///< −1 and 1: previous and next
    std::optional<std::string> open{};
};

struct Desk {
    inspect::Session& session;
    Shown shown{};
    Requests requests{};
    TimeHistory times{};
    bool keep_fps = false;
    int wanted_fps = 30;
    std::string scene_name{};  ///< as it was opened
    std::string message{};     ///< the last thing that went well or wrong, one line
    bool message_is_error = false;
    int width = 0, height = 0;  ///< of the window
    int mouse_x = 0, mouse_y = 0;
    int view = -1;       ///< the named view last shown
    Image<Rgb8> plot{};  ///< of the picked pixel; must stay until the panels are drawn
    ImageView<const Rgb8> plot_view{};

    /// What a key or a button does.
    void perform(Action action);
    void say(std::string text, bool is_error);

  private:
    void performView(Action action);
    void performPane(Action action);
    void performTime(Action action);
    void toggleMagnifier();
    void showView(int step);
};

}  // namespace still::viewer
