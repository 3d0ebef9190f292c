#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <utility>
#include <vector>

#include "postfx/sharpen.h"
#include "random_frames.h"

namespace still {
namespace {

struct Picture {
    Image<uint16_t> red, green, blue;

    Picture(int width, int height)
        : red(width, height), green(width, height), blue(width, height) {}
    ColourPlanes planes() const { return {red.view(), green.view(), blue.view()}; }
    ColourTargets targets() { return {red.view(), green.view(), blue.view()}; }
    std::vector<uint16_t> values() const {
        std::vector<uint16_t> all;
        for (const Image<uint16_t>* plane : {&red, &green, &blue}) {
            for (int y = 0; y < plane->height(); ++y) {
                const uint16_t* row = plane->view().row(y);
                all.insert(all.end(), row, row + plane->width());
            }
        }
        return all;
    }
};

Picture random(int width, int height, uint64_t seed) {
    random_frames::Random dice(seed);
    Picture picture(width, height);
    for (Image<uint16_t>* plane : {&picture.red, &picture.green, &picture.blue}) {
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                plane->at(x, y) = uint16_t(dice.below(dice.chance(20) ? 65536 : 5000));
            }
        }
    }
    return picture;
}

Image<uint8_t> randomConfidence(int width, int height, uint64_t seed) {
    random_frames::Random dice(seed);
    Image<uint8_t> plane(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            plane.at(x, y) = uint8_t(dice.below(256));
        }
    }
    return plane;
}

Picture sharpenedWith(const Picture& in, ImageView<const uint8_t> confidence, int sharpness_q15,
                      SimdTarget simd = bestSimdTarget(), int threads = 1) {
    Workers workers(threads);
    Picture out(in.red.width(), in.red.height());
    sharpen(in.planes(), confidence, sharpness_q15, out.targets(), simd, workers);
    return out;
}

}  // namespace

TEST_CASE("sharpen: no sharpness and no confidence change nothing", "[postfx][unit]") {
    const Picture in = random(61, 20, 1);
    CHECK(sharpenedWith(in, {}, 0).values() == in.values());
    const Image<uint8_t> none(61, 20);
    CHECK(sharpenedWith(in, none.view(), kFullSharpness_q15).values() == in.values());
}

TEST_CASE("sharpen: a flat picture stays flat", "[postfx][unit]") {
    Picture in(40, 9);
    for (int y = 0; y < 9; ++y) {
        std::fill_n(in.red.view().row(y), 40, uint16_t(4096));
        std::fill_n(in.green.view().row(y), 40, uint16_t(65535));
    }
    CHECK(sharpenedWith(in, {}, kFullSharpness_q15).values() == in.values());
}

TEST_CASE("sharpen: results lie within the pixel and its four neighbours", "[postfx][unit]") {
    const Picture in = random(50, 30, 2);
    const Picture out = sharpenedWith(in, {}, kFullSharpness_q15);
    int outside = 0, changed = 0;
    for (int y = 0; y < 30; ++y) {
        for (int x = 0; x < 50; ++x) {
            const auto at = [&](int i, int j) {
                return in.green.at(std::clamp(i, 0, 49), std::clamp(j, 0, 29));
            };
            const auto [low, high] =
                std::minmax({at(x, y), at(x - 1, y), at(x + 1, y), at(x, y - 1), at(x, y + 1)});
            const uint16_t value = out.green.at(x, y);
            outside += value < low || value > high ? 1 : 0;
            changed += value != in.green.at(x, y) ? 1 : 0;
        }
    }
    CHECK(outside == 0);
    CHECK(changed > 500);
}

TEST_CASE("sharpen: a ramp's foot is pushed by the gain that the lobe gives", "[postfx][unit]") {
    Picture in(16, 5);
    for (int y = 0; y < 5; ++y) {
        for (int x = 0; x < 16; ++x) {
            in.red.at(x, y) = uint16_t(x < 8 ? 1000 : (x == 8 ? 1400 : 2400));
        }
    }
    // Around column 8: 4 · 1400 − (1000 + 2400 + 2 · 1400) = −600.
    const Picture half = sharpenedWith(in, {}, kFullSharpness_q15 / 2);
    CHECK(half.red.at(8, 2) == 1400 - 225);
    Image<uint8_t> confidence(16, 5);
    confidence.at(8, 2) = 85;  // a third
    CHECK(sharpenedWith(in, confidence.view(), kFullSharpness_q15 / 2).red.at(8, 2) == 1400 - 75);
    // Full sharpness would overshoot: 1400 − 450 is below the darkest neighbour.
    const Picture full = sharpenedWith(in, {}, kFullSharpness_q15);
    CHECK(full.red.at(8, 2) == 1000);
    CHECK(full.red.at(7, 2) == 1000);
    CHECK(full.red.at(9, 2) == 2400);
}

TEST_CASE("sharpen: every SIMD target equals the scalar twin", "[postfx][unit]") {
    for (const auto& [width, height] : {std::pair{1, 1}, {2, 3}, {65, 17}, {7, 130}}) {
        for (uint64_t seed = 1; seed <= 4; ++seed) {
            const Picture in = random(width, height, seed);
            const Image<uint8_t> confidence = randomConfidence(width, height, seed);
            for (int sharpness : {1, 9000, 26214, kFullSharpness_q15}) {
                const auto view = seed % 2 == 0 ? confidence.view() : ImageView<const uint8_t>{};
                const auto wanted = sharpenedWith(in, view, sharpness, SimdTarget::scalar).values();
                for (SimdTarget target : availableSimdTargets()) {
                    INFO(name(target) << " " << width << "x" << height << " seed " << seed);
                    CHECK(sharpenedWith(in, view, sharpness, target).values() == wanted);
                }
            }
        }
    }
}

TEST_CASE("sharpen: threads do not change a bit", "[postfx][determinism]") {
    const Picture in = random(120, 90, 3);
    const auto wanted = sharpenedWith(in, {}, 20000).values();
    CHECK(sharpenedWith(in, {}, 20000, bestSimdTarget(), 4).values() == wanted);
}

}  // namespace still
