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

/// The error lists the names.
Result<Scene> builtinScene(const std::string& name);

}  // namespace still
