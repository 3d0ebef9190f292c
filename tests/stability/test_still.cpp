// Pictures that stand, and the first frame of any.

#include <catch2/catch.hpp>
#include <string>

#include "tests/stability/atlas_run.h"
#include "tests/stability/bounds.h"

using namespace still::test;

namespace {

MeasuredScene measured(const StillBound& bound) {
    return MeasuredScene(quickCase(bound.scene), std::string("raw,still,") + bound.rival);
}

}  // namespace

TEST_CASE("still pictures are far ahead of every published method", "[stability]") {
    for (const StillBound& bound : stillBounds()) {
        INFO(bound.scene << " against " << bound.rival);
        CHECK(measured(bound).leadDb("still", bound.rival) >= bound.lead_db);
    }
}

TEST_CASE("still pictures do not flicker, and no frame of them looks worse than a raw one",
          "[stability]") {
    for (const StillBound& bound : stillBounds()) {
        INFO(bound.scene);
        const MeasuredScene scene = measured(bound);
        REQUIRE(scene.at("still", "still").flicker);
        CHECK(*scene.at("still", "still").flicker <= bound.flicker);
        CHECK(scene.flipAboveRaw("still") == 0);
    }
}

TEST_CASE("the first frame of all is better than a raw one", "[stability]") {
    for (const StillBound& bound : stillBounds()) {
        INFO(bound.scene);
        CHECK(measured(bound).leadDb("first", "raw") >= bound.first_lead_db);
    }
    CHECK(MeasuredScene(quickCase("courtyard-pan"), "raw,still,variance").leadDb("first", "raw") >=
          3);
}
