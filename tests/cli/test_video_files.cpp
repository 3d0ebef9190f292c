// APNG and Y4M, taken apart again.

#include <zlib.h>

#include <catch2/catch.hpp>
#include <random>

#include "demos/stillframe/apng.h"
#include "demos/stillframe/y4m.h"

namespace still::command {
namespace {

/// What a writer puts into a stream.
template <class Write>
std::string written(Write&& write) {
    char* bytes = nullptr;
    size_t size = 0;
    std::FILE* stream = open_memstream(&bytes, &size);
    REQUIRE(stream != nullptr);
    write(stream);
    std::fclose(stream);
    std::string text(bytes, size);
    std::free(bytes);
    return text;
}

uint32_t number(const std::string& bytes, size_t at, size_t size = 4) {
    uint32_t value = 0;
    for (size_t i = 0; i < size; ++i) {
        value = value << 8 | uint8_t(bytes.at(at + i));
    }
    return value;
}

struct Chunk {
    std::string type, bytes;
};

/// Checks lengths and checksums on the way.
std::vector<Chunk> chunksOf(const std::string& png) {
    std::vector<Chunk> chunks;
    CHECK(png.substr(0, 8) == "\x89PNG\r\n\x1a\n");
    for (size_t at = 8; at < png.size();) {
        const uint32_t size = number(png, at);
        const std::string body = png.substr(at + 4, size + 4);
        REQUIRE(body.size() == size + 4);
        CHECK(crc32(0, reinterpret_cast<const Bytef*>(body.data()), uInt(body.size())) ==
              number(png, at + 8 + size));
        chunks.push_back({body.substr(0, 4), body.substr(4)});
        at += 12 + size;
    }
    return chunks;
}

/// Rows of `bytes` a pixel out of zlib data whose filters are "none" and "up".
std::vector<uint8_t> unfiltered(const std::string& data, size_t width, size_t height,
                                size_t bytes) {
    const size_t stride = width * bytes;
    std::vector<uint8_t> rows((stride + 1) * height);
    uLongf size = uLongf(rows.size());
    REQUIRE(uncompress(rows.data(), &size, reinterpret_cast<const Bytef*>(data.data()),
                       uLong(data.size())) == Z_OK);
    REQUIRE(size == rows.size());
    std::vector<uint8_t> pixels(stride * height);
    for (size_t y = 0; y < height; ++y) {
        const uint8_t filter = rows[y * (stride + 1)];
        REQUIRE((filter == 0 || filter == 2));
        for (size_t x = 0; x < stride; ++x) {
            const uint8_t above = filter == 2 && y > 0 ? pixels[(y - 1) * stride + x] : 0;
            pixels[y * stride + x] = uint8_t(rows[y * (stride + 1) + 1 + x] + above);
        }
    }
    return pixels;
}

/// A player: the frames as they are shown.
struct Player {
    size_t width = 0, height = 0, bytes = 0;
    uint32_t announced = 0, sequence = 0;
    std::vector<std::vector<uint8_t>> frames;
    std::vector<std::pair<uint32_t, uint32_t>> sizes;  ///< of what was drawn
    std::vector<uint8_t> canvas;
    std::string control, data;

    void draw() {
        if (control.empty()) {
            return;
        }
        const size_t w = number(control, 4), h = number(control, 8), x0 = number(control, 12),
                     y0 = number(control, 16);
        REQUIRE((w > 0 && h > 0 && x0 + w <= width && y0 + h <= height));
        const std::vector<uint8_t> part = unfiltered(data, w, h, bytes);
        for (size_t y = 0; y < h; ++y) {
            std::copy_n(&part[y * w * bytes], w * bytes, &canvas[((y0 + y) * width + x0) * bytes]);
        }
        sizes.push_back({uint32_t(w), uint32_t(h)});
        frames.push_back(canvas);
        data.clear();
    }
    void play(const std::string& png) {
        const std::vector<Chunk> chunks = chunksOf(png);
        REQUIRE(chunks.front().type == "IHDR");
        CHECK(chunks.back().type == "IEND");
        for (const Chunk& chunk : chunks) {
            if (chunk.type == "IHDR") {
                width = number(chunk.bytes, 0);
                height = number(chunk.bytes, 4);
                bytes = chunk.bytes[9] == 6 ? 4 : 3;
                canvas.resize(width * height * bytes);
            } else if (chunk.type == "acTL") {
                announced = number(chunk.bytes, 0);
                CHECK(number(chunk.bytes, 4) == 0);  // for ever
            } else if (chunk.type == "fcTL") {
                CHECK(number(chunk.bytes, 0) == sequence++);
                draw();
                control = chunk.bytes;
                CHECK(number(chunk.bytes, 20, 2) == 1);
                CHECK(number(chunk.bytes, 22, 2) == 25);
            } else if (chunk.type == "IDAT") {
                CHECK(frames.empty());
                data += chunk.bytes;
            } else if (chunk.type == "fdAT") {
                CHECK(number(chunk.bytes, 0) == sequence++);
                data += chunk.bytes.substr(4);
            }
        }
        draw();
    }
};

template <class Pixel>
std::vector<uint8_t> bytesOf(const Image<Pixel>& image) {
    std::vector<uint8_t> bytes;
    for (int y = 0; y < image.height(); ++y) {
        const auto* row = reinterpret_cast<const uint8_t*>(image.view().row(y));
        bytes.insert(bytes.end(), row, row + size_t(image.width()) * sizeof(Pixel));
    }
    return bytes;
}

/// Random walks of a small rectangle over a noisy picture, now and then none.
template <class Pixel>
std::vector<Image<Pixel>> movie(int width, int height, int frames, uint32_t seed) {
    std::mt19937 random(seed);
    const auto noise = [&] { return uint8_t(random()); };
    std::vector<Image<Pixel>> pictures;
    Image<Pixel> picture(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            picture.at(x, y) = {noise(), noise(), noise()};
        }
    }
    for (int i = 0; i < frames; ++i) {
        pictures.emplace_back(width, height);
        for (int y = 0; y < height; ++y) {
            std::copy_n(picture.view().row(y), width, pictures.back().view().row(y));
        }
        const int x0 = int(random() % uint32_t(width)), y0 = int(random() % uint32_t(height));
        for (int y = y0; i % 3 != 1 && y < std::min(height, y0 + 5); ++y) {
            for (int x = x0; x < std::min(width, x0 + 7); ++x) {
                picture.at(x, y) = {noise(), noise(), noise()};
            }
        }
    }
    return pictures;
}

template <class Pixel>
void checkMovie(int width, int height, uint32_t seed) {
    const auto pictures = movie<Pixel>(width, height, 7, seed);
    const std::string png = written([&](std::FILE* stream) {
        ApngWriter writer(stream, int(pictures.size()), 25);
        for (const Image<Pixel>& picture : pictures) {
            REQUIRE(writer.add(picture.view()).has_value());
        }
        writer.finish();
    });
    Player player;
    player.play(png);
    CHECK(player.announced == pictures.size());
    REQUIRE(player.frames.size() == pictures.size());
    for (size_t i = 0; i < pictures.size(); ++i) {
        CHECK(player.frames[i] == bytesOf(pictures[i]));
        CHECK((i == 0 || player.sizes[i].first <= 7));
        CHECK((i == 0 || player.sizes[i].second <= 5));
    }
}

}  // namespace

TEST_CASE("apng: every frame comes back to the bit, and only what changed is in the file",
          "[cli]") {
    checkMovie<Rgb8>(60, 40, 1);
    checkMovie<Rgb8>(1, 1, 2);
    checkMovie<Rgb8>(200, 120, 3);
    checkMovie<Rgba8>(31, 17, 4);
}

TEST_CASE("y4m: colours come back by the matrix of BT.601, within its rounding", "[cli]") {
    Image<Rgb8> image(64, 64);
    std::mt19937 random(5);
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            image.at(x, y) = {uint8_t(random()), uint8_t(random()), uint8_t(random())};
        }
    }
    image.at(0, 0) = {0, 0, 0};
    image.at(1, 0) = {255, 255, 255};
    const std::string file = written([&](std::FILE* stream) {
        Y4mWriter writer(stream, 64, 64, 24);
        writer.add(std::as_const(image).view());
        writer.add(std::as_const(image).view());
    });
    const std::string header = "YUV4MPEG2 W64 H64 F24:1 Ip A1:1 C444 XCOLORRANGE=LIMITED\n";
    REQUIRE(file.starts_with(header + "FRAME\n"));
    REQUIRE(file.size() == header.size() + 2 * (6 + 3 * 64 * 64));
    const size_t first = header.size() + 6;
    CHECK(uint8_t(file[first]) == 16);
    CHECK(uint8_t(file[first + 1]) == 235);
    double worst = 0;
    for (size_t i = 0; i < 64 * 64; ++i) {
        const double y = (uint8_t(file[first + i]) - 16) / 219.0;
        const double cb = (uint8_t(file[first + 4096 + i]) - 128) / 224.0;
        const double cr = (uint8_t(file[first + 8192 + i]) - 128) / 224.0;
        const Rgb8 c = image.at(int(i % 64), int(i / 64));
        const double red = y + 1.402 * cr, blue = y + 1.772 * cb;
        const double green = (y - 0.299 * red - 0.114 * blue) / 0.587;
        worst = std::max({worst, std::abs(red * 255 - c.r), std::abs(green * 255 - c.g),
                          std::abs(blue * 255 - c.b)});
    }
    CHECK(worst < 2.0);
}

}  // namespace still::command
