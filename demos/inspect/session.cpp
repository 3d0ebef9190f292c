#include "demos/inspect/session.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

#include "demos/inspect/canvas.h"
#include "demos/inspect/director.h"
#include "demos/inspect/pane.h"
#include "demos/inspect/views.h"
#include "engine/hash.h"
#include "postfx/metrics.h"

namespace still::inspect {
namespace {

constexpr int kPanes = 2;
constexpr Rgb8 kDividerColour{255, 255, 255};

bool isNoisy(const Scene& scene) {
    return std::any_of(
        scene.materials.begin(), scene.materials.end(),
        [](const Material& material) { return material.alpha_mode == AlphaMode::stochastic; });
}

std::vector<WindingBits> windingsOf(const Scene& scene, Workers& workers) {
    std::vector<WindingBits> windings(scene.meshes.size());
    workers.parallelFor(int(windings.size()), 1, [&](int begin, int end, int) {
        for (int i = begin; i < end; ++i) {
            windings[size_t(i)] = windingBits(scene.meshes[size_t(i)]);
        }
    });
    return windings;
}

/// A pane and what it is asked for.
struct Slot {
    PaneSettings wanted{};
    std::unique_ptr<Pane> pane;
    PaneReport report{};
    View shown = View::picture;
    Image<Rgb8> view_picture;  ///< of views that are not the mode's own picture
    bool stale = true;         ///< it is of another frame
};

}  // namespace

struct Session::State {
    State(Scene scene, const SessionSettings& settings_in, Workers& workers_in);

    Film film;
    SessionSettings settings;
    Workers& workers;
    Director director;
    OutputTable table;
    std::array<Slot, kPanes> slots;
    Look look{}, shown_look{};
    Reference reference;       ///< for View::error
    int reference_frame = -1;  ///< that it is of; −1: none
    int render_percent = 100;
    bool drawn = false;  ///< `canvas` shows what the last draw() left
    Image<Rgb8> canvas;

    int renderWidth() const { return std::max(1, settings.width * render_percent / 100); }
    int renderHeight() const { return std::max(1, settings.height * render_percent / 100); }
    double aspect() const { return double(renderWidth()) / renderHeight(); }
    int activePanes() const { return look.split ? kPanes : 1; }
    int dividerColumn() const;
    bool errorIsShown() const;

    void setScene(Scene scene, bool keep_camera);
    void resizePanes();
    FrameSettings base() const;
    bool makePanes();
    void takeFrame();
    bool renderPanes();
    bool refinePanes();
    bool refineReference();
    void paintView(Slot& slot);
    ImageView<const Rgb8> shownPicture(const Slot& slot) const;
    void report(Slot& slot, bool worked);
    void compose();
};

Session::State::State(Scene scene, const SessionSettings& settings_in, Workers& workers_in)
    : settings(settings_in),
      workers(workers_in),
      table(settings_in.tone_map),
      reference(film, settings_in.simd, workers_in) {
    assert(settings.width >= 1 && settings.width <= kMaxTargetSize);
    assert(settings.height >= 1 && settings.height <= kMaxTargetSize);
    slots[1].wanted.mode = {.anti_aliasing = AntiAliasing::none};
    setScene(std::move(scene), false);
}

void Session::State::setScene(Scene scene, bool keep_camera) {
    for (Slot& slot : slots) {
        slot.pane.reset();
    }
    film.scene = std::move(scene);
    film.windings = windingsOf(film.scene, workers);
    film.noisy = isNoisy(film.scene);
    film.recording.frames.clear();
    reference_frame = -1;
    look.picked.reset();
    director.begin(film.scene, aspect(), keep_camera);
}

FrameSettings Session::State::base() const {
    FrameSettings base;
    base.width = renderWidth();
    base.height = renderHeight();
    base.tone_map = settings.tone_map;
    base.simd = settings.simd;
    base.clock_ms = settings.clock_ms;
    base.ticks = settings.ticks;
    return base;
}

void Session::State::resizePanes() {
    for (Slot& slot : slots) {
        slot.pane.reset();
    }
    film.recording.frames.clear();
    reference_frame = -1;
    look.picked.reset();
    drawn = false;
}

/// Begins panes that are not there or whose mode has changed. True when there is a new one.
bool Session::State::makePanes() {
    bool made = false;
    for (int i = 0; i < kPanes; ++i) {
        Slot& slot = slots[size_t(i)];
        if (i >= activePanes()) {
            slot.pane.reset();
        } else if (!slot.pane || !(slot.pane->mode() == slot.wanted.mode)) {
            slot.pane = std::make_unique<Pane>(film, base(), slot.wanted.mode, workers);
            made = true;
        }
    }
    return made;
}

/// Adds an entry to the recording when there is anything new to see, or to finish.
void Session::State::takeFrame() {
    const bool made = makePanes();
    auto& frames = film.recording.frames;
    film.recording.width = renderWidth();
    film.recording.height = renderHeight();
    if (made && !frames.empty()) {
        // A pane that begins sees nothing move, so that its frames are those of a film that begins
        // here: the recording from here on tells all about it.
        CameraFileFrame again = frames.back();
        again.cut = false;
        frames.push_back(again);
        return;
    }
    if (!frames.empty()) {
        director.tick(film.scene);
    }
    const CameraFileFrame entry = director.take(film.scene, aspect());
    const bool unfinished = std::any_of(slots.begin(), slots.end(), [](const Slot& slot) {
        return slot.pane && slot.pane->wantsFrames();
    });
    const bool news = frames.empty() || entry.cut || entry.view != frames.back().view ||
                      entry.projection != frames.back().projection ||
                      entry.scene_frame != frames.back().scene_frame;
    if (news || unfinished) {
        frames.push_back(entry);
    }
}

bool Session::State::errorIsShown() const {
    return std::any_of(slots.begin(), slots.end(), [](const Slot& slot) {
        return slot.pane && slot.wanted.view == View::error;
    });
}

/// True when the reference for View::error is wanted and got better.
bool Session::State::refineReference() {
    if (!errorIsShown()) {
        reference_frame = -1;
        return false;
    }
    const int last = film.lastFrame();
    if (reference_frame < 0 || !film.sameView(reference_frame, last)) {
        reference.begin(last, renderWidth(), renderHeight(), settings.error_samples);
    }
    reference_frame = last;
    if (reference.complete()) {
        return false;
    }
    reference.add(settings.samples_per_draw);
    reference.encode(table);
    return true;
}

/// Brings all panes to the last frame of the film. True when one has a new picture.
bool Session::State::renderPanes() {
    const bool new_reference = refineReference();
    bool changed = false;
    for (Slot& slot : slots) {
        if (!slot.pane) {
            continue;
        }
        Pane& pane = *slot.pane;
        bool worked = pane.wantsLastFrame();
        pane.forgetTimes();
        if (worked) {
            pane.render();
        }
        if (pane.wantsSamples()) {
            pane.refine(settings.samples_per_draw);
            worked = true;
        }
        slot.stale |= worked || slot.shown != slot.wanted.view ||
                      (new_reference && slot.wanted.view == View::error);
        changed |= slot.stale;
        if (slot.stale) {
            paintView(slot);
        }
        report(slot, worked);
    }
    return changed;
}

void Session::State::report(Slot& slot, bool worked) {
    const Pane& pane = *slot.pane;
    PaneReport& report = slot.report;
    report.times = pane.times();
    report.total_ms = report.times.transform_bin_ms + report.times.raster_ms + report.times.taa_ms +
                      report.times.output_ms;
    report.counters = worked ? pane.counters() : RasterCounters{};
    report.at_rest = pane.atRest();
    report.frames = film.lastFrame() - pane.firstFrame() + 1;
    report.samples = pane.samples();
    report.psnr_db.reset();
    if (slot.wanted.view == View::error) {
        report.psnr_db = psnrDb(pixelError(pane.picture(), reference.picture()));
    }
}

/// Makes what the slot shows, unless that is the pane's own picture.
void Session::State::paintView(Slot& slot) {
    Pane& pane = *slot.pane;
    slot.shown = slot.wanted.view;
    slot.stale = false;
    if (slot.shown == View::picture) {
        return;
    }
    slot.view_picture.resize(renderWidth(), renderHeight());
    const ImageView<Rgb8> out = slot.view_picture.view();
    const FrameResult& result = pane.result();
    switch (slot.shown) {
        case View::picture:
            break;
        case View::sample:
            return paintColour(pane.sample(), table, out, workers);
        case View::depth:
            return paintDepth(pane.sample(), out, workers);
        case View::normal:
            return paintNormal(pane.sample(), out, workers);
        case View::id:
            return paintId(pane.sample(), out, workers);
        case View::motion:
            return paintMotion(pane.sample(), out, workers);
        case View::count:
            return paintCount(result.sample_count, result.confidence_full, out, workers);
        case View::confidence:
            return paintCount(result.confidence, result.confidence_full, out, workers);
        case View::error:
            return paintError(pane.picture(), reference.picture(), out, workers);
    }
}

ImageView<const Rgb8> Session::State::shownPicture(const Slot& slot) const {
    return slot.shown == View::picture ? slot.pane->picture() : slot.view_picture.view();
}

int Session::State::dividerColumn() const {
    const int column = int(look.divider * settings.width + 0.5);
    return look.split ? std::clamp(column, 0, settings.width) : settings.width;
}

void Session::State::compose() {
    canvas.resize(settings.width, settings.height);
    const ImageView<Rgb8> out = canvas.view();
    const int divider = dividerColumn();
    placePicture(shownPicture(slots[0]), 0, divider, look.smooth_upscale, out, workers);
    if (look.split) {
        placePicture(shownPicture(slots[1]), divider, out.width, look.smooth_upscale, out, workers);
        fillRectangle(out, divider - 1, 0, 2, out.height, kDividerColour);
    }
}

Session::Session(Scene scene, const SessionSettings& settings, Workers& workers)
    : state_(std::make_unique<State>(std::move(scene), settings, workers)) {}

Session::~Session() = default;

const Scene& Session::scene() const {
    return state_->film.scene;
}

void Session::setScene(Scene scene, bool keep_camera) {
    state_->setScene(std::move(scene), keep_camera);
}

void Session::resize(int width, int height) {
    assert(width >= 1 && width <= kMaxTargetSize && height >= 1 && height <= kMaxTargetSize);
    if (width != state_->settings.width || height != state_->settings.height) {
        state_->settings.width = width;
        state_->settings.height = height;
        state_->resizePanes();
    }
}

void Session::setRenderScale(int percent) {
    assert(percent >= 10 && percent <= 100);
    if (percent != state_->render_percent) {
        state_->render_percent = percent;
        state_->resizePanes();
    }
}

int Session::renderScale() const {
    return state_->render_percent;
}

int Session::renderWidth() const {
    return state_->renderWidth();
}

int Session::renderHeight() const {
    return state_->renderHeight();
}

const Rig& Session::rig() const {
    return state_->director.rig();
}

Rig& Session::steer() {
    return state_->director.steer();
}

bool Session::followsScene() const {
    return state_->director.follows();
}

void Session::resetCamera() {
    state_->director.reset(state_->film.scene);
}

void Session::frameAll() {
    const CameraPose& pose = rig().pose();
    lookFrom(pose.eye - pose.target);
}

void Session::lookFrom(const glm::dvec3& towards_eye) {
    state_->director.frame(state_->film.scene, towards_eye, state_->aspect());
}

void Session::showView(size_t index) {
    assert(index < scene().views.size());
    state_->director.show(scene(), scene().views[index].pose);
}

bool Session::playing() const {
    return state_->director.playing();
}

void Session::play(bool on) {
    state_->director.play(on);
}

void Session::step(int frames) {
    scrub(sceneFrame() + frames);
}

void Session::scrub(int frame) {
    state_->director.scrub(scene(), frame);
}

int Session::sceneFrame() const {
    return state_->director.sceneFrame();
}

int Session::lastSceneFrame() const {
    return state_->director.lastSceneFrame();
}

PaneSettings& Session::pane(int index) {
    return state_->slots[size_t(index)].wanted;
}

Look& Session::look() {
    return state_->look;
}

int Session::paneAt(int x) const {
    return x < state_->dividerColumn() ? 0 : state_->look.split ? 1 : 0;
}

void Session::pick(int x, int y) {
    const State& s = *state_;
    state_->look.picked = PickedPixel{
        paneAt(x), std::clamp(x * renderWidth() / s.settings.width, 0, renderWidth() - 1),
        std::clamp(y * renderHeight() / s.settings.height, 0, renderHeight() - 1)};
}

Drawn Session::draw() {
    State& s = *state_;
    s.takeFrame();
    const bool changed = s.renderPanes() || !s.drawn || s.shown_look != s.look;
    if (changed) {
        s.compose();
        s.shown_look = s.look;
        s.drawn = true;
    }
    return {s.canvas.view(), changed};
}

const PaneReport& Session::report(int pane) const {
    return state_->slots[size_t(pane)].report;
}

uint64_t Session::hash(int pane) const {
    return hashPlane(picture(pane));
}

ImageView<const Rgb8> Session::picture(int pane) const {
    const Slot& slot = state_->slots[size_t(pane)];
    return slot.pane ? slot.pane->picture() : ImageView<const Rgb8>{};
}

CameraFile Session::recording(int pane) const {
    const State& s = *state_;
    CameraFile file = s.film.recording;
    const Slot& slot = s.slots[size_t(pane)];
    file.frames.erase(file.frames.begin(),
                      file.frames.begin() + (slot.pane ? slot.pane->firstFrame() : 0));
    return file;
}

FrameSettings Session::paneSettings(int pane) const {
    const Slot& slot = state_->slots[size_t(pane)];
    FrameSettings settings = slot.pane ? slot.pane->settings() : state_->base();
    settings.camera = {};
    return settings;
}

}  // namespace still::inspect
