#pragma once
// Constants that the scalar and the SIMD shading kernels share.

#include <cstdint>

namespace still::internal {

/// log2(1 + t) for t in [0, 1): t·(c1 + t·(c2 + t·c3)), exact at both ends, error < 0.001, fitted
/// by least squares; plenty for a mip level in 1/256.
constexpr float kLog2C1 = 1.42286530f;
constexpr float kLog2C2 = -0.58208536f;
constexpr float kLog2C3 = 0.15922006f;

/// Guards divisions and logarithms of lanes whose value is not used or degenerate.
constexpr float kTiny = 1e-30f;

constexpr float kTexelToLinear = 1.0f / (1023.0f * 1023.0f);
constexpr float kTexelToNormal = 2.0f / 1023.0f;
constexpr uint32_t kTexelMask = 1023;

/// Depth layers of a height map between top and bottom, and the flattest ray that is followed as it
/// is: flatter ones would shear the picture by more than 8 times its height (offset limiting, Welsh
/// 2004).
constexpr int kParallaxSteps = 16;
constexpr float kParallaxStep = 1.0f / kParallaxSteps;
constexpr float kParallaxMinCosine = 0.125f;

constexpr float kColourScale = 4096.0f;  ///< fx12
constexpr float kColourMax = 15.9998f;   ///< rounds to 65535 at most
constexpr float kSnormScale = 32767.0f;
constexpr float kMotionScale = 256.0f;  ///< fx8
constexpr float kMotionMax_px = 127.99f;

/// Integer hash of pixel and surface (multiplications by odd constants, xor-shifts), the start of
/// the stochastic draw; each further sample adds the golden ratio, so that the draws of one pixel
/// are evenly spread over its samples.
constexpr uint32_t kHashX = 0x9E3779B1u, kHashY = 0x85EBCA77u, kHashSurface = 0xC2B2AE3Du;
constexpr uint32_t kHashMix = 0x2C1B3C6Du;
constexpr uint32_t kGoldenRatio = 0x9E3779B9u;

}  // namespace still::internal
