#pragma once
// Lights of scene files. Keys, units and limits as in engine/README.md.

#include "engine/internal/json.h"
#include "engine/scene.h"

namespace still {

/// Daylight from the right, above and in front, for files that say nothing: a white surface that
/// faces the sun is 0.25 + 0.75 = 1.
SceneLights defaultLights();

/// The value of `lights`. What is not there is dark.
SceneLights readLights(const JsonCursor& cursor);
/// The value of `light`: one sun instead of the default one.
SceneLights readSingleLight(const JsonCursor& cursor);

}  // namespace still
