#include "demos/scenes/atlas.h"

#include <algorithm>

#include "demos/scenes/atlas_scenes.h"

namespace still {
namespace {

using namespace scenes::atlas;

/// The last quarter of the first jitter period. A still scene has one reference for
/// all of them, so every frame is compared.
const AtlasSegment kStill{.name = "still", .first = 48, .last = 63, .ssaa_samples = 1024};
const AtlasSegment kFirstStill{.name = "first", .first = 0, .last = 0, .ssaa_samples = 1024};
constexpr int kEventFrame = 24;

AtlasCase stillCase(const char* name, const char* failure, const char* measure, Scene (*make)()) {
    return {.name = name,
            .failure = failure,
            .measure = measure,
            .make = make,
            .segments = {kFirstStill, kStill}};
}

/// From frame 24 on histories are as good as they get. Nearly all the time of an atlas goes into
/// references, so scenes that take long have fewer frames.
AtlasCase movingCase(const char* name, const char* failure, const char* measure, Scene (*make)(),
                     int frames = 16) {
    return {.name = name,
            .failure = failure,
            .measure = measure,
            .make = make,
            .segments = {{.name = "moving", .first = 24, .last = 24 + frames - 1}}};
}

AtlasCase eventCase(const char* name, const char* failure, const char* measure, Scene (*make)()) {
    return {.name = name,
            .failure = failure,
            .measure = measure,
            .make = make,
            .segments = {{.name = "event", .first = kEventFrame - 1, .last = kEventFrame + 10}},
            .event_frame = kEventFrame};
}

std::vector<AtlasCase> edgeCases() {
    return {
        movingCase("disocclusion",
                   "What a fast object uncovers has no history, and the object's own colours stay "
                   "behind as a ghost.",
                   "ghost_area", makeDisocclusion),
        stillCase("wires-still",
                  "A wire thinner than a pixel is missed by most samples; clipping to the "
                  "neighbourhood throws away the samples that hit it.",
                  "psnr", makeWiresStill),
        movingCase("wires-sway",
                   "A swaying wire is gone from most frames' neighbourhoods and motion vectors.",
                   "flicker", makeWiresSway),
        movingCase("wires-pan",
                   "Under a panning camera a wire's motion and its history are found only where a "
                   "sample hits it.",
                   "psnr", makeWiresPan),
        stillCase("fence-still",
                  "An alpha test is all or nothing per sample, so a mesh of wires boils.", "psnr",
                  makeFenceStill),
        movingCase("fence-pan",
                   "Wires and the wall behind them move at different speeds through every pixel.",
                   "flip", makeFencePan),
        stillCase("leaves-still", "Cut-out leaves alias at every border, in several layers.",
                  "flicker", makeLeavesStill),
        movingCase("leaves-turn",
                   "Turning leaves uncover each other everywhere; one history mixes them.",
                   "sharpness", makeLeavesTurn),
    };
}

std::vector<AtlasCase> patternCases() {
    return {
        stillCase("zone-plate-still",
                  "Rings finer than pixels fold into false rings unless many samples are averaged.",
                  "psnr", makeZonePlateStill),
        movingCase("zone-plate-slow",
                   "At 0.1 to 0.5 pixels per frame every frame resamples the history anew, and "
                   "each time it gets softer.",
                   "sharpness", makeZonePlateSlow),
        movingCase("zone-plate-half",
                   "At exactly half a pixel per frame bilinear resampling blurs most, and jitter "
                   "and motion may lock together.",
                   "sharpness", makeZonePlateHalf),
        stillCase("checker-still", "Towards the horizon checks are finer than pixels and shimmer.",
                  "flicker", makeCheckerStill),
        movingCase("checker-slow", "A slow turn makes the false pattern at the horizon crawl.",
                   "flicker", makeCheckerSlow),
        movingCase("checker-half", "A turn by half a pixel per frame blurs the near checks.",
                   "sharpness", makeCheckerHalf),
        stillCase("sparkle-still",
                  "Highlights on a bumpy normal map are smaller than pixels and much brighter.",
                  "flicker", makeSparkleStill),
        movingCase("sparkle-pan",
                   "Moving highlights are outliers in every neighbourhood: kept they smear, "
                   "clipped they flash.",
                   "flicker", makeSparklePan),
        stillCase("parallax-still",
                  "Steps of a height map alias inside a surface, where depth and id see no edge.",
                  "psnr", makeParallaxStill),
        movingCase("parallax-pan",
                   "Motion is that of the flat surface and not that of the ground that is seen.",
                   "flip", makeParallaxPan, 8),
    };
}

std::vector<AtlasCase> cameraCases() {
    return {
        movingCase("rotate", "Motion differs from pixel to pixel, and highlights do not follow it.",
                   "psnr", makeRotate),
        movingCase("roll", "A rolling camera resamples every pixel at another fraction.",
                   "sharpness", makeRoll),
        movingCase("zoom", "A zoom stretches the history, which has less detail than is needed.",
                   "sharpness", makeZoom),
        movingCase("fast-pan",
                   "At 60 pixels per frame a fifth of the picture is new in every frame.", "flip",
                   makeFastPan),
    };
}

std::vector<AtlasCase> shadingCases() {
    return {
        eventCase("light-on", "The dark history drags behind when a lamp goes on.",
                  "recovery_frames", makeLightOn),
        eventCase("light-off", "The bright history glows on when the lamp goes off.",
                  "recovery_frames", makeLightOff),
        movingCase("light-flicker",
                   "Every frame has another brightness, so that no history is right.", "psnr",
                   makeLightFlicker),
        stillCase("glass-still",
                  "Stochastic transparency is noise, which clipping keeps alive instead of "
                  "averaging it.",
                  "flicker", makeGlassStill),
        movingCase("glass-move",
                   "A pixel of glass shows now the pane, now what is behind it, each with another "
                   "motion.",
                   "flip", makeGlassMove),
        stillCase("dither-still", "An ordered dither beats with the pixels and with the jitter.",
                  "flicker", makeDitherStill),
        movingCase("dither-pan", "A dither under a moving camera crawls.", "flicker",
                   makeDitherPan),
    };
}

std::vector<AtlasCase> surfaceCases() {
    return {
        eventCase("material-swap", "The old material shines through when a surface gets another.",
                  "recovery_frames", makeMaterialSwap),
        movingCase("texture-scroll",
                   "A texture runs over a still surface: motion vectors say that nothing moves.",
                   "flip", makeTextureScroll),
        movingCase("screen", "The picture on a screen changes and its surface does not.", "flip",
                   makeScreen),
        movingCase("moving-shadow", "A shadow that wanders over still ground leaves a trail.",
                   "flip", makeMovingShadow),
        movingCase("noise", "Every frame has another noise, of which a history keeps the mean.",
                   "psnr", makeNoise),
        movingCase("low-resolution",
                   "Cells of many pixels change at a quarter of the frame rate, all at once.",
                   "flip", makeLowResolution),
    };
}

std::vector<AtlasCase> startCases() {
    AtlasCase cut = eventCase("cut",
                              "After a cut there is no history; what is used of the old picture "
                              "is wrong everywhere.",
                              "recovery_frames", makeCut);
    AtlasCase resize{.name = "resize",
                     .failure = "A history of another size cannot be used as it stands.",
                     .measure = "recovery_frames",
                     .make = makeResize,
                     .segments = {{.name = "event",
                                   .first = kEventFrame,
                                   .last = kEventFrame + 10,
                                   .ssaa_samples = 1024},
                                  {.name = "still",
                                   .first = kEventFrame + kStill.first,
                                   .last = kEventFrame + kStill.last,
                                   .ssaa_samples = 1024}},
                     .event_frame = kEventFrame,
                     .resize_frame = kEventFrame};
    AtlasCase eternity = stillCase("long",
                                   "Rounding in a history that is kept for 10,000 frames adds up "
                                   "to a drift.",
                                   "psnr", makeLong);
    eternity.segments.push_back(
        {.name = "late", .first = 9936, .last = 9999, .ssaa_samples = 1024});
    eternity.slow = true;
    return {
        cut,
        movingCase("screen-edges",
                   "Detail that enters at the border has no history, and outside the picture "
                   "there is nothing to filter with.",
                   "psnr", makeScreenEdges),
        movingCase("depth-pan",
                   "Over a depth range of 1e5 a threshold that is right for the near pane is "
                   "wrong for the far one.",
                   "ghost_area", makeDepthPan),
        stillCase("hdr-still",
                  "Next to an edge sixteen times as bright as white the mean of the light is not "
                  "the mean of what is seen.",
                  "psnr", makeHdrStill),
        movingCase("hdr-move", "A moving bright edge leaves steps and a bright trail.", "flicker",
                   makeHdrMove),
        stillCase("slivers-still",
                  "Ten triangles share a pixel; ids and normals of one sample tell nothing of the "
                  "others.",
                  "flicker", makeSliversStill),
        movingCase("slivers-turn",
                   "Tests of id, depth and normal refuse every history of triangles smaller than "
                   "pixels.",
                   "psnr", makeSliversTurn, 8),
        eternity,
        resize,
    };
}

std::vector<AtlasCase> courtyardCases() {
    AtlasCase pan =
        movingCase("courtyard-pan",
                   "A pan of 4 pixels per frame at 960×540 blurs a whole picture of fine detail.",
                   "psnr", makeCourtyardPan, 12);
    pan.segments.insert(pan.segments.begin(), {.name = "first", .first = 0, .last = 0});
    return {
        movingCase("courtyard-still",
                   "Most of the picture stands, and moving things in it leave ghosts.",
                   "ghost_area", makeCourtyardStill, 12),
        pan,
        movingCase("courtyard-orbit",
                   "An orbit gives every depth another motion, and objects move on top of it.",
                   "psnr", makeCourtyardOrbit, 12),
    };
}

std::vector<AtlasCase> allCases() {
    std::vector<AtlasCase> all;
    for (const auto& group : {edgeCases(), patternCases(), cameraCases(), shadingCases(),
                              surfaceCases(), startCases(), courtyardCases()}) {
        all.insert(all.end(), group.begin(), group.end());
    }
    return all;
}

}  // namespace

const std::vector<AtlasCase>& atlasCases() {
    static const std::vector<AtlasCase> cases = allCases();
    return cases;
}

const AtlasCase* findAtlasCase(const std::string& name) {
    for (const std::vector<AtlasCase>* suite : {&atlasCases(), &noiseCases()}) {
        const auto found = std::find_if(suite->begin(), suite->end(),
                                        [&](const AtlasCase& each) { return each.name == name; });
        if (found != suite->end()) {
            return &*found;
        }
    }
    return nullptr;
}

}  // namespace still
