#pragma once
// How far the pattern of samples is shifted while the camera moves.

#include <cstdint>

#include "engine/jitter.h"
#include "engine/timeline.h"

namespace still {

/// To −128 … 127, modulo one pixel of 256.
int withinPixel(int64_t offset_fx8);

/// The gather finds a surface's old samples where the motion has carried them: the pattern stays
/// even on the surface only if the samples move along with it. What holds for all surfaces under a
/// turning camera holds for the far ones under any. So this is by how much what lies far straight
/// ahead has moved over the picture since the camera set off, 1/256 pixel modulo 1 pixel; `drift`
/// is that of the frame before. Zero for a camera at rest, which has the plain pattern.
SampleOffset driftAfter(SampleOffset drift, const CameraState& camera, const CameraState& before,
                        int width, int height);

}  // namespace still
