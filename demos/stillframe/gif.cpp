#include "demos/stillframe/gif.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "demos/stillframe/gif_palette.h"

namespace still::command {
namespace {

constexpr int kIndexBits = 8;
constexpr int kClear = 1 << kIndexBits;
constexpr int kEnd = kClear + 1;
constexpr int kMaxCodes = 4096;  // 12 bits
constexpr int kMaxBlock = 255;

/// Little-endian, 16 bits.
std::array<uint8_t, 2> word(int value) {
    return {uint8_t(value & 255), uint8_t(value >> 8)};
}

/// Codes of 9 to 12 bits, packed from the low bit up.
class BitWriter {
  public:
    void put(int code, int bits) {
        pending_ |= uint32_t(code) << count_;
        count_ += bits;
        while (count_ >= 8) {
            bytes_.push_back(uint8_t(pending_));
            pending_ >>= 8;
            count_ -= 8;
        }
    }
    std::vector<uint8_t> finish() {
        if (count_ > 0) {
            bytes_.push_back(uint8_t(pending_));
        }
        return std::move(bytes_);
    }

  private:
    std::vector<uint8_t> bytes_;
    uint32_t pending_ = 0;
    int count_ = 0;
};

/// (prefix code, next index) → code; open addressing, at most half full.
class StringTable {
  public:
    StringTable() { clear(); }
    void clear() { slots_.fill({}); }
    /// The code of the pair; -1 when it has none, and then `fresh` becomes its code.
    int findOrAdd(int prefix, int index, int fresh) {
        const uint32_t key = uint32_t(prefix) << kIndexBits | uint32_t(index);
        uint32_t at = key * 2654435761u >> (32 - kSlotBits);
        while (slots_[at].code >= 0 && slots_[at].key != key) {
            at = (at + 1) % kSlots;
        }
        const int found = slots_[at].code;
        if (found < 0) {
            slots_[at] = {key, fresh};
        }
        return found;
    }

  private:
    static constexpr int kSlotBits = 13;
    static constexpr uint32_t kSlots = 1u << kSlotBits;
    struct Slot {
        uint32_t key = 0;
        int code = -1;
    };
    std::array<Slot, kSlots> slots_;
};

}  // namespace

std::vector<uint8_t> gifLzw(std::span<const uint8_t> indices) {
    BitWriter out;
    StringTable table;
    int bits = kIndexBits + 1;
    int next = kEnd + 1;
    out.put(kClear, bits);
    int prefix = indices.empty() ? kEnd : indices[0];
    for (size_t i = 1; i < indices.size(); ++i) {
        const int index = indices[i];
        const int found = table.findOrAdd(prefix, index, next);
        if (found >= 0) {
            prefix = found;
            continue;
        }
        out.put(prefix, bits);
        prefix = index;
        // The decoder learns each string one code later, hence the comparison before counting up.
        if (next == 1 << bits) {
            ++bits;
        }
        ++next;
        if (next == kMaxCodes) {
            out.put(kClear, bits);
            table.clear();
            bits = kIndexBits + 1;
            next = kEnd + 1;
        }
    }
    if (!indices.empty()) {
        out.put(prefix, bits);
        // This code, too, lets the decoder learn a string.
        if (next == 1 << bits) {
            ++bits;
        }
    }
    out.put(kEnd, bits);
    return out.finish();
}

GifWriter::GifWriter(std::FILE* stream, int width, int height, int fps)
    : stream_(stream), width_(width), height_(height), fps_(fps) {
    const auto [w0, w1] = word(width);
    const auto [h0, h1] = word(height);
    put(std::array<uint8_t, 13>{'G', 'I', 'F', '8', '9', 'a', w0, w1, h0, h1, 0x70, 0, 0});
    put(std::array<uint8_t, 19>{0x21, 0xFF, 11, 'N', 'E', 'T', 'S', 'C', 'A', 'P', 'E', '2', '.',
                                '0', 3, 1, 0, 0, 0});
}

void GifWriter::add(ImageView<const Rgb8> image) {
    // Whole hundredths of a second whose sum stays on time; players slow down anything below 2.
    const int64_t begin_cs = frames_ * 100 / fps_;
    ++frames_;
    const int64_t end_cs = frames_ * 100 / fps_;
    const auto [d0, d1] = word(int(std::max<int64_t>(2, end_cs - begin_cs)));
    put(std::array<uint8_t, 8>{0x21, 0xF9, 4, 0x04, d0, d1, 0, 0});

    const auto [w0, w1] = word(width_);
    const auto [h0, h1] = word(height_);
    put(std::array<uint8_t, 10>{0x2C, 0, 0, 0, 0, w0, w1, h0, h1, 0x87});
    const GifPalette palette = choosePalette(image);
    std::array<uint8_t, 3 * 256> table{};
    for (size_t i = 0; i < palette.colours.size(); ++i) {
        const Rgb8 c = palette.colours[i];
        table[3 * i] = c.r;
        table[3 * i + 1] = c.g;
        table[3 * i + 2] = c.b;
    }
    put(table);

    const std::vector<uint8_t> codes = gifLzw(applyPalette(image, palette));
    put(std::array<uint8_t, 1>{kIndexBits});
    for (size_t at = 0; at < codes.size(); at += kMaxBlock) {
        const size_t size = std::min<size_t>(kMaxBlock, codes.size() - at);
        put(std::array<uint8_t, 1>{uint8_t(size)});
        put(std::span(codes).subspan(at, size));
    }
    put(std::array<uint8_t, 1>{0});
}

void GifWriter::finish() {
    put(std::array<uint8_t, 1>{0x3B});
}

void GifWriter::put(std::span<const uint8_t> bytes) {
    std::fwrite(bytes.data(), 1, bytes.size(), stream_);
}

}  // namespace still::command
