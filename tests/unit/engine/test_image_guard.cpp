#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "engine/internal/image_guard.h"
#include "engine/internal/image_load.h"

using namespace still;

namespace {

std::vector<uint8_t> bytesOf(const std::string& text) {
    return {text.begin(), text.end()};
}

std::string be32(uint32_t v) {
    return {char(v >> 24), char(v >> 16), char(v >> 8), char(v)};
}

std::string le32(uint32_t v) {
    return {char(v), char(v >> 8), char(v >> 16), char(v >> 24)};
}

std::string chunk(const std::string& name, const std::string& data) {
    return be32(uint32_t(data.size())) + name + data + "crc!";
}

/// DHT segment of one table with `codes` codes of 8 bits (and none of other lengths).
std::string huffmanTable(int codes_a, int codes_b) {
    std::string lengths(16, '\0');
    lengths[7] = char(codes_a);
    lengths[8] = char(codes_b);
    const std::string body = '\0' + lengths + std::string(size_t(codes_a + codes_b), 'v');
    const size_t size = body.size() + 2;
    return std::string("\xFF\xC4") + char(size >> 8) + char(size) + body;
}

std::string segment(uint8_t marker, const std::string& body) {
    const size_t size = body.size() + 2;
    return std::string("\xFF") + char(marker) + char(size >> 8) + char(size) + body;
}

bool oversized(const std::string& jpeg) {
    return hasOversizedHuffmanTable(bytesOf("\xFF\xD8" + jpeg));
}

}  // namespace

TEST_CASE("image guard: JPEGs with tables of more than 256 codes are found", "[unit][engine]") {
    CHECK_FALSE(oversized(huffmanTable(100, 156)));
    CHECK(oversized(huffmanTable(101, 156)));
    CHECK(oversized(huffmanTable(10, 10) + huffmanTable(255, 255)));
    CHECK(oversized("junk\xFF\xFF" + huffmanTable(255, 255)));
    // Inside application data it is no table, behind a scan it may be one anywhere.
    CHECK_FALSE(oversized(segment(0xE1, huffmanTable(255, 255)) + huffmanTable(1, 1)));
    CHECK(oversized(segment(0xE1, "exif") + segment(0xDA, "scan") + "data" +
                    segment(0xE1, huffmanTable(255, 255))));
    // More than one FF before the start of the image.
    CHECK(hasOversizedHuffmanTable(bytesOf("\xFF\xFF\xFF\xD8" + huffmanTable(255, 255))));
    CHECK_FALSE(oversized(""));
    CHECK_FALSE(oversized("\xFF"));
    CHECK_FALSE(oversized("\xFF\xC4"));
    CHECK_FALSE(hasOversizedHuffmanTable(bytesOf(huffmanTable(255, 255))));
    const std::vector<uint8_t> bad = bytesOf("\xFF\xD8" + huffmanTable(255, 255));
    const auto image = decodeImage(bad, "bad.jpg");
    REQUIRE_FALSE(image);
    CHECK(image.error().message ==
          "bad.jpg: not a readable image: Huffman table of more than 256 codes");
}

TEST_CASE("image guard: short PNG palettes are filled with black", "[unit][engine]") {
    const std::string head = "\x89PNG\r\n\x1A\n" + chunk("IHDR", std::string(13, 'h'));
    const std::string tail = chunk("IDAT", "data") + chunk("IEND", "");
    const std::string colours = "rgbRGB";
    CHECK(withFullPalette(bytesOf(head + chunk("PLTE", colours) + tail)) ==
          bytesOf(head + be32(768) + "PLTE" + colours + std::string(762, '\0') + "crc!" + tail));
    CHECK(withFullPalette(bytesOf(head + chunk("PLTE", std::string(768, 'c')) + tail)).empty());
    CHECK(withFullPalette(bytesOf(head + chunk("PLTE", "four") + tail)).empty());
    CHECK(withFullPalette(bytesOf(head + tail)).empty());
    CHECK(withFullPalette(bytesOf(head + be32(0xFFFFFFF0u) + "PLTE")).empty());
}

TEST_CASE("image guard: short BMP palettes are filled with black", "[unit][engine]") {
    const auto bmp = [](uint32_t palette_bytes, uint32_t offset) {
        return "BM" + std::string(8, '\0') + le32(offset) + le32(40) + std::string(10, '\0') +
               '\x08' + std::string(25, '\0') + std::string(palette_bytes, 'c') + "pixels";
    };
    std::string expected = bmp(8, 54 + 1024);
    expected.insert(62, 1016, '\0');
    CHECK(withFullPalette(bytesOf(bmp(8, 62))) == bytesOf(expected));
    CHECK(withFullPalette(bytesOf(bmp(1024, 54 + 1024))).empty());
    CHECK(withFullPalette(bytesOf(bmp(8, 0xFFFFFFFFu))).empty());
    CHECK(withFullPalette(bytesOf("BM")).empty());
}
