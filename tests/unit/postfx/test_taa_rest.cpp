// Tiles that rest while others move, and what becomes of them when they wake.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "postfx/taa.h"
#include "taa_runs.h"

namespace {

using namespace still;
using synthetic::Pose;
using synthetic::World;
using taa_runs::backdrop;
using taa_runs::Player;
using taa_runs::square;

constexpr int kStart = 60;  ///< when the camera sets off

/// A square that never stops in the upper left, a second one that sets off to the right in frame
/// kStart; with `pans` the camera does instead.
World busyCorner(int frame, bool pans) {
    World world{270, 150, pans && frame >= kStart, {backdrop()}};
    const auto panned = [=](int f) { return pans ? std::max(f - kStart + 1, 0) : 0; };
    world.layers[0].pose = [=](int f) { return Pose{{0.73 * panned(f), 0.41 * panned(f)}}; };
    world.layers.push_back(square(7, [=](int f) {
        return Pose{{25 + 6 * std::sin(0.5 * f) + 0.73 * panned(f), 25 + 0.41 * panned(f)}};
    }));
    world.layers.push_back(square(14, [=](int f) {
        const int moved = pans ? 0 : std::max(f - kStart + 1, 0);
        return Pose{{176 + 1.3 * moved + 0.73 * panned(f), 100 + 0.41 * panned(f)}, 0.3};
    }));
    world.layers[2].surface = 3;
    world.layers[1].moves = world.layers[2].moves = true;
    return world;
}

int tilesWanted(Player& player) {
    const auto wanted = player.taa.plan(player.gbuffer.width(), player.gbuffer.height(),
                                        player.gbuffer.tiles, {}, player.settings);
    return int(std::count(wanted.begin(), wanted.end(), 1));
}

}  // namespace

TEST_CASE("taa: tiles away from what moves need no samples once they are finished",
          "[postfx][unit]") {
    Player player;
    int least = 15;
    for (int frame = 0; frame < kStart + 30; ++frame) {
        player.show(busyCorner(frame, false), frame);
        least = std::min(least, frame < 70 ? 15 : tilesWanted(player));
        CHECK(tilesWanted(player) >= 1);
    }
    CHECK(least <= 8);
}

TEST_CASE("taa: tiles that wake up look as if they had never rested", "[postfx][unit]") {
    for (const bool pans : {true, false}) {
        Player rested, young;
        double rested_error = 0, young_error = 0;
        for (int frame = 0; frame < kStart + 10; ++frame) {
            rested.show(busyCorner(frame, pans), frame);
            if (frame < kStart - 12) {
                continue;
            }
            // Full ring, but no time to rest.
            young.show(busyCorner(frame, pans), frame, {.reset = frame == kStart - 12});
            if (frame < kStart) {
                continue;
            }
            const auto wanted = synthetic::reference(busyCorner(frame, pans), frame, 8);
            const auto errorOf = [&](const Player& player) {
                return std::pow(10, -player.error(wanted) / 10);
            };
            rested_error += errorOf(rested);
            if (pans) {
                young_error += errorOf(young);
                INFO("frame " << frame);
                CHECK(errorOf(rested) < 1.3 * errorOf(young));
            }
        }
        if (pans) {
            CHECK(rested_error < 1.08 * young_error);
        } else {
            CHECK(-10 * std::log10(rested_error / 10) > 36);
        }
    }
}

TEST_CASE("taa: every SIMD target resolves tiles that rest apart as the scalar twin does",
          "[postfx][unit]") {
    for (const bool pans : {true, false}) {
        std::vector<Player> players(availableSimdTargets().size());
        for (size_t i = 0; i < players.size(); ++i) {
            players[i].settings.simd = availableSimdTargets()[i];
        }
        for (int frame = 0; frame < kStart + 12; ++frame) {
            std::vector<uint16_t> expected;
            for (Player& player : players) {
                player.show(busyCorner(frame, pans), frame);
                const std::vector<uint16_t> found = taa_runs::everything(player.taa);
                expected = expected.empty() ? found : expected;
                INFO("frame " << frame << " with " << name(player.settings.simd));
                REQUIRE(found == expected);
            }
        }
    }
}
