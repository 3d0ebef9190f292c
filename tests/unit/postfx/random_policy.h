#pragma once
// Policies of the laboratory that nobody would publish.

#include "postfx/policy.h"
#include "random_frames.h"

namespace random_frames {

/// Any combination of everything, with thresholds that random frames sometimes pass.
still::TaaPolicy randomPolicy(Random& random);

}  // namespace random_frames
