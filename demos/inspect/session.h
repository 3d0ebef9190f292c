#pragma once
// A scene that is looked at: camera, time, two panes, and what is drawn over them. One call makes
// the next picture; windows, pages and scripts only turn input into calls of this class.
//
//   rig, time ──► recording (a growing CameraFile) ──► panes ──► overlays, magnifier ──► image
//
// Every drawn frame is an entry of the recording, and each pane is an ordinary FrameLoop over it:
// what was seen can be saved and rendered again, byte for byte.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "demos/inspect/look.h"
#include "demos/inspect/rig.h"
#include "demos/inspect/story_text.h"
#include "engine/frame_loop.h"
#include "engine/scene.h"
#include "rasterizer/workers.h"

namespace still::inspect {

struct SessionSettings {
    int width = 1280, height = 720;  ///< of the window, 1 … kMaxTargetSize
    ToneMap tone_map = ToneMap::none;
    SimdTarget simd = bestSimdTarget();
    std::function<double()> clock_ms{};  ///< as in FrameSettings; empty: no times are taken
    uint64_t (*ticks)() = nullptr;       ///< as in FrameSettings
    /// Samples of ssaa:N panes and of the reference for View::error that one draw() adds.
    int samples_per_draw = 4;
    int error_samples = 256;  ///< of the reference for View::error: 1 … 65536
};

/// What draw() hands out; valid until the next draw() or setScene().
struct Drawn {
    ImageView<const Rgb8> image;  ///< as large as the window
    bool changed = false;         ///< it differs, or may differ, from the one before
};

/// About the frame that a pane shows.
struct PaneReport {
    StageTimes times;         ///< zero when the last draw() had nothing to do for the pane
    double total_ms = 0;      ///< their sum
    RasterCounters counters;  ///< as FrameLoop::counters()
    bool at_rest = false;     ///< finished: further frames will not differ
    int frames = 0;           ///< since the pane began, or its settings or size changed
    int samples = 0;          ///< of an ssaa:N pane: those that the picture is the mean of, else 0
    std::optional<double> psnr_db;  ///< with View::error: against the reference as far as it is
};

/// What is seen at a place.
struct SurfacePoint {
    int surface = 0;  ///< number as in the id plane
    int object = 0;   ///< index into Scene::objects
    glm::dvec3 position{0};
};

class Session {
  public:
    /// `workers` must outlive the session.
    Session(Scene scene, const SessionSettings& settings, Workers& workers);
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    const Scene& scene() const;
    /// Another scene; or, keeping camera and time, the same one loaded again.
    void setScene(Scene scene, bool keep_camera);

    void resize(int width, int height);
    /// Panes are rendered at this part of the window's size and scaled up; 10 … 100. Where all of
    /// them upscale in time, it is their frames that get smaller (34 at least), and histories go
    /// on; else all begin anew.
    void setRenderScale(int percent);
    void resetRenderScale();  ///< 100, or what the panes' modes say
    int renderScale() const;
    int renderWidth() const;
    int renderHeight() const;

    // Camera. At first it is the scene's own, and follows it in time.
    const Rig& rig() const;
    /// For motions by hand; from now on the scene's own camera is not followed.
    Rig& steer();
    bool followsScene() const;
    void resetCamera();  ///< back to the scene's own, which is followed again
    /// Jumps: the next frame is a cut.
    void frameAll();                                      ///< all of the scene, as seen from here
    void lookFrom(const glm::dvec3& towards_eye);         ///< all of the scene, as seen from there
    void showView(size_t index);                          ///< one of Scene::views
    std::optional<SurfacePoint> surfaceAt(int x, int y);  ///< under a pixel of the window

    // Time, in frames of the scene. While it runs, each draw() goes on by one. It begins again
    // after the last one. Standing, it does not stop the panes: they finish their pictures.
    bool playing() const;
    void play(bool on);
    void step(int frames);  ///< ±1 is continuous, other steps are cuts; ends playing
    void scrub(int frame);  ///< 0 … lastSceneFrame(), the same
    int sceneFrame() const;
    int lastSceneFrame() const;  ///< of the last key, swap or cut; 0: nothing happens

    /// Both may be changed at any time; the next draw() compares. A changed mode begins anew.
    PaneSettings& pane(int index);  ///< 0: the left or only one, 1
    Look& look();
    int paneAt(int x) const;  ///< under a pixel of the window
    void pick(int x, int y);  ///< the pixel under a pixel of the window
    /// Of the picked pixel, as it is in the last picture; see story_text.h for words and a plot.
    std::optional<PickedStory> pickedStory();

    /// The next picture. When nothing has changed and both panes are finished, nothing is done.
    Drawn draw();

    const PaneReport& report(int pane) const;
    uint64_t hash(int pane) const;  ///< of its picture, as hashPlane() of FrameResult::output
    ImageView<const Rgb8> picture(int pane) const;  ///< what its mode made, at render size

    /// All frames since the pane began, or its settings or size changed. A FrameLoop with
    /// paneSettings() over it ends with the same bytes as picture(), except while ssaa:N converges.
    CameraFile recording(int pane) const;
    FrameSettings paneSettings(int pane) const;  ///< its camera.file is null

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace still::inspect
