#pragma once
// Pixels of a picture as squares, with the places of samples in the middle one.

#include <optional>
#include <span>

#include "demos/inspect/look.h"
#include "engine/jitter.h"
#include "rasterizer/image.h"

namespace still::inspect {

struct LensPixel {
    int x = 0, y = 0;
};

/// What is magnified: a pane's picture.
struct LensSource {
    ImageView<const Rgb8> picture;
    LensPixel middle;  ///< may lie outside the picture; so does what is around it
    std::span<const SampleOffset> pattern{};  ///< of the middle pixel …
    SampleOffset now{};                       ///< … with the one that this frame took
    std::optional<LensPixel> picked{};
};

/// Pixels of a picture along a side of the lens: odd, so that there is one in the middle.
int lensPixels(int factor, int window_width, int window_height);

/// Draws the lenses of one or two panes side by side around the magnifier's place, moved as far as
/// it takes to stay in the window, as far as it is large enough.
void drawMagnifier(const Magnifier& magnifier, std::span<const LensSource> panes,
                   ImageView<Rgb8> out);

}  // namespace still::inspect
