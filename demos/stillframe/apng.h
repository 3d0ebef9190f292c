#pragma once
// Animated PNG that loops for ever: exact colours, and alpha where pictures have it. A PNG with
// chunks that say how its frames follow each other; programs that do not know them show the first.
// Source: W3C, "Portable Network Graphics (PNG) Specification (Third Edition)", chapter 4.9 and
// 11.3.6 (acTL, fcTL, fdAT).

#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

#include "demos/stillframe/outcome.h"
#include "demos/stillframe/picture.h"

namespace still::command {

/// Writes to a stream that it does not own. Write errors stay in the stream (std::ferror).
class ApngWriter {
  public:
    /// Exactly `frames` pictures will be added. fps 1 … 65535.
    ApngWriter(std::FILE* stream, int frames, int fps);
    /// Pictures have equal sizes and all or none have alpha. Of all but the first, the rectangle is
    /// written in which they differ from the one before.
    Outcome<void> add(const Picture& picture);
    /// Ends the file.
    void finish();

  private:
    void putChunk(std::string_view type, std::string_view bytes);
    void putFrameControl(int x, int y, const Picture& part);

    std::FILE* stream_;
    int frames_, fps_;
    uint32_t sequence_ = 0;  ///< counts fcTL and fdAT chunks together
    Image<Rgb8> opaque_before_;
    Image<Rgba8> matted_before_;
};

}  // namespace still::command
