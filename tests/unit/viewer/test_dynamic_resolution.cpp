// Against a machine whose time goes with the pixels.

#include <catch2/catch.hpp>
#include <random>
#include <vector>

#include "demos/viewer/dynamic_resolution.h"

namespace still::viewer {
namespace {

/// Full resolution takes `pixels_ms` and everything else `fixed_ms`; times waver by `noise`.
struct Machine {
    double pixels_ms = 0, fixed_ms = 0, noise = 0;
    std::mt19937 random{7};

    double frameMs(int scale_percent) {
        const double waver = 1 + noise * (double(random() % 2001u) / 1000 - 1);
        return (fixed_ms + pixels_ms * scale_percent * scale_percent / 10000) * waver;
    }
};

std::vector<int> scales(Machine machine, int frames, double fps, int scale = 100) {
    DynamicResolution resolution;
    std::vector<int> all;
    for (int i = 0; i < frames; ++i) {
        scale = resolution.next(scale, machine.frameMs(scale), machine.fixed_ms, fps);
        all.push_back(scale);
    }
    return all;
}

}  // namespace

TEST_CASE("dynamic resolution: what is fast enough stays at full resolution") {
    for (const int scale : scales({20, 3, 0.1}, 300, 30)) {
        REQUIRE(scale == 100);
    }
}

TEST_CASE("dynamic resolution: the frame rate is reached and the scale then rests") {
    for (const double pixels_ms : {40.0, 60.0, 100.0, 200.0}) {
        INFO(pixels_ms);
        Machine machine{pixels_ms, 4, 0.05};
        const std::vector<int> all = scales(machine, 400, 30);
        const int last = all.back();
        machine.noise = 0;
        CHECK(machine.frameMs(last) < 1000.0 / 30 * 1.09);
        // Not lower than needed: two steps more would be too slow.
        CHECK(machine.frameMs(last + 10) > 1000.0 / 30);
        for (size_t i = 200; i < all.size(); ++i) {
            REQUIRE(all[i] == last);
        }
    }
}

TEST_CASE("dynamic resolution: it comes back when there is time again") {
    CHECK(scales({10, 2, 0.05}, 200, 30, 25).back() == 100);
}

TEST_CASE("dynamic resolution: a machine that cannot make it gets the smallest scale") {
    CHECK(scales({10000, 100, 0.05}, 100, 60).back() == DynamicResolution::kSmallest_percent);
}

TEST_CASE("dynamic resolution: one slow frame changes nothing") {
    DynamicResolution resolution;
    for (int i = 0; i < 100; ++i) {
        REQUIRE(resolution.next(100, i == 50 ? 60 : 25, 2, 30) == 100);
    }
}

}  // namespace still::viewer
