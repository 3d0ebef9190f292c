#pragma once
// Scenes as the command line names them.

#include <string>
#include <vector>

#include "demos/stillframe/options.h"
#include "engine/scene.h"

namespace still::command {

/// Opens FILE.obj, FILE.json or builtin:NAME. Its warnings are the caller's to print.
Outcome<Scene> openScene(const std::string& name);

/// Each on a line of standard error.
void printWarnings(const std::vector<std::string>& warnings);

/// The loader frames for 16:9 and leaves other shapes to us.
void frameForAspect(Scene& scene, Size size);

}  // namespace still::command
