#pragma once
// One pixel of the gather, step by step. Scalar truth.

#include <algorithm>
#include <cstdlib>

#include "postfx/internal/layer.h"
#include "postfx/internal/owner.h"
#include "postfx/internal/rules.h"
#include "postfx/story.h"

namespace still::taa {

/// What the window shows: its owner, and the farthest sample when that lies behind the owner.
struct Window {
    Layer owner, far;
    uint32_t normal = 0;
    bool moved = false;
    bool layered = false;   ///< two surfaces, one behind the other
    bool apart = false;     ///< … that move differently …
    bool flat = false;      ///< one surface with next to no contrast
    int frames = kMaxRing;  ///< to follow: fewer where there is one surface with little contrast
    int lit_frames = 256;   ///< in which it was lit as it is now, this one included
    int slide = 0;          ///< … by this much per frame (1/256 pixel, larger axis)
};

/// One sample near the pixel's centre. Written whole: zeros would cost more than they are worth.
struct Tap {
    int weight;
    int ex, ey;   ///< its place, 1/64 pixel
    bool behind;  ///< shows what is behind the owner
    int rgb[3];
};

struct Taps {
    Tap tap[4 * kMaxRing];
    int count = 0;
    int fresh = 0;       ///< of them of this frame: the first ones
    int old_weight = 0;  ///< of the frames before this one
    Moments moments;
};

/// One sample that has a weight at the pixel, for those who ask.
struct Sighting {
    int age = 0;
    int x = 0, y = 0;  ///< may lie outside the picture
    int weight = 0;
    int ex = 0, ey = 0;  ///< its place, 1/64 pixel
    TapLayer layer = TapLayer::same;
    Verdict verdict = Verdict::taken;
};

/// All that a layer's way has met.
struct Sightings {
    Sighting at[4 * kMaxRing];
    int count = 0;
    /// The way ended before frame `end_age` of `frames`, because of `end`.
    int frames = 0, end_age = 0;
    Verdict end = Verdict::taken;
};
struct PixelSightings {
    Sightings own, far;
};

struct GatherSteps {
    Owner seen;  ///< or inferred
    Window window;
    Taps own, far;
    bool separate = false;  ///< taps behind have the colour `behind`
    int behind[3] = {};
    int spatial_q8 = 0;  ///< share of the spatial filter in the result
    int rgb[3] = {};
};

/// Collects the pixel's taps. Reads and does not write, so it may be asked again; every slot's
/// record is complete. What was met is written to `sightings` unless that is null.
void gatherTaps(const Job& job, int x, int y, GatherSteps& steps,
                PixelSightings* sightings = nullptr) noexcept;

/// Then makes its colour.
void gatherColour(const Job& job, int x, int y, GatherSteps& steps) noexcept;

/// The samples' plane at the pixel's centre. `behind`, unless null, replaces the colours of taps
/// behind. False when they weigh next to nothing.
bool fit(const Taps& taps, const int* behind, int rgb[3]) noexcept;

}  // namespace still::taa
