#pragma once
// A picked pixel's story in words, and as a plot.

#include <optional>
#include <string>
#include <vector>

#include "demos/inspect/look.h"
#include "postfx/story.h"
#include "rasterizer/image.h"

namespace still::inspect {

/// What is known about a picked pixel of the frame that is shown.
struct PickedStory {
    PickedPixel pixel{};
    Mode mode{};
    Rgb8 output{};          ///< as it is shown
    std::string surface{};  ///< "12, object tree"; empty: background
    int jitter_x_fx8 = 0, jitter_y_fx8 = 0;
    int samples = 0;                  ///< of ssaa:N: so far
    std::optional<PixelStory> taa{};  ///< with a temporal mode
};

/// A line of the panel.
struct StoryLine {
    bool heading = false;
    std::string text;
    std::optional<Rgb8> swatch{};  ///< the colour that it is about
};

/// Chapter by chapter: pixel, sample, surface, past, rejection, clip, blend, output.
std::vector<StoryLine> storyLines(const PickedStory& story);

/// The neighbourhood's box in YCoCg, from two sides: Co across and Y up to the left, Cg across and
/// Y up to the right. Small dots are this frame's 3 × 3 samples, or the taps of the gather (a cross
/// where one was rejected); a ring is history, the large dot what became of it, the square the
/// result. Each in its own colour. `side` pixels high and twice as wide; 32 … 4096.
Image<Rgb8> storyPlot(const PickedStory& story, int side);

/// A working colour of the story as it looks: linear fx12, or with Tone::reinhard c / (1 + max).
Rgb8 shownColour(const StoryColour& colour, Tone tone);

}  // namespace still::inspect
