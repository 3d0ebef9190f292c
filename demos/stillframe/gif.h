#pragma once
// Animated GIF that loops for ever. Source: CompuServe, "Graphics Interchange Format, Version 89a",
// 1990; the loop extension is Netscape's.

#include <cstdint>
#include <cstdio>
#include <span>
#include <vector>

#include "rasterizer/image.h"

namespace still::command {

/// Writes to a stream that it does not own. Write errors stay in the stream (std::ferror).
class GifWriter {
  public:
    /// Sizes 1 … 65535; fps ≥ 1. Players show at most 50 pictures a second.
    GifWriter(std::FILE* stream, int width, int height, int fps);
    /// Appends a picture of the given size, with a palette of its own.
    void add(ImageView<const Rgb8> image);
    /// Ends the file.
    void finish();

  private:
    void put(std::span<const uint8_t> bytes);

    std::FILE* stream_;
    int width_, height_, fps_;
    int64_t frames_ = 0;
};

/// GIF's variable-length LZW over palette indices of 8 bits: the code stream without sub-blocks.
std::vector<uint8_t> gifLzw(std::span<const uint8_t> indices);

}  // namespace still::command
