#pragma once
// Inside of a session.

#include <array>
#include <memory>

#include "demos/inspect/director.h"
#include "demos/inspect/magnifier.h"
#include "demos/inspect/overlay.h"
#include "demos/inspect/pane.h"
#include "demos/inspect/session.h"

namespace still::inspect {

constexpr int kPanes = 2;

/// A pane and what it is asked for.
struct Slot {
    PaneSettings wanted{};
    std::unique_ptr<Pane> pane;
    PaneReport report{};
    View shown = View::picture;
    Image<Rgb8> view_picture;  ///< of views that are not the mode's own picture
    bool stale = true;         ///< it is of another frame
};

struct Session::State {
    State(Scene scene, const SessionSettings& settings_in, Workers& workers_in);

    Film film;
    SessionSettings settings;
    Workers& workers;
    Director director;
    OutputTable table;
    std::array<Slot, kPanes> slots;
    Look look{}, shown_look{};
    Reference reference;  ///< for View::error
    Overlay overlay;
    int reference_frame = -1;  ///< that it is of; −1: none
    int render_percent = 100;
    int frame_percent = 0;  ///< FrameLoop::setRatio() of panes that upscale; 0: their modes' own
    bool drawn = false;     ///< `canvas` shows what the last draw() left
    Image<Rgb8> canvas;

    int renderWidth() const { return std::max(1, settings.width * render_percent / 100); }
    int renderHeight() const { return std::max(1, settings.height * render_percent / 100); }
    double aspect() const { return double(renderWidth()) / renderHeight(); }
    int activePanes() const { return look.split ? kPanes : 1; }
    int dividerColumn() const;
    int paneAt(int x) const { return x < dividerColumn() ? 0 : look.split ? 1 : 0; }
    /// The pixel of the panes under a pixel of the window.
    LensPixel renderPixel(int x, int y) const;
    bool errorIsShown() const;

    /// All panes do.
    bool upscalesInTime() const;
    int frameScale() const;
    void setFrameScale(int percent);
    int ratioOf(const Slot& slot) const;
    void setScene(Scene scene, bool keep_camera);
    void beginFilm();
    FrameSettings base() const;
    bool makePanes();
    void takeFrame();
    bool renderPanes();
    bool refineReference();
    void paintView(Slot& slot);
    ImageView<const Rgb8> shownPicture(const Slot& slot) const;
    void report(Slot& slot, bool worked);
    void compose();
    void magnify();
    void markPicked();
    int objectOf(int surface) const;
    std::optional<PickedStory> pickedStory();
    std::optional<SurfacePoint> surfaceAt(int x, int y);
};

}  // namespace still::inspect
