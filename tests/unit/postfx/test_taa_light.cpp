// TaaFrame::light_age: samples from before light changed do not count.

#include <algorithm>
#include <catch2/catch.hpp>

#include "taa_runs.h"

namespace {

using namespace still;
using taa_runs::Player;

/// The same geometry in another light.
synthetic::World litOtherwise(synthetic::World world) {
    for (synthetic::Layer& layer : world.layers) {
        layer.colour = [](synthetic::Point p) {
            const synthetic::Colour c = taa_runs::texture(p);
            return synthetic::Colour{1 - c[2], 0.2, 3 * c[0]};
        };
    }
    return world;
}

/// `age` up to column `end`, long beyond.
Image<uint8_t> agesUpTo(const synthetic::World& world, int end, int age) {
    Image<uint8_t> ages(world.width, world.height);
    for (int y = 0; y < world.height; ++y) {
        std::fill_n(ages.view().row(y), world.width, uint8_t{255});
        std::fill_n(ages.view().row(y), end, uint8_t(std::min(age, 255)));
    }
    return ages;
}

}  // namespace

TEST_CASE("taa: where light changed, pictures do not depend on what was before", "[postfx][unit]") {
    for (const bool moving : {false, true}) {
        const synthetic::World now = moving ? taa_runs::panning(1.3, 0.4) : taa_runs::stillLife();
        Player a, b;
        a.play(now, 0, 29);
        b.play(litOtherwise(now), 0, 29);
        const int end = now.width / 2;
        for (int age = 0; age < 12; ++age) {
            const Image<uint8_t> ages = agesUpTo(now, end, age);
            a.show(now, 30 + age, {.light_age = ages.view()});
            b.show(now, 30 + age, {.light_age = ages.view()});
            CHECK(taa_runs::differences(a, b, [&](int x, int) { return x < end; }) == 0);
            if (age < 3) {
                CHECK(taa_runs::differences(a, b, [&](int x, int) { return x >= end; }) > 100);
            }
        }
    }
}

TEST_CASE("taa: sums with samples from before light changed begin anew", "[postfx][unit]") {
    const synthetic::World world = taa_runs::stillLife();
    Player player;
    player.play(world, 0, 39);
    taa_runs::ExactSums sums(world.width, world.height);
    for (int i = 0; i < 20; ++i) {
        const Image<uint8_t> ages = agesUpTo(world, world.width, 10 + i);
        player.show(world, 40 + i, {.light_age = ages.view()});
        sums.add(player);
    }
    int wrong = 0;
    for (int y = 0; y < world.height; ++y) {
        for (int x = 0; x < world.width; ++x) {
            wrong += sums.shown(player, x, y) ? 0 : 1;
        }
    }
    CHECK(wrong == 0);
}

TEST_CASE("taa: light that is old changes nothing", "[postfx][unit]") {
    const synthetic::World world = taa_runs::stillLife();
    Player a, b;
    for (int frame = 0; frame < 70; ++frame) {
        const Image<uint8_t> ages = agesUpTo(world, world.width, 255);
        a.show(world, frame);
        b.show(world, frame, {.light_age = ages.view()});
        CHECK(taa_runs::everything(a.taa) == taa_runs::everything(b.taa));
    }
    CHECK(b.taa.converged());
}
