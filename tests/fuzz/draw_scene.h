#pragma once
// What a loaded scene promises: its draw lists keep the preconditions, and it can be drawn.

#include <cstdint>

#include "engine/scene.h"

namespace still::fuzz {

/// Checks the draw lists of a few frames; `draw`: draws small ones of scenes that are not large,
/// too.
void tryScene(const Scene& scene, bool draw);

}  // namespace still::fuzz
