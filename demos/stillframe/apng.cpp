#include "demos/stillframe/apng.h"

#include <zlib.h>

#include <algorithm>
#include <vector>

#include "demos/stillframe/png.h"

namespace still::command {
namespace {

constexpr size_t kSignature = 8;
constexpr size_t kChunkFrame = 12;  // length, type, checksum

/// Big-endian.
std::string word(uint32_t value) {
    return {char(value >> 24), char(value >> 16), char(value >> 8), char(value)};
}
std::string halfWord(int value) {
    return {char(value >> 8), char(value)};
}

struct Chunk {
    std::string_view type, bytes;
};

/// The chunks of a PNG that libpng has just written.
std::vector<Chunk> chunksOf(std::string_view png) {
    std::vector<Chunk> chunks;
    for (size_t at = kSignature; at + kChunkFrame <= png.size();) {
        uint32_t size = 0;
        for (size_t i = 0; i < 4; ++i) {
            size = size << 8 | uint8_t(png[at + i]);
        }
        chunks.push_back({png.substr(at + 4, 4), png.substr(at + 8, size)});
        at += kChunkFrame + size;
    }
    return chunks;
}

struct Rectangle {
    int x0, y0, x1, y1;  ///< first, and one after the last
};

/// Where the two differ; the first pixel when they are equal, since a frame cannot be empty.
template <class Pixel>
Rectangle changedPart(ImageView<const Pixel> now, const Image<Pixel>& before) {
    Rectangle part{now.width, now.height, 0, 0};
    for (int y = 0; y < now.height; ++y) {
        for (int x = 0; x < now.width; ++x) {
            if (now.at(x, y) != before.at(x, y)) {
                part = {std::min(part.x0, x), std::min(part.y0, y), std::max(part.x1, x + 1),
                        y + 1};
            }
        }
    }
    return part.x1 == 0 ? Rectangle{0, 0, 1, 1} : part;
}

template <class Pixel>
ImageView<const Pixel> cut(ImageView<const Pixel> view, const Rectangle& part) {
    return {view.row(part.y0) + part.x0, part.x1 - part.x0, part.y1 - part.y0, view.stride};
}

template <class Pixel>
void copy(ImageView<const Pixel> from, Image<Pixel>& to) {
    to.resize(from.width, from.height);
    for (int y = 0; y < from.height; ++y) {
        std::copy_n(from.row(y), from.width, to.view().row(y));
    }
}

}  // namespace

ApngWriter::ApngWriter(std::FILE* stream, int frames, int fps)
    : stream_(stream), frames_(frames), fps_(fps) {}

Outcome<void> ApngWriter::add(const Picture& picture) {
    const bool first = sequence_ == 0;
    Rectangle part{0, 0, picture.width(), picture.height()};
    if (!first) {
        part = picture.hasAlpha() ? changedPart(picture.matted, matted_before_)
                                  : changedPart(picture.opaque, opaque_before_);
    }
    const Picture shown = picture.hasAlpha() ? Picture(cut(picture.matted, part))
                                             : Picture(cut(picture.opaque, part));
    const Outcome<std::string> png = pngBytes(shown);
    if (!png) {
        return tl::make_unexpected(png.error());
    }
    if (first) {
        std::fwrite(png->data(), 1, kSignature, stream_);
    } else {
        putFrameControl(part.x0, part.y0, shown);
    }
    for (const Chunk& chunk : chunksOf(*png)) {
        if (chunk.type == "IDAT" && !first) {
            putChunk("fdAT", word(sequence_++) + std::string(chunk.bytes));
        } else if (chunk.type == "IDAT" && sequence_ == 0) {
            putFrameControl(0, 0, shown);
            putChunk("IDAT", chunk.bytes);
        } else if (first && chunk.type != "IEND") {
            putChunk(chunk.type, chunk.bytes);
        }
        if (first && chunk.type == "IHDR") {
            putChunk("acTL", word(uint32_t(frames_)) + word(0));
        }
    }
    if (picture.hasAlpha()) {
        copy(picture.matted, matted_before_);
    } else {
        copy(picture.opaque, opaque_before_);
    }
    return {};
}

void ApngWriter::putFrameControl(int x, int y, const Picture& part) {
    const std::string place = word(uint32_t(part.width())) + word(uint32_t(part.height())) +
                              word(uint32_t(x)) + word(uint32_t(y));
    const std::string stays_and_replaces(2, '\0');
    putChunk("fcTL", word(sequence_++) + place + halfWord(1) + halfWord(fps_) + stays_and_replaces);
}

void ApngWriter::finish() {
    putChunk("IEND", {});
}

void ApngWriter::putChunk(std::string_view type, std::string_view bytes) {
    std::string checked(type);
    checked += bytes;
    const auto* data = reinterpret_cast<const Bytef*>(checked.data());
    const std::string chunk = word(uint32_t(bytes.size())) + checked +
                              word(uint32_t(crc32(0, data, uInt(checked.size()))));
    std::fwrite(chunk.data(), 1, chunk.size(), stream_);
}

}  // namespace still::command
