// What the resolve promises where things move: how good pictures become, and what must leave no
// trace. "No trace" is tested by telling the same story twice with other colours: pixels that
// must not know of the difference are equal to the last bit.

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
using synthetic::Layer;
using synthetic::Point;
using synthetic::Pose;
using synthetic::World;
using taa_runs::backdrop;
using taa_runs::panning;
using taa_runs::Player;
using taa_runs::square;

constexpr Colour kGreen{0.1, 0.8, 0.3};

World repainted(World world, size_t layer, Colour colour) {
    world.layers[layer].colour = [=](Point) { return colour; };
    return world;
}

/// Whether a pixel is the present frame alone, filtered in space.
bool showsOneFrame(const Player& player, int frame, int x, int y) {
    const std::array<int, 2> jitter = synthetic::jitter(frame);
    int rgb[3];
    spatialPixel(spatialInput(player.gbuffer, jitter[0], jitter[1]), x, y, rgb);
    return player.channel(0).at(x, y) == rgb[0] && player.channel(1).at(x, y) == rgb[1] &&
           player.channel(2).at(x, y) == rgb[2];
}

/// Next to no contrast around the pixel: one frame's samples need no filter.
bool plain(const Player& player, int x, int y) {
    bool flat = true;
    for (int c = 0; c < 3; ++c) {
        int low = 65535, high = 0;
        for (int j = std::max(y - 1, 0); j <= std::min(y + 1, player.gbuffer.height() - 1); ++j) {
            for (int i = std::max(x - 1, 0); i <= std::min(x + 1, player.gbuffer.width() - 1);
                 ++i) {
                low = std::min<int>(low, player.sample(c).at(i, j));
                high = std::max<int>(high, player.sample(c).at(i, j));
            }
        }
        flat &= high - low <= taa::contrastBound(high, taa::kFlatShift);
    }
    return flat;
}

/// Wires 0.3 … 0.6 pixels wide, 11 pixels apart, over a smooth ground.
World wires(double speed, bool with_ground) {
    World world{112, 80, true, {backdrop()}};
    world.layers[0].colour = [](Point p) { return synthetic::noise(p, 9); };
    Layer wire;
    wire.surface = 2;
    wire.depth = 0.3;
    wire.covers = [](Point p) {
        const double line = std::floor(p.x / 11);
        const double width = 0.3 + 0.1 * (int(line) & 3);
        return p.x - line * 11 < width;
    };
    wire.colour = [](Point) { return Colour{0.02, 0.02, 0.02}; };
    wire.pose = [=](int f) { return Pose{{speed * f, 0.11 * f}, 0.07}; };
    if (with_ground) {
        world.layers[0].pose = [=](int f) { return Pose{{speed * f, 0.11 * f}}; };
    }
    world.layers.push_back(wire);
    return world;
}

}  // namespace

TEST_CASE("taa: moving pictures reach their quality", "[postfx][unit]") {
    struct Case {
        const char* name;
        World world;
        double wanted_db;
    };
    const auto turning = [](double radian, double zoom) {
        World world = panning(0, 0);
        world.layers[0].pose = [=](int f) { return Pose{{56, 40}, radian * f, std::pow(zoom, f)}; };
        return world;
    };
    World disc{112, 80, false, {backdrop(), square(15, [](int f) {
                                    return Pose{{20 + 1.3 * f, 24 + 0.4 * f}, 0.01 * f};
                                })}};
    disc.layers[1].moves = true;
    const Case cases[] = {{"pan 1, 0", panning(1, 0), 36.1},
                          {"pan 3, -2", panning(3, -2), 36.1},
                          {"pan 1/2, 0", panning(0.5, 0), 30.9},
                          {"pan 1/2, 1/2", panning(0.5, 0.5), 30.9},
                          {"pan 1/16, 0", panning(0.0625, 0), 35.1},
                          {"pan 2.37, 1.71", panning(2.37, 1.71), 31.0},
                          {"turn 0.3 degrees", turning(0.3 / 57.29578, 1), 34.0},
                          {"turn 1 degree", turning(1 / 57.29578, 1), 33.2},
                          {"zoom 1.003", turning(0, 1.003), 35.8},
                          {"zoom 1.01", turning(0, 1.01), 34.6},
                          {"square 1.3, 0.4 over a still ground", disc, 37.2},
                          {"wires 0.7 with their ground", wires(0.7, true), 33.5},
                          {"wires 0.7 over a still ground", wires(0.7, false), 30.8},
                          {"wires 2.3 over a still ground", wires(2.3, false), 29.8}};
    for (const Case& c : cases) {
        Player player;
        double raw = 0, resolved = 0;
        for (int frame = 0; frame < 40; ++frame) {
            player.show(c.world, frame);
            if (frame >= 36) {
                const std::vector<Colour> wanted = synthetic::reference(c.world, frame, 8);
                raw += player.rawError(wanted) / 4;
                resolved += player.error(wanted) / 4;
            }
        }
        INFO(c.name << ": raw " << raw << " dB, resolved " << resolved << " dB");
        CHECK(resolved > c.wanted_db);
    }
}

TEST_CASE("taa: a ramp is shown as it is at the pixels' centres wherever its samples lie",
          "[postfx][unit]") {
    // In fx12. The steep one's windows have contrast; the gentle one's are made from fewer frames.
    struct Case {
        const char* name;
        double level, per_x, per_y, worst;
    };
    for (const Case& c : {Case{"steep", 560, 20, 20, 6}, Case{"gentle", 2000, 12, -7, 3}}) {
        for (const Point speed :
             {Point{0.37, 0.11}, Point{-1.5, 0.5}, Point{2, 1}, Point{0.013, -0.027}}) {
            World world{64, 48, true, {backdrop()}};
            const auto ramp = [&](Point p) {
                const double v = (c.level + c.per_x * p.x + c.per_y * p.y) / 4096;
                return Colour{v, v / 2, v / 4};
            };
            world.layers[0].colour = ramp;
            world.layers[0].pose = [=](int f) {
                return Pose{{32 + speed.x * (f - 14), 24 + speed.y * (f - 14)}};
            };
            Player player;
            double worst = 0, sum = 0;
            for (int frame = 0; frame < 18; ++frame) {
                player.show(world, frame);
                for (int y = 20; frame >= 10 && y < 28; ++y) {
                    for (int x = 24; x < 40; ++x) {
                        const Pose pose = world.layers[0].pose(frame);
                        const Colour wanted = ramp(pose.toLocal({double(x), double(y)}));
                        const double error = player.channel(0).at(x, y) - wanted[0] * 4096;
                        worst = std::max(worst, std::abs(error));
                        sum += error / (16 * 8 * 8);
                    }
                }
            }
            INFO(c.name << " speed " << speed.x << ", " << speed.y << ": worst " << worst
                        << ", bias " << sum);
            CHECK(worst <= c.worst);
            CHECK(std::abs(sum) < 0.5);
        }
    }
}

TEST_CASE("taa: a moving square leaves no ghost on what it uncovers", "[postfx][unit]") {
    for (const Point speed : {Point{1, 0}, Point{2.3, 1.1}, Point{7.5, -3}, Point{0.3, 0.2}}) {
        const auto pose = [=](int f) { return Pose{{40 + speed.x * f, 40 + speed.y * f}}; };
        World world{140, 90, false, {backdrop(), square(12, pose)}};
        world.layers[1].moves = true;
        const World other = repainted(world, 1, kGreen);
        Player a, b;
        for (int frame = 3; frame < 17; ++frame) {
            a.show(world, frame, {.reset = frame == 3});
            b.show(other, frame, {.reset = frame == 3});
            const Point centre = pose(frame).offset;
            INFO("speed " << speed.x << ", " << speed.y << " frame " << frame);
            CHECK(taa_runs::differences(a, b, [&](int x, int y) {
                      return std::max(std::abs(x - centre.x), std::abs(y - centre.y)) > 14;
                  }) == 0);
        }
    }
}

TEST_CASE("taa: nothing of a near thing stays on a far one that a moving camera uncovers",
          "[postfx][unit]") {
    for (const double ground : {0.25, 1.0, 1.37}) {
        const auto pose = [](int f) { return Pose{{30 + 2.6 * f, 38 + 0.3 * f}}; };
        World world{140, 80, true, {backdrop(), square(11, pose)}};
        world.layers[0].pose = [=](int f) { return Pose{{ground * f, 0}}; };
        const World other = repainted(world, 1, kGreen);
        Player a, b;
        for (int frame = 3; frame < 24; ++frame) {
            a.show(world, frame, {.reset = frame == 3});
            b.show(other, frame, {.reset = frame == 3});
            const Point centre = pose(frame).offset;
            INFO("ground " << ground << " frame " << frame);
            CHECK(taa_runs::differences(a, b, [&](int x, int y) {
                      return std::max(std::abs(x - centre.x), std::abs(y - centre.y)) > 13;
                  }) == 0);
        }
    }
}

TEST_CASE("taa: a square that starts to move leaves no ghost", "[postfx][unit]") {
    for (const Point speed : {Point{1, 0}, Point{2.3, 1.1}, Point{7.5, -3}, Point{0.3, 0.2}}) {
        const auto pose = [=](int f) {
            const int moves = std::max(f - 9, 0);
            return Pose{{40 + speed.x * moves, 40 + speed.y * moves}};
        };
        World world{140, 90, false, {backdrop(), square(12, pose)}};
        world.layers[1].moves = true;
        const World other = repainted(world, 1, kGreen);
        Player a, b;
        for (int frame = 0; frame < 20; ++frame) {
            a.show(world, frame);
            b.show(other, frame);
            const Point centre = pose(frame).offset;
            INFO("speed " << speed.x << ", " << speed.y << " frame " << frame);
            CHECK(taa_runs::differences(a, b, [&](int x, int y) {
                      return std::max(std::abs(x - centre.x), std::abs(y - centre.y)) > 14;
                  }) == 0);
        }
    }
}

TEST_CASE("taa: a camera that starts to move drags nothing along", "[postfx][unit]") {
    const auto pose = [](int f) { return Pose{{40 + 3.0 * std::max(f - 12, 0), 38}}; };
    World world{140, 80, false, {backdrop(), square(11, pose)}};
    world.layers[0].pose = [=](int f) { return Pose{{0.5 * std::max(f - 12, 0), 0}}; };
    World other = repainted(world, 1, kGreen);
    Player a, b;
    for (int frame = 0; frame < 24; ++frame) {
        world.camera_moves = other.camera_moves = frame > 12;
        a.show(world, frame);
        b.show(other, frame);
        const Point centre = pose(frame).offset;
        INFO("frame " << frame);
        CHECK(taa_runs::differences(a, b, [&](int x, int y) {
                  return std::max(std::abs(x - centre.x), std::abs(y - centre.y)) > 13;
              }) == 0);
    }
}

TEST_CASE("taa: what comes in from outside the picture starts as one frame", "[postfx][unit]") {
    Player player;
    const World world = panning(-6, 0);  // the right edge shows six new columns in each frame
    player.play(world, 0, 4);
    int wrong = 0, full = 0;
    for (int y = 0; y < world.height; ++y) {
        for (int x = 0; x < world.width; ++x) {
            const bool fresh = x > world.width - 6;  // a sample may reach over by half a pixel
            wrong += fresh && !plain(player, x, y) && !showsOneFrame(player, 4, x, y) ? 1 : 0;
            const int count = player.taa.sampleCount().at(x, y);
            wrong += count > std::min(5, 1 + (world.width - x) / 6) ? 1 : 0;
            full += count == 5 ? 1 : 0;
        }
    }
    CHECK(wrong == 0);
    CHECK(full > world.width * world.height / 3);
}

TEST_CASE("taa: pixels without history are one frame filtered in space", "[postfx][unit]") {
    const World world = panning(1.3, 0.4);
    Player player;
    player.play(world, 0, 9);
    const std::array<int, 2> jitter = synthetic::jitter(10);
    synthetic::render(world, 10, player.gbuffer);
    for (int y = 20; y < 50; ++y) {
        for (int x = 30; x < 70; ++x) {
            player.gbuffer.motion.at(x, y) = {kNoHistory, 0};
        }
    }
    player.taa.resolve(player.gbuffer, {.jitter_x_fx8 = jitter[0], .jitter_y_fx8 = jitter[1]}, {},
                       player.workers);
    int wrong = 0;
    for (int y = 21; y < 49; ++y) {
        for (int x = 31; x < 69; ++x) {
            wrong += plain(player, x, y) || showsOneFrame(player, 10, x, y) ? 0 : 1;
        }
    }
    CHECK(wrong == 0);
    CHECK_FALSE(showsOneFrame(player, 10, 80, 40));
}

TEST_CASE("taa: nothing older than a change of the light is used", "[postfx][unit]") {
    for (const double speed : {0.0, 0.6}) {
        World world{96, 64, speed != 0, {backdrop(), square(11, [=](int f) {
                                             return Pose{{30 + speed * f, 30}};
                                         })}};
        world.layers[0].pose = [=](int f) { return Pose{{0.5 * speed * f, 0}}; };
        const World dark = repainted(repainted(world, 0, {0.1, 0.1, 0.1}), 1, {0.2, 0.0, 0.1});
        Player a, b;
        for (int frame = 0; frame < 40; ++frame) {
            a.show(frame < 20 ? dark : world, frame, {.shading_changed = frame == 20});
            b.show(world, frame, {.shading_changed = frame == 20});
            if (frame >= 20) {
                INFO("speed " << speed << " frame " << frame);
                CHECK(taa_runs::everything(a.taa) == taa_runs::everything(b.taa));
            }
        }
    }
}

TEST_CASE("taa: a step of the light is followed at once when it is announced", "[postfx][unit]") {
    World world{64, 64, false, {backdrop()}};
    Player player;
    for (int frame = 0; frame < 20; ++frame) {
        const double light = frame < 10 ? 0.25 : 0.75;
        world.layers[0].colour = [=](Point) { return Colour{light, light, light}; };
        player.show(world, frame, {.shading_changed = frame == 10});
        CHECK(player.channel(0).at(30, 30) == (frame < 10 ? 1024 : 3072));
    }
}

TEST_CASE("taa: a surface that changes forgets, the others remember", "[postfx][unit]") {
    for (const double speed : {0.0, 0.6}) {
        World world{96, 64, speed != 0, {backdrop(), square(11, [=](int f) {
                                             return Pose{{30 + speed * f, 30}};
                                         })}};
        world.layers[0].pose = [=](int f) { return Pose{{speed * f, 0}}; };
        const World before = repainted(world, 1, kGreen);
        const uint64_t changed[] = {uint64_t{1} << 2};
        Player told, always, untold;
        for (int frame = 0; frame < 40; ++frame) {
            const TaaFrame facts{.changed_surfaces = frame == 20
                                                         ? std::span<const uint64_t>(changed)
                                                         : std::span<const uint64_t>()};
            told.show(frame < 20 ? before : world, frame, facts);
            always.show(world, frame, facts);
            untold.show(world, frame);
            const double centre = 30 + speed * frame;
            INFO("speed " << speed << " frame " << frame);
            if (frame >= 20) {
                CHECK(taa_runs::everything(told.taa) == taa_runs::everything(always.taa));
            }
            CHECK(taa_runs::differences(told, untold, [&](int x, int y) {
                      return std::max(std::abs(x - centre), std::abs(y - 30.0)) > 13.5;
                  }) == 0);
        }
    }
}

TEST_CASE("taa: a change while a surface is hidden and all is idle is not forgotten",
          "[postfx][unit]") {
    // Surface 2 is covered by 3 from frame 3 on, changes at 10, and shows again at 40.
    World world{80, 64, false, {backdrop(), square(9, [](int) { return Pose{{40, 30}}; })}};
    Layer cover = square(14, [](int f) { return Pose{{f < 3 || f >= 40 ? 4000.0 : 40.0, 30}}; });
    cover.surface = 3;
    cover.depth = 0.5;
    cover.moves = true;
    world.layers.push_back(cover);
    const World before = repainted(world, 1, kGreen);
    const uint64_t changed[] = {uint64_t{1} << 2};
    Player a, b;
    for (Player* player : {&a, &b}) {
        player->settings.sample_cap = 4;
        for (int frame = 0; frame < 46; ++frame) {
            const bool now = frame == 10;
            player->show(frame < 10 && player == &a ? before : world, frame,
                         {.changed_surfaces = now ? std::span<const uint64_t>(changed)
                                                  : std::span<const uint64_t>()});
        }
    }
    CHECK(taa_runs::everything(a.taa) == taa_runs::everything(b.taa));
}

TEST_CASE("taa: a wire that is gone is gone when its last raw frame is", "[postfx][unit]") {
    const World world = wires(0.7, true);
    World other = repainted(world, 1, kGreen), empty = world;
    empty.layers.pop_back();
    Player a, b;
    for (int frame = 0; frame < 30; ++frame) {
        a.show(frame < 20 ? world : empty, frame);
        b.show(frame < 20 ? other : empty, frame);
        const int left = taa_runs::differences(a, b, [](int, int) { return true; });
        INFO("frame " << frame << ": " << left << " pixels");
        CHECK((frame < 20 + a.settings.ring || left == 0));
    }
}
