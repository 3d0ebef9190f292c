// What the resolve promises where nothing moves: exact sums, when they start, and when they end.

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "postfx/internal/rules.h"
#include "postfx/spatial.h"
#include "postfx/taa.h"
#include "taa_runs.h"

namespace {

using namespace still;
using synthetic::Colour;
using synthetic::Pose;
using synthetic::World;
using taa_runs::backdrop;
using taa_runs::ExactSums;
using taa_runs::Player;
using taa_runs::square;
using taa_runs::stillLife;

int pixelsWithCount(const Player& player, int count) {
    int n = 0;
    const ImageView<const uint8_t> plane = player.taa.sampleCount();
    for (int y = 0; y < plane.height; ++y) {
        n += int(std::count(plane.row(y), plane.row(y) + plane.width, uint8_t(count)));
    }
    return n;
}

int area(const World& world) {
    return world.width * world.height;
}

/// Whether the picture is the present frame alone, filtered in space.
bool showsOneFrame(Player& player, int frame) {
    Image<uint16_t> out[3];
    for (Image<uint16_t>& plane : out) {
        plane.resize(player.gbuffer.width(), player.gbuffer.height());
    }
    const std::array<int, 2> jitter = synthetic::jitter(frame);
    SpatialFilter filter;
    filter.run(spatialInput(player.gbuffer, jitter[0], jitter[1]), {.simd = SimdTarget::scalar},
               {out[0].view(), out[1].view(), out[2].view()}, player.workers);
    bool same = true;
    for (int c = 0; c < 3; ++c) {
        const Image<uint16_t>& plane = out[c];
        same &= taa_runs::copyOf(player.channel(c)) == taa_runs::copyOf(plane.view());
    }
    return same;
}

/// A backdrop that pans by `step` pixels a frame up to `last`, then rests.
World panningUntil(int last, double step, int frame) {
    World world{112, 80, frame <= last, {backdrop()}};
    world.layers[0].pose = [=](int f) {
        return Pose{{step * std::min(f, last), 0.3 * std::min(f, last)}};
    };
    return world;
}

}  // namespace

TEST_CASE("taa: a still scene becomes the exact integer mean of its samples, then freezes",
          "[postfx][unit]") {
    const World world = stillLife();
    Player player;
    ExactSums sums(world.width, world.height);
    for (int frame = 0; frame < 64; ++frame) {
        player.show(world, frame);
        CHECK_FALSE(player.taa.converged());  // the frame changed something
        sums.add(player);
        if (sums.count() >= taa::kSettled) {
            INFO("frame " << frame);
            CHECK(sums.wrongPixels(player) == 0);
            CHECK(pixelsWithCount(player, sums.count()) == area(world));
        }
    }
    const std::vector<uint16_t> finished = taa_runs::everything(player.taa);
    for (int frame = 64; frame < 64 + 70; ++frame) {
        player.show(world, frame);
        CHECK(player.taa.converged());
        REQUIRE(taa_runs::everything(player.taa) == finished);
    }
}

TEST_CASE("taa: the error of a still scene falls with every doubling of frames", "[postfx][unit]") {
    const World world = stillLife();
    const std::vector<Colour> wanted = synthetic::reference(world, 0, 16);
    Player player;
    double last = 0;
    for (int frame = 0; frame < 64; ++frame) {
        player.show(world, frame);
        if (frame == 0 || frame == 3 || frame == 15 || frame == 63) {
            const double now = player.error(wanted);
            INFO("frame " << frame << ": " << now << " dB, before " << last << " dB");
            CHECK(now > last + 3);
            last = now;
        }
    }
    CHECK(last > 40);
}

TEST_CASE("taa: when a camera stops the sums start anew and end as the mean of the still samples",
          "[postfx][unit]") {
    for (const double step : {0.4, 3.0}) {
        Player player;
        ExactSums sums(112, 80);
        for (int frame = 0; frame <= 11 + 64; ++frame) {
            player.show(panningUntil(10, step, frame), frame);
            CHECK(player.taa.converged() == (frame == 11 + 64));
            if (frame > 10 && sums.count() < 64) {
                sums.add(player);
            }
            if (sums.count() >= taa::kSettled) {
                INFO("frame " << frame << " step " << step);
                CHECK(sums.wrongPixels(player) == 0);
            }
        }
        CHECK(pixelsWithCount(player, 64) == 112 * 80);
    }
}

TEST_CASE("taa: where an object comes to rest the mean is that of the samples since",
          "[postfx][unit]") {
    const auto pose = [](int f) { return Pose{{30 + 2.5 * std::min(f, 6), 40}}; };
    World world{100, 80, false, {backdrop(), square(12, pose)}};
    world.layers[1].moves = true;
    Player player;
    ExactSums sums(world.width, world.height);
    player.play(world, 0, 6);
    for (int frame = 7; frame < 7 + 64; ++frame) {
        player.show(world, frame);
        sums.add(player);
    }
    int wrong = 0;
    for (int y = 29; y < 51; ++y) {
        for (int x = 34; x < 56; ++x) {
            wrong += sums.shown(player, x, y) ? 0 : 1;
        }
    }
    CHECK(wrong == 0);
    player.show(world, 7 + 64);
    CHECK(player.taa.converged());
    CHECK(player.error(synthetic::reference(world, 6, 16)) > 38);
}

TEST_CASE("taa: still pixels beside moving objects keep exact sums", "[postfx][unit]") {
    const auto pose = [](int f) { return Pose{{40 + 9 * std::sin(0.5 * f), 36 + 0.7 * f}}; };
    World world{140, 90, false, {backdrop(), square(8, pose)}};
    world.layers[1].moves = true;
    Player player;
    ExactSums sums(world.width, world.height);
    for (int frame = 0; frame < 40; ++frame) {
        player.show(world, frame);
        sums.add(player);
        if (sums.count() < taa::kSettled) {
            continue;
        }
        int wrong = 0, tested = 0;
        for (int y = 0; y < world.height; ++y) {
            for (int x = 0; x < world.width; ++x) {
                // The square and what its samples reach: 8 + 1.5 around all its places so far.
                const bool never_near = x < 20 || x > 60 || y < 26 || y > 36 + 0.7 * frame + 10;
                tested += never_near ? 1 : 0;
                wrong += never_near && !sums.shown(player, x, y) ? 1 : 0;
            }
        }
        INFO("frame " << frame);
        CHECK(wrong == 0);
        CHECK(tested > 6000);
    }
    CHECK_FALSE(player.taa.converged());
}

TEST_CASE("taa: sums forget an object that starts to move", "[postfx][unit]") {
    for (const int begin : {0, 1, 20}) {
        for (const double step : {0.7, 2.0, 7.0, 40.0}) {
            const auto pose = [=](int f) {
                return Pose{{30 + step * std::clamp(f - begin, 0, 2), 40}};
            };
            World red{140, 80, false, {backdrop(), square(9, pose)}}, green = red;
            red.layers[1].moves = green.layers[1].moves = true;
            green.layers[1].colour = [](synthetic::Point) { return Colour{0.1, 0.8, 0.3}; };
            Player a, b;
            for (int frame = 0; frame < begin + 11; ++frame) {
                a.show(red, frame);
                b.show(green, frame);
            }
            const double centre = pose(begin + 11).offset.x;
            const int ghosts = taa_runs::differences(a, b, [&](int x, int y) {
                return std::abs(x - centre) > 12 || std::abs(y - 40) > 12;
            });
            INFO("step " << step << " from frame " << begin);
            CHECK(ghosts == 0);
        }
    }
}

TEST_CASE("taa: sums take nothing from an object that moves across a reset", "[postfx][unit]") {
    const auto pose = [](int f) { return Pose{{20 + 7.0 * f, 40}}; };
    World red{140, 80, false, {backdrop(), square(9, pose)}}, green = red;
    red.layers[1].moves = green.layers[1].moves = true;
    green.layers[1].colour = [](synthetic::Point) { return Colour{0.1, 0.8, 0.3}; };
    Player a, b;
    for (int frame = 0; frame < 15; ++frame) {
        a.show(red, frame, {.reset = frame == 4});
        b.show(green, frame, {.reset = frame == 4});
    }
    CHECK(taa_runs::differences(a, b, [](int x, int) { return x < 14 + 7 * 7 - 12; }) == 0);
}

TEST_CASE("taa: reset, resize and the first frame show the frame filtered in space",
          "[postfx][unit]") {
    Player player;
    World world = stillLife();
    player.show(world, 0);
    CHECK(showsOneFrame(player, 0));
    CHECK(pixelsWithCount(player, 1) == area(world));
    player.show(world, 1);
    CHECK_FALSE(showsOneFrame(player, 1));
    player.play(world, 2, 20);
    player.show(world, 21, {.reset = true});
    CHECK(showsOneFrame(player, 21));
    CHECK(pixelsWithCount(player, 1) == area(world));
    world.width = 131;
    player.show(world, 22);
    CHECK(showsOneFrame(player, 22));
    CHECK(player.taa.colour().red.width == 131);
    player.settings.ring = 5;
    player.show(world, 23);
    CHECK(showsOneFrame(player, 23));
}

TEST_CASE("taa: after a reset the sums hold the samples since", "[postfx][unit]") {
    const World world = stillLife();
    Player player;
    player.play(world, 0, 29);
    ExactSums sums(world.width, world.height);
    for (int frame = 30; frame < 50; ++frame) {
        player.show(world, frame, {.reset = frame == 30});
        sums.add(player);
        if (sums.count() >= taa::kSettled) {
            CHECK(sums.wrongPixels(player) == 0);
        }
    }
}

TEST_CASE("taa: a still picture takes as many samples as are asked for", "[postfx][unit]") {
    const World world = stillLife();
    for (const int cap : {1, 2, 8, 9, 200, 255}) {
        Player player;
        player.settings.sample_cap = cap;
        ExactSums sums(world.width, world.height);
        for (int frame = 0; frame < cap; ++frame) {
            CHECK_FALSE(player.taa.converged());
            player.show(world, frame);
            sums.add(player);
        }
        INFO("cap " << cap);
        CHECK((cap == 1 ? showsOneFrame(player, 0) : sums.wrongPixels(player) == 0));
        CHECK(pixelsWithCount(player, cap) == area(world));
        const std::vector<uint16_t> finished = taa_runs::everything(player.taa);
        player.show(world, cap);
        CHECK(player.taa.converged());
        CHECK(taa_runs::everything(player.taa) == finished);
    }
}

TEST_CASE("taa: still pixels need no ring", "[postfx][unit]") {
    const auto pose = [](int f) { return Pose{{40 + 9 * std::sin(0.9 * f), 36}}; };
    World world{120, 70, false, {backdrop(), square(8, pose)}};
    world.layers[1].moves = true;
    for (const int ring : {1, 2, 16}) {
        Player player;
        player.settings.ring = ring;
        ExactSums sums(world.width, world.height);
        for (int frame = 0; frame < 20; ++frame) {
            player.show(world, frame);
            sums.add(player);
        }
        int wrong = 0;
        for (int y = 0; y < world.height; ++y) {
            for (int x = 60; x < world.width; ++x) {
                wrong += sums.shown(player, x, y) ? 0 : 1;
            }
        }
        INFO("ring " << ring);
        CHECK(wrong == 0);
    }
}

TEST_CASE("taa: raising the cap goes on with the sums", "[postfx][unit]") {
    const World world = stillLife();
    Player player;
    player.settings.sample_cap = 16;
    ExactSums sums(world.width, world.height);
    for (int frame = 0; frame < 40; ++frame) {
        player.settings.sample_cap = frame < 16 ? 16 : 40;
        player.show(world, frame);
        sums.add(player);
    }
    CHECK(sums.wrongPixels(player) == 0);
    CHECK(pixelsWithCount(player, 40) == area(world));
}

TEST_CASE("taa: lowering the cap starts the sums anew", "[postfx][unit]") {
    const World world = stillLife();
    Player player;
    player.play(world, 0, 4);
    player.settings.sample_cap = 3;
    ExactSums sums(world.width, world.height);
    for (int frame = 5; frame < 8; ++frame) {
        player.show(world, frame);
        sums.add(player);
    }
    CHECK(sums.wrongPixels(player) == 0);
    CHECK(pixelsWithCount(player, 3) == area(world));
}

TEST_CASE("taa: a finished picture wakes when something moves and when light changes",
          "[postfx][unit]") {
    World world{100, 80, false, {backdrop(), square(9, [](int f) {
                                     return Pose{{f < 70 ? 40.0 : 40.0 + 2 * (f - 69), 40}};
                                 })}};
    world.layers[1].moves = true;
    Player player;
    player.play(world, 0, 69);  // five idle frames
    CHECK(player.taa.converged());
    player.show(world, 70);
    CHECK_FALSE(player.taa.converged());
    World lit = stillLife();
    Player other;
    other.play(lit, 0, 69);
    CHECK(other.taa.converged());
    other.show(lit, 70, {.shading_changed = true});
    CHECK_FALSE(other.taa.converged());
    for (int frame = 71; frame < 71 + 63; ++frame) {
        other.show(lit, frame);
        CHECK_FALSE(other.taa.converged());
    }
    other.show(lit, 71 + 63);
    CHECK(other.taa.converged());
}
