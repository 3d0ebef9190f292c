#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "engine/internal/image_load.h"
#include "tests/support/data_path.h"

using namespace still;

namespace {

/// Binary PPM of one colour.
std::string ppm(int width, int height, char value) {
    return "P6\n" + std::to_string(width) + " " + std::to_string(height) + "\n255\n" +
           std::string(size_t(width) * size_t(height) * 3, value);
}

bool samePixels(const Image<Rgba8>& a, const Image<Rgba8>& b) {
    if (a.width() != b.width() || a.height() != b.height()) {
        return false;
    }
    for (int y = 0; y < a.height(); ++y) {
        const auto equal = [](const Rgba8& p, const Rgba8& q) {
            return p.r == q.r && p.g == q.g && p.b == q.b && p.a == q.a;
        };
        if (!std::equal(a.view().row(y), a.view().row(y) + a.width(), b.view().row(y), equal)) {
            return false;
        }
    }
    return true;
}

std::string bigEndian(uint32_t value) {
    return {char(value >> 24), char(value >> 16), char(value >> 8), char(value)};
}

/// A PNG of one pixel whose IDAT says that it has `length` bytes. Checksums are not looked at.
std::string pngOfOnePixel(uint32_t length, const std::string& data) {
    const std::string header = bigEndian(1) + bigEndian(1) + std::string("\x08\x02\0\0\0", 5);
    return "\x89PNG\r\n\x1A\n" + bigEndian(13) + "IHDR" + header + "crc." + bigEndian(length) +
           "IDAT" + data + "crc." + bigEndian(0) + "IEND" + "crc.";
}

/// A zlib stream of 1 + 258 · `repeats` zeros, by the fixed codes of RFC 1951, 3.2.6, with a
/// checksum that is not looked at.
std::string deflatedZeros(int repeats) {
    std::string bits = "110" + std::string("00110000");
    for (int i = 0; i < repeats; ++i) {
        bits += "1100010100000";  // 258 bytes from 1 back
    }
    bits += "0000000";
    std::string bytes = "\x78\x01" + std::string((bits.size() + 7) / 8 + 4, '\0');
    for (size_t i = 0; i < bits.size(); ++i) {
        bytes[2 + i / 8] = char(uint8_t(bytes[2 + i / 8]) | (bits[i] - '0') << i % 8);
    }
    return bytes;
}

Result<Image<Rgba8>> decoded(const std::string& bytes) {
    return decodeImage({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}, "x.png");
}

/// Loads, or gives the reason, which must be one line with the file's name.
void loadsOrExplains(const std::filesystem::path& file) {
    INFO(file);
    const Result<Image<Rgba8>> image = loadImage(file);
    if (image) {
        CHECK(image->width() > 0);
        CHECK(image->height() > 0);
    } else {
        CHECK(isOneLineAbout(image.error().message, file.filename().string()));
    }
}

}  // namespace

TEST_CASE("image: every shared image loads or is refused with one line", "[unit][engine][data]") {
    for (const auto& file : dataFiles("images")) {
        loadsOrExplains(file);
    }
}

TEST_CASE("image: valid PNGs load, truncated and foreign files do not", "[unit][engine][data]") {
    for (const auto& file : dataFiles("images/pngsuite", {".png"})) {
        INFO(file);
        CHECK(loadImage(file).has_value());
    }
    for (const char* name :
         {"truncated.png", "truncated.jpg", "truncated.tga", "empty.png", "not_an_image.png"}) {
        const auto file = dataFile(std::string("images/derived/") + name);
        INFO(name);
        CHECK((file.empty() || !loadImage(file).has_value()));
    }
}

TEST_CASE("image: one picture in many lossless formats gives the same pixels",
          "[unit][engine][data]") {
    const auto reference_file = dataFile("images/derived/rgb.png");
    if (reference_file.empty()) {
        return;
    }
    const Result<Image<Rgba8>> reference = loadImage(reference_file);
    REQUIRE(reference);
    for (const char* name :
         {"rgb.ppm", "rgb24.bmp", "rgb24.tga", "rgb24_rle.tga", "rgb24_topleft.tga"}) {
        INFO(name);
        const Result<Image<Rgba8>> image = loadImage(reference_file.parent_path() / name);
        REQUIRE(image);
        CHECK(samePixels(*reference, *image));
    }
}

TEST_CASE("image: BMPs whose palette is short are filled up with black", "[unit][engine][data]") {
    const auto os2 = dataFile("images/bmp/pal8os2sp.bmp"), v5 = dataFile("images/bmp/pal8v5.bmp");
    if (os2.empty() || v5.empty()) {
        return;
    }
    const Result<Image<Rgba8>> a = loadImage(os2), b = loadImage(v5);
    REQUIRE(a);
    REQUIRE(b);
    CHECK(samePixels(*a, *b));
}

TEST_CASE("image: files that cannot be read are named", "[unit][engine]") {
    const TempFolder folder;
    for (const std::filesystem::path& file :
         {folder.path() / "missing.png", folder.path(), folder.write("empty.png", ""),
          folder.write("text.png", "hello"), folder.write("short.ppm", "P6\n4 4\n255\nabc"),
          folder.write("nul.png", std::string(64, '\0')),
          folder.write("line\nbreak.png", "no image")}) {
        const Result<Image<Rgba8>> image = loadImage(file);
        REQUIRE_FALSE(image);
        std::string name = file.filename().string();
        std::replace(name.begin(), name.end(), '\n', '?');
        CHECK(isOneLineAbout(image.error().message, name));
    }
}

TEST_CASE("image: sizes beyond the limits are refused before decoding", "[unit][engine]") {
    const TempFolder folder;
    for (const char* header : {"P6\n100000 100000\n255\n", "P6\n16385 1\n255\n",
                               "P6\n1 16385\n255\n", "P6\n0 0\n255\n"}) {
        const Result<Image<Rgba8>> image = loadImage(folder.write("big.ppm", header));
        REQUIRE_FALSE(image);
        CHECK(isOneLineAbout(image.error().message, "big.ppm"));
    }
    const Result<Image<Rgba8>> hollow = loadImage(folder.write("a.ppm", "P6\n16384 16384\n255\n"));
    REQUIRE_FALSE(hollow);
    CHECK(hollow.error().message.find("16384 × 16384 pixels in 19 bytes") != std::string::npos);
    const Result<Image<Rgba8>> wide = loadImage(folder.write("wide.ppm", ppm(16384, 1, 7)));
    REQUIRE(wide);
    CHECK(wide->width() == 16384);
}

TEST_CASE("image: a file that asks for gigabytes its size has no use for is refused",
          "[unit][engine]") {
    const std::string pixel = deflatedZeros(1);
    REQUIRE(decoded(pngOfOnePixel(uint32_t(pixel.size()), pixel)));
    constexpr const char* kReason = "x.png: not a readable image: asks for more memory than";
    for (const uint32_t length : {uint32_t{1} << 30, uint32_t{3} << 29}) {
        const auto image = decoded(pngOfOnePixel(length, pixel));
        REQUIRE_FALSE(image);
        CHECK(image.error().message.starts_with(kReason));
    }
    const std::string bomb = deflatedZeros(40000);  // 65 KB, 10 MB
    const auto image = decoded(pngOfOnePixel(uint32_t(bomb.size()), bomb));
    REQUIRE_FALSE(image);
    CHECK(image.error().message.starts_with(kReason));
}

TEST_CASE("image: a PNG whose first IDAT is empty loads as without it", "[unit][engine]") {
    const std::string pixel = deflatedZeros(1);
    const std::string plain = pngOfOnePixel(uint32_t(pixel.size()), pixel);
    std::string with_empty = plain;
    with_empty.insert(plain.find("IDAT") - 4, bigEndian(0) + "IDAT" + "crc.");
    const auto expected = decoded(plain), found = decoded(with_empty);
    REQUIRE(expected);
    REQUIRE(found);
    CHECK(samePixels(*expected, *found));
}

TEST_CASE("image: a PIC whose runs are broken is refused, a whole one is loaded",
          "[unit][engine]") {
    const std::string start = "\x53\x80\xF6\x34" + std::string(84, '\0') + "PICT" +
                              std::string("\0\2\0\2\x3F\x80\0\0\0\3\0\0", 12) +
                              std::string("\0\x08\2\xE0", 4);
    const std::string row("\x81\x01\x02\x03", 4);  // two pixels of one colour
    const auto whole = decoded(start + row + row);
    REQUIRE(whole);
    CHECK((whole->at(1, 1) == Rgba8{1, 2, 3, 255}));
    const auto broken = decoded(start + "\x02" + row + row);  // runs of three are too long
    REQUIRE_FALSE(broken);
    CHECK(isOneLineAbout(broken.error().message, "x.png"));
}

TEST_CASE("image: opaque formats get alpha 255", "[unit][engine]") {
    const std::string bytes = ppm(3, 2, char(200));
    const Result<Image<Rgba8>> image =
        decodeImage({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}, "x.ppm");
    REQUIRE(image);
    CHECK(image->width() == 3);
    CHECK(image->height() == 2);
    CHECK(image->at(2, 1).r == 200);
    CHECK(image->at(2, 1).a == 255);
}

TEST_CASE("image: HDR is clamped and encoded to sRGB", "[unit][engine]") {
    // Flat RGBE, 4 × 1: 1.0, 0.5, 16.0 and 0 as grey. 128 · 2^(e − 136): e = 129 is 1.0.
    const auto texel = [](int mantissa, int exponent) {
        const char m = char(mantissa);
        return std::string{m, m, m, char(exponent)};
    };
    const std::string bytes = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 4\n" +
                              texel(128, 129) + texel(128, 128) + texel(128, 133) + texel(0, 0);
    const Result<Image<Rgba8>> image =
        decodeImage({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}, "x.hdr");
    REQUIRE(image);
    CHECK(image->at(0, 0).r == 255);
    CHECK(image->at(1, 0).g == 188);
    CHECK(image->at(2, 0).b == 255);
    CHECK(image->at(3, 0).r == 0);
}

TEST_CASE("image: an HDR that ends in empty runs is truncated, and decoding it ends",
          "[unit][engine]") {
    std::string bytes = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 8\n";
    bytes += std::string("\x02\x02\x00\x08\x88\x40", 6) + std::string(40, '\0');
    const Result<Image<Rgba8>> image =
        decodeImage({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}, "x.hdr");
    REQUIRE_FALSE(image);
    CHECK(image.error().message == "x.hdr: not a readable image: truncated");
}

TEST_CASE("image: no prefix of a file crashes the decoder", "[unit][engine]") {
    const std::string whole = ppm(5, 4, 'x');
    for (size_t length = 0; length < whole.size(); ++length) {
        const std::string part = whole.substr(0, length);
        const auto image =
            decodeImage({reinterpret_cast<const uint8_t*>(part.data()), part.size()}, "p.ppm");
        CHECK_FALSE(image);
    }
}
