#pragma once
// Picture files in, output pixels out: for whoever compares pictures.

#include <filesystem>

#include "engine/result.h"
#include "rasterizer/image.h"

namespace still {

/// Reads PNG, JPG, TGA, BMP and the other formats of textures; alpha is dropped, not blended. The
/// Error names the file.
Result<Image<Rgb8>> readImageFile(const std::filesystem::path& file);

}  // namespace still
