// Cuts, lamps, materials and sizes that change.

#include <catch2/catch.hpp>

#include "tests/stability/atlas_run.h"
#include "tests/stability/bounds.h"

using namespace still::test;

namespace {

MeasuredScene measured(const EventBound& bound) {
    return MeasuredScene(quickCase(bound.scene), "raw,still");
}

}  // namespace

TEST_CASE("one frame after an event nothing of the past shows", "[stability]") {
    for (const EventBound& bound : eventBounds()) {
        INFO(bound.scene);
        const auto frames = measured(bound).at("event", "still").recovery_frames;
        REQUIRE(frames);
        CHECK(*frames <= 1);
    }
}

TEST_CASE("no frame around an event looks worse than a raw one, but for known misses",
          "[stability]") {
    for (const EventBound& bound : eventBounds()) {
        INFO(bound.scene);
        CHECK(measured(bound).flipAboveRaw("event") <= bound.flip_above_raw);
    }
}

TEST_CASE("the first frame after a cut, and of another size, is better than a raw one",
          "[stability]") {
    for (const EventBound& bound : eventBounds()) {
        if (bound.first_lead_db) {
            INFO(bound.scene);
            const int event = *atlasCase(bound.scene).event_frame;
            CHECK(measured(bound).frameLeadDb("event", event) >= *bound.first_lead_db);
        }
    }
}
