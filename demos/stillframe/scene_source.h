#pragma once
// Scenes as the command line names them.

#include <filesystem>
#include <string>
#include <vector>

#include "demos/stillframe/options.h"
#include "engine/load.h"
#include "engine/scene.h"

namespace still::command {

/// Opens FILE.obj, FILE.json, builtin:NAME or -, which is standard input with the text of either,
/// and lights it as the scene file `lights` says, if there is a name. Its warnings are the caller's
/// to print.
Outcome<Scene> openScene(const std::string& name, const LoadOptions& options = {},
                         const std::string& lights = {});

/// Refuses frames that need more memory than is allowed, `loops` FrameLoops of them at once.
Outcome<void> checkFrameMemory(const std::string& name, const Scene& scene,
                               const FrameSettings& settings, const Limits& limits, int loops = 1);

/// What {model} stands for: "courtyard" of builtin:courtyard, "a" of dir/a.obj, "stdin" of -.
std::string modelName(const std::string& scene);

/// "builtin:courtyard" and "models/courtyard.obj" are both called courtyard; letters, digits and
/// "-_." only, for names of files and in tables.
std::string plainName(const std::string& scene);

/// Each on a line of standard error, unless quiet is asked for.
void printWarnings(const std::vector<std::string>& warnings, bool quiet = false);

}  // namespace still::command
