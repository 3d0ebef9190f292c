// What the laboratory makes of a 3×3 window: boxes that hold history, and filtered samples.

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "lab_bench.h"

using namespace lab_bench;

TEST_CASE("lab: rectification gives the values worked out by hand", "[postfx][unit]") {
    // Window: eight samples of 800, one corner of 1700. μ = 900, σ² = 80000, σ = 282.8.
    const auto rectified = [](Rectification rectification, int history, int sigma_fx8 = 256) {
        TaaPolicy policy = plain();
        policy.alpha_q15 = 0;
        policy.rectification = rectification;
        policy.sigma_fx8 = sigma_fx8;
        Bench bench(history);
        bench.show(policy);
        bench.fill(800);
        bench.set(9, 9, 1700, 1700, 1700);
        bench.show(policy);
        return bench.red();
    };
    CHECK(rectified(Rectification::off, 3000) == 3000);
    CHECK(rectified(Rectification::clamp, 3000) == 1700);
    CHECK(rectified(Rectification::clamp, 100) == 800);
    CHECK(rectified(Rectification::clamp, 1234) == 1234);
    CHECK(std::abs(rectified(Rectification::clip, 3000) - 1700) <= 1);
    CHECK(rectified(Rectification::clip, 1234) == 1234);
    // The plus-shaped box is 800 … 800, so the rounded one 800 … 1250.
    CHECK(std::abs(rectified(Rectification::rounded_clip, 3000) - 1250) <= 1);
    CHECK(rectified(Rectification::rounded_clip, 1000) == 1000);
    for (const auto kind : {Rectification::variance_clamp, Rectification::variance_clip}) {
        CHECK(std::abs(rectified(kind, 3000) - 1183) <= 5);
        CHECK(std::abs(rectified(kind, 100) - 617) <= 5);
        CHECK(rectified(kind, 1150) == 1150);
        CHECK(std::abs(rectified(kind, 3000, 512) - 1466) <= 10);
        CHECK(rectified(kind, 3000, 0) == 900);
    }
}

TEST_CASE("lab: clipping keeps the hue that clamping bends", "[postfx][unit]") {
    const auto rectified = [](Rectification rectification, ColourSpace space) {
        TaaPolicy policy = plain();
        policy.alpha_q15 = 0;
        policy.rectification = rectification;
        policy.space = space;
        Bench bench;
        bench.fill(5000, 2000, 1000);
        bench.show(policy);
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                const int grey = (x + y) % 2 == 0 ? 500 : 1500;
                bench.set(x, y, grey, grey, grey);
            }
        }
        bench.show(policy);
        return std::vector<int>{bench.red(), bench.green(), bench.blue()};
    };
    // From the box's middle, 1000, the line to (5000, 2000, 1000) leaves it at an eighth.
    CHECK(rectified(Rectification::clamp, ColourSpace::rgb) == std::vector<int>{1500, 1500, 1000});
    CHECK(rectified(Rectification::clip, ColourSpace::rgb) == std::vector<int>{1500, 1125, 1000});
    // In YCoCg grey samples leave no room for chroma.
    CHECK(rectified(Rectification::clamp, ColourSpace::ycocg) ==
          std::vector<int>{1500, 1500, 1500});
    CHECK(rectified(Rectification::clip, ColourSpace::ycocg) == std::vector<int>{1000, 1000, 1000});
}

TEST_CASE("lab: a wider box at rest shrinks with speed", "[postfx][unit]") {
    const auto rectified = [](int motion_fx8) {
        TaaPolicy policy = plain();
        policy.alpha_q15 = 0;
        policy.rectification = Rectification::variance_clamp;
        policy.sigma_fx8 = 256;
        policy.sigma_still_fx8 = 768;
        policy.sigma_speed = 8;
        Bench bench(8000);
        bench.show(policy);
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                const int grey = 1000 + 1000 * (x % 3);
                bench.set(x, y, grey, grey, grey);
            }
        }
        bench.setMotion(motion_fx8, 0);
        bench.show(policy);
        return bench.red();
    };
    // σ = 816.5 around 2000.
    CHECK(std::abs(rectified(0) - 4449) <= 30);
    CHECK(std::abs(rectified(4 * 256) - (2000 + 1225)) <= 30);  // k = 1 + 2 / 4
    CHECK(std::abs(rectified(8 * 256) - 2816) <= 15);
    CHECK(std::abs(rectified(9 * 256) - 2816) <= 15);
}

TEST_CASE("lab: sample filters keep flat pictures and move with the jitter", "[postfx][unit]") {
    for (int filter = 0; filter <= int(SampleFilter::lanczos2); ++filter) {
        TaaPolicy policy = plain();
        policy.sample = SampleFilter(filter);
        Bench bench(1234);
        for (const int jitter : {0, 100, -128}) {
            bench.laboratory.resolve(bench.gbuffer, {true, jitter, -jitter}, policy,
                                     bestSimdTarget(), bench.workers);
            CHECK(bench.red() == 1234);
            CHECK(bench.red(0, 0) == 1234);
        }
    }
    TaaPolicy policy = plain();
    policy.sample = SampleFilter::triangle;
    Bench bench;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            bench.set(x, y, 256 * x, 256 * y, 0);
        }
    }
    // Samples lie 50/256 right of the centres, so the centres lie between this and the left one.
    bench.laboratory.resolve(bench.gbuffer, {true, 50, -20}, policy, bestSimdTarget(),
                             bench.workers);
    CHECK(std::abs(bench.red() - (2560 - 50)) <= 1);
    CHECK(std::abs(bench.green() - (2560 + 20)) <= 1);
}
