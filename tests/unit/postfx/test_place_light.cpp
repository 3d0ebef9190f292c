#include <catch2/catch.hpp>

#include "postfx/place_light.h"

using namespace still;

namespace {

constexpr int kWidth = 12, kHeight = 9;

/// Two surfaces side by side, light that rises evenly on both.
struct Scenery {
    GBuffer gbuffer;
    LightImages light, placed;
    LightPlanes planes;

    Scenery() {
        gbuffer.resize(kWidth, kHeight, {.normal = true});
        light.resize(kWidth, kHeight);
        planes = {
            {light.direct_red.view(), light.direct_green.view(), light.direct_blue.view()},
            {light.indirect_red.view(), light.indirect_green.view(), light.indirect_blue.view()}};
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                gbuffer.id.at(x, y) = uint16_t(x < 6 ? 1 : 2);
                light.direct_red.at(x, y) = uint16_t(1000 + 256 * x + 512 * y + (x < 6 ? 0 : 9000));
                light.indirect_blue.at(x, y) = uint16_t(x % 2 == 0 ? 0 : 65535);
            }
        }
    }
    void place(int x_fx8, int y_fx8) {
        Workers workers(2);
        placeLight(gbuffer, planes, x_fx8, y_fx8, placed, workers);
    }
};

}  // namespace

TEST_CASE("place_light: at the centre light stays, beside it follows its slope", "[postfx][unit]") {
    Scenery s;
    s.place(0, 0);
    CHECK(s.placed.direct_red.at(3, 4) == s.light.direct_red.at(3, 4));
    CHECK(s.placed.indirect_blue.at(11, 8) == 65535);
    for (const auto& [jx, jy] : {std::pair{64, 0}, {-128, 127}, {100, -30}}) {
        s.place(jx, jy);
        CAPTURE(jx, jy);
        CHECK(s.placed.direct_red.at(3, 4) == s.light.direct_red.at(3, 4) + jx + 2 * jy);
        CHECK(s.placed.direct_red.at(8, 4) == s.light.direct_red.at(8, 4) + jx + 2 * jy);
    }
    s.place(-128, 0);
    CHECK(s.placed.indirect_blue.at(3, 3) == 32768);
    CHECK(s.placed.direct_red.at(0, 0) == s.light.direct_red.at(0, 0));  // nothing is beyond
}

TEST_CASE("place_light: light of other surfaces and across creases stays away", "[postfx][unit]") {
    Scenery s;
    s.place(127, 0);
    CHECK(s.placed.direct_red.at(5, 4) == s.light.direct_red.at(5, 4));
    s.place(-128, 0);
    CHECK(s.placed.direct_red.at(6, 4) == s.light.direct_red.at(6, 4));
    for (int y = 0; y < kHeight; ++y) {
        s.gbuffer.normal.at(3, y) = 0x40000000;
    }
    s.place(-128, 0);
    CHECK(s.placed.direct_red.at(3, 4) == s.light.direct_red.at(3, 4));
    CHECK(s.placed.direct_red.at(4, 4) == s.light.direct_red.at(4, 4));
    CHECK(s.placed.direct_red.at(5, 4) == s.light.direct_red.at(5, 4) - 128);
}
