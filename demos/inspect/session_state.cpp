// From input to the panes' pictures.

#include "demos/inspect/session_state.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "postfx/metrics.h"

namespace still::inspect {
namespace {

bool isNoisy(const Scene& scene) {
    const auto stochastic = [](const Material& material) {
        return material.alpha_mode == AlphaMode::stochastic;
    };
    return scene.lights.sampled() ||
           std::any_of(scene.materials.begin(), scene.materials.end(), stochastic);
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

}  // namespace

Session::State::State(Scene scene, const SessionSettings& settings_in, Workers& workers_in)
    : settings(settings_in),
      workers(workers_in),
      table(settings_in.tone_map),
      reference(film, settings_in.simd, workers_in),
      overlay(film, settings_in.simd, workers_in) {
    assert(settings.width >= 1 && settings.width <= kMaxTargetSize);
    assert(settings.height >= 1 && settings.height <= kMaxTargetSize);
    slots[1].wanted.mode = {.anti_aliasing = AntiAliasing::none};
    setScene(std::move(scene), false);
}

void Session::State::setScene(Scene scene, bool keep_camera) {
    beginFilm();
    film.scene = std::move(scene);
    film.windings = windingsOf(film.scene, workers);
    film.noisy = isNoisy(film.scene);
    overlay.forgetScene();
    reference.forgetScene();
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

bool Session::State::upscalesInTime() const {
    return std::all_of(slots.begin(), slots.begin() + activePanes(), [](const Slot& slot) {
        return slot.wanted.mode.anti_aliasing == AntiAliasing::taa &&
               still::upscalesInTime(slot.wanted.mode.policy);
    });
}

int Session::State::frameScale() const {
    const int ratio_fx8 = slots[0].wanted.mode.policy.ratio_fx8;
    return frame_percent > 0 ? frame_percent : (25600 + ratio_fx8 / 2) / ratio_fx8;
}

int Session::State::ratioOf(const Slot& slot) const {
    return frame_percent > 0 ? std::clamp(25600 / frame_percent, kNativeRatio_fx8, kMaxRatio_fx8)
                             : slot.wanted.mode.policy.ratio_fx8;
}

/// 0: as small as their modes say.
void Session::State::setFrameScale(int percent) {
    if (percent == frame_percent || percent == frameScale()) {
        return;
    }
    frame_percent = percent;
    for (Slot& slot : slots) {
        if (slot.pane) {
            slot.pane->setRatio(ratioOf(slot));
        }
    }
}

/// Another scene or size: all that was drawn is gone.
void Session::State::beginFilm() {
    for (Slot& slot : slots) {
        slot.pane.reset();
    }
    film.recording.frames.clear();
    reference_frame = -1;
    overlay.forgetFrames();
    look.picked.reset();
    drawn = false;
}

/// Begins panes that are not there or whose mode has changed. True when there is a new one.
bool Session::State::makePanes() {
    bool made = false;
    const bool other_mode = std::any_of(slots.begin(), slots.end(), [](const Slot& slot) {
        return slot.pane && !(slot.pane->mode() == slot.wanted.mode);
    });
    if (other_mode) {
        setFrameScale(0);
    }
    for (int i = 0; i < kPanes; ++i) {
        Slot& slot = slots[size_t(i)];
        if (i >= activePanes()) {
            slot.pane.reset();
        } else if (!slot.pane || !(slot.pane->mode() == slot.wanted.mode)) {
            slot.pane = std::make_unique<Pane>(film, base(), slot.wanted.mode, workers);
            if (frame_percent > 0) {
                slot.pane->setRatio(ratioOf(slot));
            }
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
    const StageTimes& times = report.times;
    report.total_ms = times.transform_bin_ms + times.raster_ms + times.light_ms + times.denoise_ms +
                      times.taa_ms + times.output_ms;
    report.counters = worked ? pane.counters() : RasterCounters{};
    report.at_rest = pane.atRest();
    report.frames = film.lastFrame() - pane.firstFrame() + 1;
    report.samples = pane.samples();
    report.psnr_db.reset();
    if (slot.wanted.view == View::error) {
        report.psnr_db = psnrDb(pixelError(pane.picture(), reference.picture()));
    }
}

}  // namespace still::inspect
