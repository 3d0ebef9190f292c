#pragma once
// Image files in, 8-bit pixels out.

#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>
#include <string>

#include "engine/result.h"
#include "engine/texture.h"
#include "rasterizer/image.h"

namespace still {

/// Larger images are refused before they are decoded.
constexpr int kMaxImageSize = 16384;
constexpr int64_t kMaxImagePixels = int64_t{256} << 20;

/// Reads PNG, JPG, TGA, BMP, GIF (first frame), PSD, PIC, PNM or Radiance HDR. Samples of 16 bits
/// lose their low byte; HDR is clamped to 0 … 1 and encoded to sRGB. Images without alpha get 255.
/// The Error names the file and the decoder's reason; truncated files are refused.
Result<Image<Rgba8>> loadImage(const std::filesystem::path& file,
                               uint64_t max_memory_bytes = std::numeric_limits<uint64_t>::max());

/// The same from memory; `name` is used in messages.
Result<Image<Rgba8>> decodeImage(std::span<const uint8_t> bytes, const std::string& name);

/// An Error when an image of the size that stands in `bytes` cannot be decoded and made a texture
/// with so much memory. What is no image is for decodeImage() to say.
Result<void> checkImageMemory(std::span<const uint8_t> bytes, const std::string& name,
                              uint64_t max_memory_bytes);

}  // namespace still
