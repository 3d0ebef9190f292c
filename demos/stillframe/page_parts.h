#pragma once
// What HTML pages without outside parts are made of.

#include <string>

namespace still::command {

/// A PNG's bytes as the address of an image.
std::string pngDataUri(const std::string& png);

/// JSON for a script element, which must not contain its own end.
std::string scriptText(const std::string& json);

}  // namespace still::command
