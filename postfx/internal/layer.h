#pragma once
// Surfaces that a pixel's window shows, and where they lie in depth as they go back through the
// frames. Scalar truth of the gather and of the upscaler.

#include <algorithm>
#include <cstddef>
#include <cstdlib>

#include "postfx/internal/ring.h"
#include "postfx/internal/rules.h"
#include "postfx/story.h"

namespace still::taa {

/// A surface on its way back through the frames.
struct Layer {
    int surface = 0, depth = 0;
    int step = 0;  ///< change of depth per frame into the past
    int tolerance = 0;
    Motion motion;

    int depthAt(int k) const { return std::clamp(depth + step * k, 0, 65535); }
    int toleranceAt(int k) const {
        return tolerance + (std::min(std::abs(step) * k, 32767) >> kStepShift);
    }
};

/// `expected`: the depth that it had a frame ago; `slope`: its own change of depth per pixel.
inline Layer layerOf(int surface, int depth, int expected, Motion motion, int slope) {
    return {surface, depth, heldStep(expected - depth), kDepthTolerance + kSlopeFactor * slope,
            motion};
}

inline TapLayer placeOf(const Layer& layer, int k, int surface, int depth) {
    const int difference = depth - layer.depthAt(k);
    const int tolerance = layer.toleranceAt(k);
    if (surface == layer.surface && std::abs(difference) <= tolerance) {
        return TapLayer::same;
    }
    return difference > tolerance ? TapLayer::nearer : TapLayer::farther;
}

/// By how much two motions part (1/256 pixel, larger axis).
inline int slideOf(Motion a, Motion b) {
    return std::max(std::abs(a.x_fx8 - b.x_fx8), std::abs(a.y_fx8 - b.y_fx8));
}

/// The farthest sample of the 3×3 window. Columns first; ties: middle before top before bottom,
/// middle before left before right.
ptrdiff_t farthestInWindow(const Job& job, int x, int y) noexcept;

/// Every channel of the window spans at most contrastBound().
bool lowContrast(const Job& job, int x, int y, int shift) noexcept;

}  // namespace still::taa
