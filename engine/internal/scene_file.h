#pragma once
// The JSON scene file, format in engine/README.md.

#include <filesystem>

#include "engine/load.h"
#include "engine/result.h"
#include "engine/scene.h"

namespace still {

/// Reads NAME.json. A scene without camera keeps the default one and has automatic_camera set.
Result<Scene> loadSceneFile(const std::filesystem::path& file, const LoadOptions& options);

/// The same from text; `name` stands for it in messages, and what it names is looked for beside
/// that.
Result<Scene> parseSceneFile(const std::string& text, const std::filesystem::path& name,
                             const LoadOptions& options = {});

}  // namespace still
