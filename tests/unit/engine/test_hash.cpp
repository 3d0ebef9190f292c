#include <catch2/catch.hpp>

#include "engine/hash.h"

using namespace still;

namespace {

Image<uint16_t> counting(int width, int height) {
    Image<uint16_t> image(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            image.at(x, y) = uint16_t(y * width + x);
        }
    }
    return image;
}

uint64_t hashOf(const Image<uint16_t>& image) {
    return hashPlane(image.view());
}

}  // namespace

TEST_CASE("hash: padding does not count", "[unit][hash]") {
    Image<uint16_t> a = counting(5, 3);
    const uint64_t clean = hashOf(a);
    for (int y = 0; y < 3; ++y) {
        a.view().row(y)[5] = 0xABCD;
    }
    CHECK(hashOf(a) == clean);
}

TEST_CASE("hash: every pixel and the size count", "[unit][hash]") {
    Image<uint16_t> a = counting(5, 3);
    const uint64_t clean = hashOf(a);
    for (int y = 0; y < 3; ++y) {
        for (int x = 0; x < 5; ++x) {
            a.at(x, y) ^= 0x100;
            CHECK(hashOf(a) != clean);
            a.at(x, y) ^= 0x100;
        }
    }
    CHECK(hashOf(a) == clean);
    CHECK(hashOf(counting(3, 5)) != clean);
    CHECK(hashOf(counting(15, 1)) != clean);
}

TEST_CASE("hash: the value is the same on every machine", "[unit][hash]") {
    CHECK(hex(hashOf(counting(5, 3))) == "33e6beac30a348c1");
}

TEST_CASE("hash: numbers are hashed with their low byte first", "[unit][hash]") {
    const auto bytes = [](std::initializer_list<int> list) {
        return std::string(list.begin(), list.end());
    };
    const std::string size = bytes({1, 0, 0, 0, 1, 0, 0, 0});
    const uint16_t colour[] = {0x0201};
    const uint32_t depth[] = {0x04030201};
    const Motion motion[] = {{0x0201, 0x0403}};
    CHECK(hashPlane(ImageView<const uint16_t>{colour, 1, 1, 1}) == hashBytes(size + bytes({1, 2})));
    CHECK(hashPlane(ImageView<const uint32_t>{depth, 1, 1, 1}) ==
          hashBytes(size + bytes({1, 2, 3, 4})));
    CHECK(hashPlane(ImageView<const Motion>{motion, 1, 1, 1}) ==
          hashBytes(size + bytes({1, 2, 3, 4})));
}

TEST_CASE("hash: hexadecimal has 16 digits", "[unit][hash]") {
    CHECK(hex(0) == "0000000000000000");
    CHECK(hex(0x0123456789ABCDEF) == "0123456789abcdef");
}

TEST_CASE("hash: a frame hashes the planes it has", "[unit][hash]") {
    GBuffer gbuffer;
    gbuffer.resize(8, 4, {});
    Image<Rgb8> output(8, 4);
    const FrameHashes plain = hashFrame(std::as_const(output).view(), gbuffer);
    CHECK(plain.normal == 0);
    CHECK(plain.motion == 0);
    CHECK(plain.color != 0);
    CHECK(plain.depth != 0);
    gbuffer.blue.at(7, 3) = 1;
    output.at(0, 0).g = 1;
    const FrameHashes changed = hashFrame(std::as_const(output).view(), gbuffer);
    CHECK(changed.color != plain.color);
    CHECK(changed.output != plain.output);
    CHECK(changed.id == plain.id);
    gbuffer.resize(8, 4, {.normal = true, .motion = true});
    const FrameHashes full = hashFrame(std::as_const(output).view(), gbuffer);
    CHECK(full.normal != 0);
    CHECK(full.motion != 0);
    gbuffer.depth_before.at(1, 1) = 7;
    CHECK(hashFrame(std::as_const(output).view(), gbuffer).motion != full.motion);
}
