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
constexpr float kSlopeFactor = 8192.0f;
/// … and the cosine between the normals is at least this.
constexpr float kPastCosine = 0.9f;
/// Weight that the 2×2 samples of the past must have together, of 65536; else 3×3 are looked at.
constexpr int kEnoughPast = 6554;

/// Samples that a mean is worth at most: at rest, and where it was resampled.
constexpr int kLongest = 255;
constexpr int kLongestMoving = 32;
/// The first so many frames are still noisy: TAA forgets its sums of them as soon as they are over,
/// and all but so many of them.
constexpr int kYoungFrames = 12;
constexpr int kYoungKept = 7;
/// A past that a pixel at rest has from its neighbours is worth so many samples at most.
constexpr float kBorrowed = 4.0f;
/// Before so many samples variance comes from the surroundings.
constexpr int kShort = 4;
/// … of so many pixels on each side whose logDepth16 differs by at most this.
constexpr int kAround = 3;
constexpr int kAroundTolerance = 6 * kDepthTolerance;
/// A pixel that is apart from them by so much has at least this times its square as variance: else
/// nobody would be like it, and it would stay as it is.
constexpr float kOutlier = 4.0f;

/// Light may have drifted by this share of itself over the frames that TAA takes.
constexpr float kAgeDrift = 0.06f;
/// What is unsure of a change counts for so much of that.
constexpr float kDriftPart = 0.25f;

/// Of a pixel: light is Rec. 709 linear.
inline float luminance(float red, float green, float blue) {
    return 0.2126f * red + 0.7152f * green + 0.0722f * blue;
}

/// Light ≥ 0 as planes keep it, rounded half up.
inline uint16_t toPlane(float light) {
    return uint16_t(int(std::min(light, 65535.0f) + 0.5f));
}

/// Of logDepth16, on a surface whose reversed depth grows by these steps per pixel.
inline int pastTolerance(float depth, float step_x, float step_y) {
    const float steep = std::max(std::abs(step_x), std::abs(step_y)) / (depth + 1e-12f);
    return kDepthTolerance + int(std::min(steep, 1.0f) * kSlopeFactor);
}

/// 1 at 0, 0 from 1 on.
inline float fallOff(float x) {
    const float rest = std::max(0.0f, 1.0f - x);
    return rest * rest;
}

/// Variance that no one sees: less than half a step of the planes, or than 1/1024 of the light.
inline bool quiet(float variance, float luminance) {
    const float span = luminance * (1.0f / 1024);
    return variance <= 0.25f + span * span;
}

/// Passes of the filter; pass k takes every 2^k-th pixel.
constexpr int kPasses = 5;
/// The last one is only for tiles with pixels that have fewer samples: others are clean without it.
constexpr int kFewSamples = 5;
/// Of the filter's 3 × 3 window, each axis; of its centre.
constexpr float kWindow[3] = {0.25f, 0.5f, 0.25f};
constexpr float kCentre = 0.25f;
/// The same of the window over which variance is averaged.
constexpr float kSmooth[3] = {0.25f, 0.5f, 0.25f};
/// Luminances may differ by so many standard deviations, direct and indirect light: shadows of
/// lamps have edges.
constexpr float kSigmas[kParts] = {8.0f, 11.0f};
/// … and by so much more, in units of the planes.
constexpr float kLeastSpan = 1e-3f;
/// Squared distance of normals at which nothing is taken.
constexpr float kNormalReach = 0.3f;
/// Distance from the pixel's plane at which nothing is taken, relative to the depth.
constexpr float kPlaneReach = 0.01f;
/// … or to the surface's slope.
constexpr float kSlopeReach = 0.25f;

/// 1 / distance from the plane through a pixel at which nothing is taken. Steps are those of
/// `stride` pixels.
inline float planeScale(float depth, float step_x, float step_y, float stride) {
    return 1.0f / (depth * (kPlaneReach * stride) +
                   (std::abs(step_x) + std::abs(step_y)) * kSlopeReach + 1e-12f);
}

/// Whether a set of parts holds one: a bit for each.
constexpr bool filters(int parts, int part) {
    return (parts >> part & 1) != 0;
}

/// By what light changed at a pixel.
inline BlockChange changeAt(const Job& job, int part, int x, int y) {
    if (job.change[part] == nullptr) {
        return {};
    }
    const Motion motion = job.motion[y * job.stride + x];
    const int px = std::clamp((x * 256 + motion.x_fx8 + 128) >> 8, 0, job.width - 1);
    const int py = std::clamp((y * 256 + motion.y_fx8 + 128) >> 8, 0, job.height - 1);
    return job.change[part][(py / kLightBlock) * job.blocks_x + px / kLightBlock];
}

}  // namespace still::denoising
