#pragma once
// Tells what the gather did. `job` is the frame's once more; nothing is written through it.
// `source` says what the image shows at the pixel: PixelSource::first, mean or gathered.

#include "postfx/internal/ring.h"
#include "postfx/internal/story_parts.h"

namespace still::taa {

/// All but the jitter.
PixelStory tellPixel(const Job& job, PixelSource source, int x, int y);
/// A plane's colour.
StoryColour tellColour(const Job& job, StoryPlane plane, PixelSource source, int x, int y);
StoryLoss tellLoss(const Job& job, PixelSource source, int x, int y);

}  // namespace still::taa
