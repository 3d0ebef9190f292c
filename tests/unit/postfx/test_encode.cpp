#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>

#include "postfx/encode.h"

namespace {

using namespace still;

double srgb(double v) {
    v = std::min(v, 1.0);
    return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}

int mismatches(const OutputTable& table, double (*mapped)(double)) {
    int count = 0;
    for (int v = 0; v < 65536; ++v) {
        const int wanted = int(std::floor(255 * srgb(mapped(v / 4096.0)) + 0.5));
        count += table[uint16_t(v)] != wanted ? 1 : 0;
    }
    return count;
}

double unmapped(double c) {
    return c;
}
double reinhard(double c) {
    return c * (1 + c / 256) / (1 + c);
}

}  // namespace

TEST_CASE("encode: the table is sRGB rounded to nearest for all 65536 inputs", "[postfx][unit]") {
    const auto table = std::make_unique<OutputTable>();
    CHECK(mismatches(*table, unmapped) == 0);
    CHECK((*table)[0] == 0);
    CHECK((*table)[4096] == 255);
    CHECK((*table)[65535] == 255);
}

TEST_CASE("encode: Reinhard follows its formula and reaches white at 16", "[postfx][unit]") {
    const auto table = std::make_unique<OutputTable>(ToneMap::reinhard);
    CHECK(mismatches(*table, reinhard) == 0);
    CHECK((*table)[65535] == 255);
    CHECK((*table)[4096] == 188);
}

TEST_CASE("encode: the tables never fall", "[postfx][unit]") {
    for (ToneMap tone_map : {ToneMap::none, ToneMap::reinhard}) {
        const auto table = std::make_unique<OutputTable>(tone_map);
        int falls = 0;
        for (int v = 1; v < 65536; ++v) {
            falls += (*table)[uint16_t(v)] < (*table)[uint16_t(v - 1)] ? 1 : 0;
        }
        CHECK(falls == 0);
    }
}

TEST_CASE("encode: every pixel of an odd-sized picture is written by any number of threads",
          "[postfx][unit]") {
    const auto table = std::make_unique<OutputTable>();
    Image<uint16_t> red(37, 51), green(37, 51), blue(37, 51);
    for (int y = 0; y < 51; ++y) {
        for (int x = 0; x < 37; ++x) {
            red.at(x, y) = uint16_t(x * 100);
            green.at(x, y) = uint16_t(y * 80);
            blue.at(x, y) = uint16_t(x * y * 30);
        }
    }
    for (int threads : {1, 3}) {
        Workers workers(threads);
        Image<Rgb8> out(37, 51);
        encodeOutput({red.view(), green.view(), blue.view()}, *table, out.view(), workers);
        int wrong = 0;
        for (int y = 0; y < 51; ++y) {
            for (int x = 0; x < 37; ++x) {
                const Rgb8 wanted{(*table)[red.at(x, y)], (*table)[green.at(x, y)],
                                  (*table)[blue.at(x, y)]};
                wrong += out.at(x, y) == wanted ? 0 : 1;
            }
        }
        CHECK(wrong == 0);
    }
}
