#pragma once
// The sources of the peer's shaders, specialised by what a draw needs.

#include "tests/bench/peer/gl.h"

namespace still::peer {

// What a program of the G-buffer pass can do.
constexpr uint32_t kColourTexture = 1, kNormalMap = 2, kAlphaTest = 4, kAlphaTexture = 8;
constexpr uint32_t kHighlight = 16, kDepthOnly = 32;
/// The number of point lights stands above the other bits.
constexpr int kPointLightShift = 8;

/// Attributes: position, normal, texture coordinates, tangent.
ProgramSource gbufferProgram(uint32_t features);

/// The resolve: one triangle over the whole target.
ProgramSource temporalProgram();

/// sRGB encoding of linear light.
ProgramSource outputProgram();

}  // namespace still::peer
