#pragma once
// The upscaler's arithmetic beside rules.h, in integers. How the constants were found:
// postfx/README.md.

#include <algorithm>

#include "postfx/internal/rules.h"
#include "postfx/upscale.h"

namespace still::upscale {

/// A frame's pixels are larger than those for which rules.h was made, so that surfaces fall off
/// more from one to the next: taa::Job::centre_tolerance.
constexpr int kCentreTolerance = 144;

/// Frames that are followed at most where a window shows one surface with little contrast, and with
/// next to none.
constexpr int kCalmFrames = 8;
constexpr int kFlatFrames = 4;
/// … in which the farther of two surfaces is looked for.
constexpr int kFarFrames = 8;

/// Weight along an axis of a sample `e_fx8` output pixels from an output pixel's centre, 0 …
/// kAxisWeight: a box of one pixel, its sides softened to ramps over 0.2 … 0.8.
constexpr int axisKernel(int e_fx8) {
    const int distance = e_fx8 < 0 ? -e_fx8 : e_fx8;
    return std::clamp(((205 - distance) * 53 + 256) >> 9, 0, taa::kAxisWeight);
}

/// Of a sample; at most kSampleWeight.
constexpr int kSampleWeight = 128;
constexpr int narrowWeight(int ex_fx8, int ey_fx8) {
    return (axisKernel(ex_fx8) * axisKernel(ey_fx8)) >> 1;
}
/// Samples farther away count a little, for where there are no others: the nearest one of an old
/// frame by kFarWeight, this frame's four by tents as wide as the frame's pixels.
constexpr int kFarWeight = 1;
constexpr int tentWeight(int ex_frame_fx8, int ey_frame_fx8) {
    const auto side = [](int e) { return std::max(256 - (e < 0 ? -e : e), 0); };
    return (side(ex_frame_fx8) * side(ey_frame_fx8)) >> 11;
}
/// Places of samples from an output pixel's centre: 1/256 output pixel to 1/64, held where tilted
/// weights fit 16 bits.
constexpr int kFarthest = 100;
static_assert(kFarthest * taa::kMaxTilt < 32768);
constexpr int placeOf(int e_fx8) {
    return std::clamp(e_fx8 >> 2, -kFarthest, kFarthest);
}
/// All weights of a pixel, before and after the tilt.
constexpr int kMaxTotal = kMaxRing * (kSampleWeight + kFarWeight) * 3 / 2 + 4 * 160 * 2;
static_assert(kMaxTotal <= taa::kMaxTotal);

}  // namespace still::upscale
