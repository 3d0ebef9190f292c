#pragma once
// The program: frames, their hashes, and the memory that they took.

#include "rasterizer/simd.h"

namespace spin {

constexpr int kFrames = 64;

/// Prints a line "frame …" for each frame and one "arena …". The arena is sealed before the first.
void run(still::SimdTarget simd, int threads);

}  // namespace spin
