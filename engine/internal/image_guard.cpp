// Formats: ITU-T T.81 (JPEG) annex B, W3C PNG specification chapter 5, Microsoft BITMAPINFOHEADER.

#include "engine/internal/image_guard.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace still {

namespace {

constexpr size_t kPaletteEntries = 256;

size_t bigEndian(std::span<const uint8_t> bytes, size_t at, size_t count) {
    size_t value = 0;
    for (size_t i = 0; i < count; ++i) {
        value = value << 8 | (at + i < bytes.size() ? bytes[at + i] : 0);
    }
    return value;
}

size_t littleEndian32(std::span<const uint8_t> bytes, size_t at) {
    return size_t(bytes[at]) | size_t(bytes[at + 1]) << 8 | size_t(bytes[at + 2]) << 16 |
           size_t(bytes[at + 3]) << 24;
}

std::vector<uint8_t> withZeros(std::span<const uint8_t> bytes, size_t at, size_t count) {
    std::vector<uint8_t> out(bytes.begin(), bytes.end());
    out.insert(out.begin() + ptrdiff_t(at), count, uint8_t{0});
    return out;
}

std::vector<uint8_t> withFullBmpPalette(std::span<const uint8_t> bytes) {
    constexpr size_t kFileHeader = 14, kPixelOffset = 10, kSmallestFile = 54;
    if (bytes.size() < kSmallestFile) {
        return {};
    }
    const bool old = littleEndian32(bytes, kFileHeader) == 12;
    const size_t pixels = littleEndian32(bytes, kPixelOffset);
    const size_t palette = kFileHeader + littleEndian32(bytes, kFileHeader);
    const size_t full_size = old ? 3 * (kPaletteEntries + 4) : 4 * kPaletteEntries;
    const uint8_t bits_per_pixel = bytes[old ? 24 : 28];
    if (bits_per_pixel > 8 || pixels <= palette || pixels >= palette + full_size ||
        pixels > bytes.size()) {
        return {};
    }
    std::vector<uint8_t> full = withZeros(bytes, pixels, palette + full_size - pixels);
    for (size_t i = 0; i < 4; ++i) {
        full[kPixelOffset + i] = uint8_t((palette + full_size) >> (8 * i));
    }
    return full;
}

std::vector<uint8_t> withFullPngPalette(std::span<const uint8_t> bytes) {
    constexpr size_t kSignature = 8, kAroundChunk = 12, kFull = 3 * kPaletteEntries;
    for (size_t at = kSignature; at + kAroundChunk <= bytes.size();) {
        const size_t length = bigEndian(bytes, at, 4);
        if (bigEndian(bytes, at + 4, 4) == 0x504C5445) {  // PLTE
            const size_t end = at + 8 + length;
            if (length >= kFull || length % 3 != 0 || end > bytes.size()) {
                return {};
            }
            // The chunk's checksum no longer fits; the decoder does not look at it.
            std::vector<uint8_t> full = withZeros(bytes, end, kFull - length);
            full[at + 2] = uint8_t(kFull >> 8);
            full[at + 3] = uint8_t(kFull & 255);
            return full;
        }
        at += kAroundChunk + length;
    }
    return {};
}

/// Whether the DHT segment whose length stands at `at` has a table of more than 256 codes.
bool isOversizedDht(std::span<const uint8_t> bytes, size_t at) {
    constexpr size_t kLengths = 16, kMaxCodes = 256;
    const size_t end = at + bigEndian(bytes, at, 2);
    for (at += 2; at < end;) {
        size_t codes = 0;
        for (size_t i = 1; i <= kLengths; ++i) {
            codes += bigEndian(bytes, at + i, 1);
        }
        if (codes > kMaxCodes) {
            return true;
        }
        at += 1 + kLengths + codes;
    }
    return false;
}

/// Where the marker at or after `at` stands (its last byte), as the decoder finds it.
size_t nextMarker(std::span<const uint8_t> bytes, size_t at) {
    while (at < bytes.size() && bytes[at] != 0xFF) {
        ++at;
    }
    while (at < bytes.size() && bytes[at] == 0xFF) {
        ++at;
    }
    return at;
}

}  // namespace

std::vector<uint8_t> withFullPalette(std::span<const uint8_t> bytes) {
    constexpr std::array<uint8_t, 8> kPng{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    if (bytes.size() > 2 && bytes[0] == 'B' && bytes[1] == 'M') {
        return withFullBmpPalette(bytes);
    }
    if (bytes.size() > kPng.size() && std::equal(kPng.begin(), kPng.end(), bytes.begin())) {
        return withFullPngPalette(bytes);
    }
    return {};
}

bool hasOversizedHuffmanTable(std::span<const uint8_t> bytes) {
    // As the decoder sees it: any number of FF, then the start of an image.
    const size_t start = nextMarker(bytes, 0);
    if (start >= bytes.size() || bytes[0] != 0xFF || bytes[start] != 0xD8) {
        return false;
    }
    // Application data may hold anything, so up to the first scan segments are skipped by length.
    // Behind it the decoder can be made to look for markers anywhere.
    constexpr uint8_t kDht = 0xC4, kScan = 0xDA, kFirstPlain = 0xD0, kLastPlain = 0xD8;
    bool in_scan = false;
    size_t at = nextMarker(bytes, start + 1);
    while (at < bytes.size()) {
        const uint8_t marker = bytes[at];
        if (marker == kDht && isOversizedDht(bytes, at + 1)) {
            return true;
        }
        in_scan |= marker == kScan;
        const bool plain = marker == 0 || (marker >= kFirstPlain && marker <= kLastPlain);
        at = nextMarker(bytes, at + 1 + (in_scan || plain ? 0 : bigEndian(bytes, at + 1, 2)));
    }
    return false;
}

}  // namespace still
