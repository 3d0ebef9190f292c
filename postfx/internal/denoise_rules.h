#pragma once
// The denoiser's constants and the arithmetic that its kernels share. How the constants were found:
// postfx/README.md. Floats are IEEE, in written order, so that lanes give the same numbers.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "postfx/internal/denoise_job.h"
#include "rasterizer/fixed.h"

namespace still::denoising {

/// A sample of the past belongs to the surface when its logDepth16 differs by at most this much
/// from the expected one, plus this multiple of the surface's step to its neighbour …
constexpr int kDepthTolerance = 48;
constexpr int kSlopeFactor = 2;
/// … and the cosine between the normals is at least this.
constexpr float kPastCosine = 0.9f;
/// Weight that the 2×2 samples of the past must have together, of 65536; else 3×3 are looked at.
constexpr int kEnoughPast = 6554;

/// Samples that a mean is worth at most: at rest, and where it was resampled.
constexpr int kLongest = 255;
constexpr int kLongestMoving = 32;
/// Before so many samples variance comes from the surroundings.
constexpr int kShort = 4;

/// Light may have drifted by this share of itself over the frames that TAA takes.
constexpr float kAgeDrift = 0.06f;

/// Of a pixel: light is Rec. 709 linear.
inline float luminance(float red, float green, float blue) {
    return 0.2126f * red + 0.7152f * green + 0.0722f * blue;
}

/// 1 at 0, 0 from 1 on.
inline float fallOff(float x) {
    const float rest = std::max(0.0f, 1.0f - x);
    return rest * rest;
}

/// Passes of the filter; pass k takes every 2^k-th pixel.
constexpr int kPasses = 5;
/// Of the filter's 5 × 5 window, each axis, from the centre.
constexpr float kWindow[3] = {0.375f, 0.25f, 0.0625f};
/// Luminances may differ by so many standard deviations.
constexpr float kSigmas = 4.0f;
/// Squared distance of normals at which nothing is taken.
constexpr float kNormalReach = 0.12f;
/// Distance from the pixel's plane at which nothing is taken, relative to the depth.
constexpr float kPlaneReach = 0.02f;

}  // namespace still::denoising
