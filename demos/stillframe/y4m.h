#pragma once
// YUV4MPEG2: uncompressed video that ffmpeg, mpv and encoders read from a pipe. Source: mjpegtools,
// yuv4mpeg(5). 4:4:4; since the format cannot say which matrix it uses, that is BT.601 in its
// limited range, as ffmpeg takes it.

#include <cstdio>
#include <string>

#include "rasterizer/image.h"

namespace still::command {

/// Writes to a stream that it does not own. Write errors stay in the stream (std::ferror).
class Y4mWriter {
  public:
    Y4mWriter(std::FILE* stream, int width, int height, int fps);
    void add(ImageView<const Rgb8> image);

  private:
    std::FILE* stream_;
    std::string planes_;  ///< of one picture: Y, Cb, Cr
};

}  // namespace still::command
