#pragma once
// Files as bytes, and their names in messages.

#include <filesystem>
#include <string>

#include "engine/result.h"

namespace still {

/// The whole file; an Error "NAME: …" when it is missing, a folder, or cannot be read.
Result<std::string> readFile(const std::filesystem::path& file);

/// The path as it is shown in messages: control characters become '?', so that it is one line.
std::string shownPath(const std::filesystem::path& file);

}  // namespace still
