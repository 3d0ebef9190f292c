#pragma once
// PNG files through libpng: RGB or RGBA, 8 bits, marked as sRGB. The same pixels give the same
// bytes with the same libpng and zlib.

#include <cstdio>
#include <filesystem>
#include <string>

#include "demos/stillframe/output_file.h"
#include "demos/stillframe/picture.h"

namespace still::command {

/// Writes a whole PNG to `stream` and flushes it; `name` is used in messages.
Outcome<void> writePng(std::FILE* stream, const std::string& name, const Picture& image);

/// The same into memory.
Outcome<std::string> pngBytes(const Picture& image);

/// The same to a file that appears only when it is complete.
Outcome<void> savePng(const std::filesystem::path& path, const Picture& image,
                      Interruption& interruption);

}  // namespace still::command
