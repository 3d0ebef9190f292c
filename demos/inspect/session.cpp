#include "demos/inspect/session.h"

#include <algorithm>
#include <cassert>
#include <optional>
#include <utility>

#include "demos/inspect/session_state.h"
#include "engine/hash.h"

namespace still::inspect {

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
        state_->beginFilm();
    }
}

void Session::setRenderScale(int percent) {
    assert(percent >= 10 && percent <= 100);
    if (state_->upscalesInTime()) {
        state_->setFrameScale(percent);
        return;
    }
    if (percent == state_->render_percent) {
        return;
    }
    std::optional<PickedPixel> picked = state_->look.picked;
    const int width = renderWidth(), height = renderHeight();
    state_->render_percent = percent;
    state_->beginFilm();
    if (picked) {  // the pixel that covers the old one's middle
        picked->x = (2 * picked->x + 1) * renderWidth() / (2 * width);
        picked->y = (2 * picked->y + 1) * renderHeight() / (2 * height);
        state_->look.picked = picked;
    }
}

void Session::resetRenderScale() {
    state_->setFrameScale(0);
    if (!state_->upscalesInTime()) {
        setRenderScale(100);
    }
}

int Session::renderScale() const {
    return state_->upscalesInTime() ? state_->frameScale() : state_->render_percent;
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
    return state_->paneAt(x);
}

void Session::pick(int x, int y) {
    const LensPixel pixel = state_->renderPixel(x, y);
    state_->look.picked = PickedPixel{paneAt(x), std::clamp(pixel.x, 0, renderWidth() - 1),
                                      std::clamp(pixel.y, 0, renderHeight() - 1)};
}

std::optional<PickedStory> Session::pickedStory() {
    return state_->pickedStory();
}

std::optional<SurfacePoint> Session::surfaceAt(int x, int y) {
    return state_->surfaceAt(x, y);
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
