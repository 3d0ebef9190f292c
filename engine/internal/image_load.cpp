#include "engine/internal/image_load.h"

#include <algorithm>
#include <array>
#include <climits>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <string_view>
#include <vector>

#include "engine/det_math.h"
#include "engine/internal/image_guard.h"
#include "engine/internal/obj_text.h"
#include "engine/memory_need.h"

namespace {

/// What the decoder may ask for at once on this thread. Files can make it ask for gigabytes that no
/// image of their size has use for: by the length of a chunk, or by what a few bytes inflate to.
struct Allowance {
    size_t block_bytes = 0;
    bool exceeded = false;
};
thread_local Allowance allowance;

bool permitsBlock(size_t bytes) {
    const bool permitted = bytes <= allowance.block_bytes;
    allowance.exceeded |= !permitted;
    return permitted;
}
void* allocateForDecoder(size_t bytes) {
    return permitsBlock(bytes) ? std::calloc(1, bytes) : nullptr;
}
void* reallocateForDecoder(void* block, size_t bytes) {
    return permitsBlock(bytes) ? std::realloc(block, bytes) : nullptr;
}

/// memcpy, but copying nothing to nowhere is permitted: the decoder does so when the first IDAT of
/// a PNG is empty.
void copyForDecoder(void* to, const void* from, size_t bytes) {
    if (bytes > 0) {
        std::memcpy(to, from, bytes);
    }
}

}  // namespace

// Scalar code, and memory that is zero where a corrupt file makes the decoder read before it
// writes: what a file decodes to must depend on nothing else.
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_STDIO
#define STBI_NO_SIMD
#define STBI_MALLOC(size) allocateForDecoder(size)
#define STBI_REALLOC(pointer, size) reallocateForDecoder(pointer, size)
#define STBI_FREE(pointer) std::free(pointer)
#define STBI_MAX_DIMENSIONS 16384
#define memcpy(to, from, bytes) copyForDecoder(to, from, bytes)
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#include <stb/stb_image.h>
#undef memcpy
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace still {

static_assert(kMaxImageSize == STBI_MAX_DIMENSIONS);

namespace {

/// Feeds the decoder and notices when it asks for more than there is: for most formats it takes
/// missing bytes for zeros and reports success.
class ByteSource {
  public:
    /// Behind the end there is `padding` without end, or if that is 0 nothing.
    explicit ByteSource(std::span<const uint8_t> bytes, uint8_t padding = 0)
        : bytes_(bytes), padding_(padding) {}
    bool overrun() const { return overrun_; }

    static int read(void* user, char* data, int size) {
        ByteSource& source = *static_cast<ByteSource*>(user);
        const size_t left = source.bytes_.size() - source.position_;
        const size_t taken = std::min(left, size_t(std::max(size, 0)));
        // The decoder fills its buffer 128 bytes at a time whatever it needs; only then is a short
        // answer no sign of a truncated file, as long as it is not empty.
        constexpr int kBufferBytes = 128;
        source.overrun_ |= taken == 0 || (size != kBufferBytes && taken < size_t(size));
        std::memcpy(data, source.bytes_.data() + source.position_, taken);
        source.position_ += taken;
        if (taken == 0 && source.padding_ != 0) {
            std::memset(data, source.padding_, size_t(size));
            return size;
        }
        return int(taken);
    }
    static void skip(void* user, int count) {
        ByteSource& source = *static_cast<ByteSource*>(user);
        const int64_t wanted = int64_t(source.position_) + count;
        source.position_ = size_t(std::clamp<int64_t>(wanted, 0, int64_t(source.bytes_.size())));
    }
    static int atEnd(void* user) {
        const ByteSource& source = *static_cast<ByteSource*>(user);
        return source.position_ == source.bytes_.size();
    }
    static constexpr stbi_io_callbacks callbacks() { return {read, skip, atEnd}; }

  private:
    std::span<const uint8_t> bytes_;
    uint8_t padding_;
    size_t position_ = 0;
    bool overrun_ = false;
};

struct FreePixels {
    void operator()(void* pixels) const { stbi_image_free(pixels); }
};

tl::unexpected<Error> refuse(const std::string& name, const std::string& why) {
    return fail(name + ": not a readable image: " + why);
}

/// Of an image, or of what is not known yet to be one. The decoder doubles its buffers, and keeps
/// 16 bytes of a pixel at most, in whole blocks of a JPEG.
void setAllowance(size_t file_bytes, int64_t width, int64_t height) {
    constexpr size_t kBlock = 64, kPixelBytes = 32, kSmall = size_t{1} << 20;
    allowance = {.block_bytes = kSmall + 4 * file_bytes +
                                kPixelBytes * (size_t(width) + kBlock) * (size_t(height) + kBlock)};
}

tl::unexpected<Error> refuseAsDecoder(const std::string& name) {
    if (allowance.exceeded) {
        return refuse(name, "asks for more memory than an image of its size needs");
    }
    const char* reason = stbi_failure_reason();
    if (reason != nullptr && std::string_view(reason) == "outofmem") {
        throw std::bad_alloc();  // says nothing about the file
    }
    return refuse(name, reason != nullptr ? reason : "unknown reason");
}

/// Linear light up to which the sRGB code is at most the index: decoded (code + 0.5) / 255.
const std::array<double, 255>& srgbBorders() {
    static const std::array<double, 255> borders = [] {
        std::array<double, 255> b{};
        for (int c = 0; c < 255; ++c) {
            const double x = (c + 0.5) / 255.0;
            b[size_t(c)] = x <= 0.04045 ? x / 12.92 : det::pow((x + 0.055) / 1.055, 2.4);
        }
        return b;
    }();
    return borders;
}

uint8_t encodeSrgb(float linear) {
    if (!(linear > 0.0f)) {
        return 0;
    }
    const std::array<double, 255>& borders = srgbBorders();
    return uint8_t(std::upper_bound(borders.begin(), borders.end(), double(linear)) -
                   borders.begin());
}

Result<Image<Rgba8>> decodeHdr(std::span<const uint8_t> bytes, const std::string& name) {
    // Given zeros for missing bytes, the decoder would wait for ever for a run that is not empty.
    ByteSource source(bytes, 1);
    const stbi_io_callbacks io = ByteSource::callbacks();
    int width = 0, height = 0, channels = 0;
    const std::unique_ptr<float, FreePixels> pixels(
        stbi_loadf_from_callbacks(&io, &source, &width, &height, &channels, 3));
    if (!pixels) {
        return refuseAsDecoder(name);
    }
    if (source.overrun()) {
        return refuse(name, "truncated");
    }
    Image<Rgba8> image(width, height);
    const float* p = pixels.get();
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x, p += 3) {
            image.view().row(y)[x] = {encodeSrgb(p[0]), encodeSrgb(p[1]), encodeSrgb(p[2]), 255};
        }
    }
    return image;
}

/// Grey, grey + alpha, RGB or RGBA.
template <int kChannels>
void expand(const stbi_uc* p, ImageView<Rgba8> image) {
    constexpr int kGreen = kChannels >= 3 ? 1 : 0, kBlue = kChannels >= 3 ? 2 : 0;
    constexpr bool kAlpha = kChannels == 2 || kChannels == 4;
    for (int y = 0; y < image.height; ++y) {
        Rgba8* row = image.row(y);
        for (int x = 0; x < image.width; ++x, p += kChannels) {
            row[x] = {p[0], p[kGreen], p[kBlue], kAlpha ? p[kChannels - 1] : stbi_uc{255}};
        }
    }
}

Result<Image<Rgba8>> decodeBytes(std::span<const uint8_t> bytes, const std::string& name) {
    ByteSource source(bytes);
    const stbi_io_callbacks io = ByteSource::callbacks();
    int width = 0, height = 0, channels = 0;
    // Channels as they are in the file: asked for four, the decoder reads past the end of 16-bit
    // PNMs. Of PICs it makes four in any case, and goes on to three though the file is broken.
    constexpr uint8_t kPicStart[] = {0x53, 0x80, 0xF6, 0x34};
    const bool pic = bytes.size() >= 4 && std::equal(kPicStart, kPicStart + 4, bytes.begin());
    const std::unique_ptr<stbi_uc, FreePixels> pixels(
        stbi_load_from_callbacks(&io, &source, &width, &height, &channels, pic ? 4 : 0));
    if (!pixels) {
        return refuseAsDecoder(name);
    }
    if (source.overrun()) {
        return refuse(name, "truncated");
    }
    Image<Rgba8> image(width, height);
    constexpr std::array kExpand{expand<1>, expand<2>, expand<3>, expand<4>};
    kExpand[size_t(pic ? 3 : channels - 1)](pixels.get(), image.view());
    return image;
}

}  // namespace

Result<Image<Rgba8>> decodeImage(std::span<const uint8_t> bytes, const std::string& name) {
    if (bytes.empty()) {
        return refuse(name, "empty file");
    }
    if (bytes.size() > size_t(INT_MAX)) {
        return refuse(name, "larger than 2 GiB");
    }
    if (hasOversizedHuffmanTable(bytes)) {
        return refuse(name, "Huffman table of more than 256 codes");
    }
    int width = 0, height = 0, channels = 0;
    const int length = int(bytes.size());
    setAllowance(bytes.size(), 0, 0);
    if (!stbi_info_from_memory(bytes.data(), length, &width, &height, &channels)) {
        return refuseAsDecoder(name);
    }
    // The decoder reports the negative heights of top-down BMPs as they stand in the file.
    const int64_t wide = std::abs(int64_t(width)), high = std::abs(int64_t(height));
    if (wide < 1 || high < 1 || wide > kMaxImageSize || high > kMaxImageSize ||
        wide * high > kMaxImagePixels) {
        return refuse(name, std::to_string(wide) + " × " + std::to_string(high) +
                                " pixels, expected 1 to " + std::to_string(kMaxImageSize) +
                                " a side and at most " + std::to_string(kMaxImagePixels >> 20) +
                                " Mpixel");
    }
    // No format packs more into a byte (runs of 65535 pixels in 4 bytes of a PIC), so there is not
    // enough in the file, and the decoder need not take memory to find that out.
    constexpr int64_t kPixelsPerByte = 16384;
    if (wide * high / kPixelsPerByte > length) {
        return refuse(name, std::to_string(wide) + " × " + std::to_string(high) + " pixels in " +
                                std::to_string(length) + " bytes, expected a whole file");
    }
    setAllowance(bytes.size(), wide, high);
    if (stbi_is_hdr_from_memory(bytes.data(), length)) {
        return decodeHdr(bytes, name);
    }
    const std::vector<uint8_t> full = withFullPalette(bytes);
    return decodeBytes(full.empty() ? bytes : full, name);
}

Result<void> checkImageMemory(std::span<const uint8_t> bytes, const std::string& name,
                              uint64_t max_memory_bytes) {
    // Pixels as decoded and as kept, a texture with its mips, the first of them in double.
    constexpr uint64_t kPixelBytes = 16;
    int width = 0, height = 0, channels = 0;
    setAllowance(bytes.size(), 0, 0);
    if (bytes.size() > size_t(INT_MAX) ||
        !stbi_info_from_memory(bytes.data(), int(bytes.size()), &width, &height, &channels)) {
        return {};
    }
    const uint64_t pixels =
        uint64_t(std::abs(int64_t(width))) * uint64_t(std::abs(int64_t(height)));
    return checkMemory(name, pixels * kPixelBytes, max_memory_bytes);
}

Result<Image<Rgba8>> loadImage(const std::filesystem::path& file, uint64_t max_memory_bytes) {
    const Result<std::string> text = readFile(file);
    if (!text) {
        return tl::make_unexpected(text.error());
    }
    const std::span bytes{reinterpret_cast<const uint8_t*>(text->data()), text->size()};
    const std::string name = shownPath(file);
    return checkImageMemory(bytes, name, max_memory_bytes).and_then([&] {
        return decodeImage(bytes, name);
    });
}

}  // namespace still
