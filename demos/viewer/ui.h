#pragma once
// Dear ImGui between SDL's events and our pixels.

#include <SDL_events.h>

#include <array>
#include <memory>

#include "demos/stillframe/options.h"
#include "demos/viewer/ui_raster.h"

struct ImGuiContext;

namespace still::viewer {

/// One per process, because Dear ImGui's current context is global.
class Ui {
  public:
    Ui();

    /// Takes notes of mouse and keys.
    void handle(const SDL_Event& event);
    /// Between begin() and end() panels are declared. `seconds` since the last frame, > 0.
    void begin(command::Size window, double seconds);
    void end();
    /// The panels of the last end(), over a picture.
    void draw(ImageView<Xrgb8> canvas) const;

    /// As of the last begin(): events are the panels', not the scene's.
    bool wantsMouse() const;
    bool wantsKeys() const;

  private:
    void handleButton(const SDL_MouseButtonEvent& event);

    struct Destroy {
        void operator()(ImGuiContext* context) const;
    };
    std::unique_ptr<ImGuiContext, Destroy> context_;
    ImageView<const uint8_t> atlas_;
    std::array<bool, 3> button_down_{};
    /// Pressed since the last begin(): a click that is over before a frame is drawn counts, too.
    std::array<bool, 3> button_pressed_{};
};

}  // namespace still::viewer
