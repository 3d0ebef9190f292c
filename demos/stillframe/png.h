#pragma once
// PNG files through libpng: RGB, 8 bits, marked as sRGB. The same pixels give the same bytes with
// the same libpng and zlib.

#include <cstdio>
#include <filesystem>
#include <string>

#include "demos/stillframe/output_file.h"
#include "rasterizer/image.h"

namespace still::command {

/// Writes a whole PNG to `stream` and flushes it; `name` is used in messages.
Outcome<void> writePng(std::FILE* stream, const std::string& name, ImageView<const Rgb8> image);

/// The same into memory.
Outcome<std::string> pngBytes(ImageView<const Rgb8> image);

/// The same to a file that appears only when it is complete.
Outcome<void> savePng(const std::filesystem::path& path, ImageView<const Rgb8> image,
                      Interruption& interruption);

}  // namespace still::command
