#pragma once
// Scenes made by code: nothing on disk is needed. "courtyard" is the one people see first; the
// others are small and made for tests.

#include <string>
#include <vector>

#include "engine/result.h"
#include "engine/scene.h"

namespace still {

/// Names that builtinScene() takes, courtyard first.
std::vector<std::string> builtinSceneNames();

/// Also takes "atlas-NAME" for every case of demos/scenes/atlas.h, and the names of
/// demos/scenes/bench_scenes.h. The error lists the names, those of the atlas only where one of
/// them was asked for.
Result<Scene> builtinScene(const std::string& name);

}  // namespace still
