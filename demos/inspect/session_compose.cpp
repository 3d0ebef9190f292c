// From the panes' pictures to the window's.

#include <algorithm>
#include <bit>
#include <glm/matrix.hpp>
#include <vector>

#include "demos/inspect/canvas.h"
#include "demos/inspect/session_state.h"
#include "demos/inspect/views.h"
#include "rasterizer/fixed.h"

namespace still::inspect {
namespace {

constexpr Rgb8 kDividerColour{255, 255, 255};
constexpr Rgb8 kPickedColour{255, 140, 0};

}  // namespace

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
        case View::history:
            return pane.paintStory(StoryPlane::history, out);
        case View::reprojected:
            return pane.paintStory(StoryPlane::reprojected, out);
        case View::clipped:
            return pane.paintStory(StoryPlane::rectified, out);
        case View::neighbourhood:
            return pane.paintStory(StoryPlane::box_middle, out);
        case View::rejection:
            return pane.paintRejections(out);
        case View::count:
            return paintCount(result.sample_count, result.confidence_full, out, workers);
        case View::confidence:
            return paintConfidence(result.confidence, result.confidence_full, out, workers);
        case View::tiles:
            return paintTiles(pane.tileWork(), pane.picture(), out, workers);
        case View::overdraw:
            return paintOverdraw(pane.overdraw(), out, workers);
        case View::error:
            return paintError(pane.picture(), reference.picture(), out, workers);
        case View::light:
            return paintLight(result.light, table, out, workers);
        case View::denoised:
            return paintLight(result.denoised, table, out, workers);
    }
}

ImageView<const Rgb8> Session::State::shownPicture(const Slot& slot) const {
    return slot.shown == View::picture ? slot.pane->picture() : slot.view_picture.view();
}

int Session::State::dividerColumn() const {
    const double place = look.divider > 0 ? std::min(look.divider, 1.0) : 0;
    return look.split ? int(place * settings.width + 0.5) : settings.width;
}

LensPixel Session::State::renderPixel(int x, int y) const {
    return {int(floorDiv(int64_t{x} * renderWidth(), int64_t{settings.width})),
            int(floorDiv(int64_t{y} * renderHeight(), int64_t{settings.height}))};
}

void Session::State::magnify() {
    std::array<std::vector<SampleOffset>, kPanes> patterns;
    std::vector<LensSource> sources;
    for (int i = 0; i < activePanes(); ++i) {
        const Slot& slot = slots[size_t(i)];
        patterns[size_t(i)] = slot.pane->pattern();
        LensSource source{.picture = shownPicture(slot),
                          .middle = renderPixel(look.magnifier.x, look.magnifier.y),
                          .pattern = patterns[size_t(i)],
                          .now = slot.pane->jitter()};
        if (look.picked) {
            source.picked = LensPixel{look.picked->x, look.picked->y};
        }
        sources.push_back(source);
    }
    drawMagnifier(look.magnifier, sources, canvas.view());
}

/// Four strokes around the picked pixel.
void Session::State::markPicked() {
    constexpr int kGap = 3, kStroke = 7;
    const ImageView<Rgb8> out = canvas.view();
    const auto middle = [](int pixel, int count, int window) {
        return int((int64_t{2} * pixel + 1) * window / (2 * count));
    };
    const int x = middle(look.picked->x, renderWidth(), out.width);
    const int y = middle(look.picked->y, renderHeight(), out.height);
    fillRectangle(out, x - kGap - kStroke, y, kStroke, 1, kPickedColour);
    fillRectangle(out, x + kGap + 1, y, kStroke, 1, kPickedColour);
    fillRectangle(out, x, y - kGap - kStroke, 1, kStroke, kPickedColour);
    fillRectangle(out, x, y + kGap + 1, 1, kStroke, kPickedColour);
}

void Session::State::compose() {
    canvas.resize(settings.width, settings.height);
    const ImageView<Rgb8> out = canvas.view();
    const int divider = dividerColumn();
    placePicture(shownPicture(slots[0]), 0, divider, look.smooth_upscale, out, workers);
    if (look.split) {
        placePicture(shownPicture(slots[1]), divider, out.width, look.smooth_upscale, out, workers);
    }
    overlay.draw(look.overlays, renderWidth(), renderHeight(), out);
    if (look.split) {
        fillRectangle(out, divider - 1, 0, 2, out.height, kDividerColour);
    }
    if (look.picked) {
        markPicked();
    }
    if (look.magnifier.on) {
        magnify();
    }
}

/// Index into Scene::objects of a surface's object.
int Session::State::objectOf(int surface) const {
    int first = 1, index = 0;
    for (const SceneObject& object : film.scene.objects) {
        first += int(film.scene.meshes[object.mesh].parts.size());
        if (surface < first) {
            break;
        }
        ++index;
    }
    return index;
}

std::optional<PickedStory> Session::State::pickedStory() {
    if (!look.picked || !slots[size_t(look.picked->pane)].pane) {
        return std::nullopt;
    }
    const PickedPixel at = *look.picked;
    Pane& pane = *slots[size_t(at.pane)].pane;
    if (pane.shownFrame() < 0) {
        return std::nullopt;
    }
    PickedStory story{.pixel = at,
                      .mode = pane.mode(),
                      .output = pane.picture().at(at.x, at.y),
                      .jitter_x_fx8 = pane.jitter().x_fx8,
                      .jitter_y_fx8 = pane.jitter().y_fx8,
                      .samples = pane.samples(),
                      .taa = pane.story(at.x, at.y)};
    const int surface = pane.sample().id.at(at.x, at.y) & kSurfaceMask;
    if (surface > 0) {
        story.surface = std::to_string(surface) + ", object " +
                        film.scene.objects[size_t(objectOf(surface))].name;
    }
    return story;
}

std::optional<SurfacePoint> Session::State::surfaceAt(int x, int y) {
    const LensPixel pixel = renderPixel(x, y);
    if (film.lastFrame() < 0 || pixel.x < 0 || pixel.y < 0 || pixel.x >= renderWidth() ||
        pixel.y >= renderHeight()) {
        return std::nullopt;
    }
    const GBuffer& centre = overlay.centreSamples(renderWidth(), renderHeight());
    const int surface = centre.id.at(pixel.x, pixel.y) & kSurfaceMask;
    if (surface == 0) {
        return std::nullopt;
    }
    SurfacePoint point{.surface = surface, .object = objectOf(surface)};
    const FrameState state =
        frameStateAt(film.scene, film.camera(), film.lastFrame(), renderWidth(), renderHeight());
    const double depth = double(std::bit_cast<float>(centre.depth.at(pixel.x, pixel.y)));
    // Reversed depth is (w − z) / 2w.
    const glm::dvec4 clip((pixel.x + 0.5) / renderWidth() * 2 - 1,
                          1 - (pixel.y + 0.5) / renderHeight() * 2, 1 - 2 * depth, 1);
    const glm::dvec4 world = glm::inverse(state.camera.view_projection) * clip;
    point.position = glm::dvec3(world) / world.w;
    return point;
}

}  // namespace still::inspect
