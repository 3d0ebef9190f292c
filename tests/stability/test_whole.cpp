// What takes too long for every day: all presets with full references, and large pictures.

#include <catch2/catch.hpp>

#include "tests/stability/atlas_run.h"
#include "tests/stability/bounds.h"

using namespace still::test;

namespace {

/// `still` over raw where a moving camera has 960 × 540 pixels.
double largeLeadDb(const char* scene) {
    constexpr int kFrames = 4;
    still::AtlasCase atlas = quickCase(scene);
    still::AtlasSegment moving = atlas.segments.back();
    moving.last = moving.first + kFrames - 1;
    atlas.segments = {moving};
    return MeasuredScene(atlas, "raw,still", {960, 540}).leadDb("moving", "raw");
}

}  // namespace

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

TEST_CASE("a courtyard of 960 by 540 in motion is far better than a raw one", "[stability][slow]") {
    CHECK(largeLeadDb("courtyard-pan") >= 7);
    CHECK(largeLeadDb("courtyard-orbit") >= 7);
}
