// What takes too long for every day: all presets, with full references.

#include <catch2/catch.hpp>

#include "tests/stability/atlas_run.h"
#include "tests/stability/bounds.h"

using namespace still::test;

TEST_CASE("no preset is ahead in the whole atlas, but for known misses", "[stability][slow]") {
    for (const StillBound& bound : stillBounds()) {
        INFO(bound.scene);
        CHECK(MeasuredScene(atlasCase(bound.scene), "").leadOfPublishedDb("still") >=
              bound.lead_db);
    }
    for (const MovingBound& bound : movingBounds()) {
        INFO(bound.scene);
        CHECK(MeasuredScene(atlasCase(bound.scene), "").leadOfPublishedDb("moving") >=
              bound.lead_db);
    }
}
