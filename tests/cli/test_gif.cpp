#include <catch2/catch.hpp>
#include <cstdlib>
#include <random>

#include "demos/stillframe/gif.h"
#include "demos/stillframe/gif_palette.h"

namespace still::command {
namespace {

/// The decoder of the GIF specification, written for clearness. Stops at the end code.
std::vector<uint8_t> decode(const std::vector<uint8_t>& bytes) {
    std::vector<std::vector<uint8_t>> strings;
    std::vector<uint8_t> out, before;
    size_t bit = 0;
    int bits = 9;
    const auto next = [&] {
        int code = 0;
        for (int i = 0; i < bits; ++i, ++bit) {
            if (bit / 8 >= bytes.size()) {
                FAIL("no end code");
            }
            code |= (bytes[bit / 8] >> (bit % 8) & 1) << i;
        }
        return code;
    };
    const auto clear = [&] {
        strings.clear();
        for (int i = 0; i < 256; ++i) {
            strings.push_back({uint8_t(i)});
        }
        strings.resize(258);
        bits = 9;
        before.clear();
    };
    for (int code = next(); code != 257; code = next()) {
        if (code == 256) {
            clear();
            continue;
        }
        if (code > int(strings.size())) {
            FAIL("code " << code << " is not known yet");
        }
        std::vector<uint8_t> string = before;
        if (code < int(strings.size())) {
            string = strings[size_t(code)];
        } else {
            string.push_back(before[0]);
        }
        if (!before.empty() && strings.size() < 4096) {
            before.push_back(string[0]);
            strings.push_back(before);
            bits += strings.size() == size_t(1) << bits && bits < 12 ? 1 : 0;
        }
        out.insert(out.end(), string.begin(), string.end());
        before = string;
    }
    CHECK(bit / 8 + 1 >= bytes.size());
    return out;
}

Image<Rgb8> gradient(int width, int height) {
    Image<Rgb8> image(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            image.at(x, y) = {uint8_t(x * 255 / width), uint8_t(y * 255 / height), 128};
        }
    }
    return image;
}

}  // namespace

TEST_CASE("gif: LZW gives back what went in", "[cli]") {
    std::mt19937 random(1);
    for (size_t size : {0u, 1u, 2u, 3u, 254u, 255u, 256u, 257u, 511u, 3837u, 3838u, 3839u, 3840u,
                        4096u, 20000u, 100000u}) {
        for (uint32_t colours : {1u, 2u, 17u, 256u}) {
            INFO(size << " indices, " << colours << " colours");
            std::vector<uint8_t> indices(size);
            for (uint8_t& index : indices) {
                index = uint8_t(random() % colours);
            }
            CHECK(decode(gifLzw(indices)) == indices);
        }
    }
}

TEST_CASE("gif: a picture of few colours keeps them", "[cli]") {
    Image<Rgb8> image(16, 16);
    for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 16; ++x) {
            image.at(x, y) = (x / 4 + y / 4) % 2 == 0 ? Rgb8{250, 10, 10} : Rgb8{10, 10, 250};
        }
    }
    const ImageView<const Rgb8> view = std::as_const(image).view();
    const GifPalette palette = choosePalette(view);
    CHECK(palette.count == 2);
    const std::vector<uint8_t> indices = applyPalette(view, palette);
    CHECK(palette.colours[indices[0]] == Rgb8{250, 10, 10});
    CHECK(palette.colours[indices[4]] == Rgb8{10, 10, 250});
}

TEST_CASE("gif: a gradient keeps its mean colour and stays near each pixel", "[cli]") {
    const Image<Rgb8> image = gradient(128, 128);
    const GifPalette palette = choosePalette(image.view());
    CHECK(palette.count == 256);
    const std::vector<uint8_t> indices = applyPalette(image.view(), palette);
    int64_t bias = 0;
    int worst = 0;
    for (int y = 0; y < 128; ++y) {
        for (int x = 0; x < 128; ++x) {
            const int shown = palette.colours[indices[size_t(y * 128 + x)]].r;
            bias += shown - image.at(x, y).r;
            worst = std::max(worst, std::abs(shown - image.at(x, y).r));
        }
    }
    CHECK(std::abs(bias) < 128 * 128);
    CHECK(worst < 32);
}

TEST_CASE("gif: a flat background keeps its very colour, whatever is before it", "[cli]") {
    for (const Rgb8 background : {Rgb8{0, 0, 0}, {32, 48, 64}, {255, 255, 255}, {7, 7, 8}}) {
        Image<Rgb8> image = gradient(128, 128);
        for (int y = 0; y < 128; ++y) {
            for (int x = 0; x < 128; ++x) {
                const bool before = x > 40 && x < 90 && y > 30 && y < 100;
                image.at(x, y) = before ? image.at(x, y) : background;
            }
        }
        // Dark browns like those that a black background was once mistaken for.
        image.at(60, 60) = {10, 4, 3};
        image.at(61, 60) = {12, 6, 2};
        const ImageView<const Rgb8> view = std::as_const(image).view();
        const GifPalette palette = choosePalette(view);
        const std::vector<uint8_t> indices = applyPalette(view, palette);
        int wrong = 0;
        for (int y = 0; y < 30; ++y) {
            for (int x = 0; x < 128; ++x) {
                wrong += palette.colours[indices[size_t(y * 128 + x)]] != background ? 1 : 0;
            }
        }
        CHECK(wrong == 0);
    }
}

TEST_CASE("gif: delays add up to the wanted speed", "[cli]") {
    char* bytes = nullptr;
    size_t size = 0;
    std::FILE* stream = open_memstream(&bytes, &size);
    REQUIRE(stream != nullptr);
    const Image<Rgb8> image = gradient(4, 4);
    GifWriter writer(stream, 4, 4, 30);
    for (int i = 0; i < 30; ++i) {
        writer.add(image.view());
    }
    writer.finish();
    std::fclose(stream);
    const std::string gif(bytes, size);
    std::free(bytes);
    int total_cs = 0;
    const std::string control("\x21\xF9\x04\x04", 4);
    for (size_t at = gif.find(control); at != std::string::npos; at = gif.find(control, at + 1)) {
        total_cs += uint8_t(gif[at + 4]) + 256 * uint8_t(gif[at + 5]);
    }
    CHECK(total_cs == 100);
}

}  // namespace still::command
