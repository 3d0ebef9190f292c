#pragma once
// The window: SDL's, filled from memory without any GPU.

#include <SDL_events.h>

#include <memory>
#include <string>

#include "demos/stillframe/options.h"
#include "demos/stillframe/outcome.h"
#include "demos/viewer/ui_raster.h"

namespace still::viewer {

/// There is one at a time. The video driver is SDL's choice or that of SDL_VIDEODRIVER; `dummy` and
/// `offscreen` show nothing and need no screen.
class Window {
  public:
    static command::Outcome<Window> open(const std::string& title, command::Size size);

    void setTitle(const std::string& title);
    /// Asks for a size; what the system makes of it arrives as an event.
    void setSize(command::Size size);
    command::Size size() const;
    void show(ImageView<const Xrgb8> picture);
    /// True: the pointer is hidden and moves without end, for looking around.
    void holdMouse(bool on);

  private:
    struct Video {
        ~Video();
    };
    struct Destroy {
        void operator()(SDL_Window* window) const;
    };
    Window() = default;

    std::unique_ptr<Video> video_;
    std::unique_ptr<SDL_Window, Destroy> window_;
};

}  // namespace still::viewer
