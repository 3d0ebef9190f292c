#include <catch2/catch.hpp>
#include <set>

#include "demos/scenes/atlas.h"
#include "engine/timeline.h"

using namespace still;

TEST_CASE("atlas noise: every case samples its light and has a name that no other case has",
          "[scenes][unit]") {
    std::set<std::string> names;
    for (const AtlasCase& each : atlasCases()) {
        names.insert(each.name);
    }
    for (const AtlasCase& each : noiseCases()) {
        INFO(each.name);
        CHECK(names.insert(each.name).second);
        CHECK(each.failure.back() == '.');
        CHECK(findAtlasCase(each.name) == &each);
        const Scene scene = each.make();
        CHECK(scene.lights.sampled());
        CHECK(scene.cuts.empty());
        for (const AtlasSegment& segment : each.segments) {
            CHECK(segment.ssaa_samples == 4096);
            CHECK(segment.first <= segment.last);
        }
        // What stands still is looked at when it has had 32 frames; what moves does so meanwhile.
        const bool still = each.segments.front().name == "still";
        CHECK(still == isStill(scene, {}));
        CHECK((!still || each.segments.front().first == 31));
        CHECK((each.measure != "trail" || each.trail));
    }
    CHECK(noiseCases().size() >= 5);
}

TEST_CASE("atlas noise: the lamp goes out in the frame of the event", "[scenes][unit]") {
    const AtlasCase* found = findAtlasCase("switch-off");
    REQUIRE(found != nullptr);
    REQUIRE(found->event_frame.has_value());
    const int event = *found->event_frame;
    const Scene scene = found->make();
    CHECK(found->segments.front().first == event - 1);
    for (int frame = event - 2; frame < event + 3; ++frame) {
        CHECK(frameStateAt(scene, {}, frame, 320, 180).sampled_light_changed == (frame == event));
    }
}

TEST_CASE("atlas noise: trails are measured where the camera stands and something moves",
          "[scenes][unit]") {
    for (const AtlasCase& each : noiseCases()) {
        const Scene scene = each.make();
        const Changes changes = changesOf(scene, {});
        INFO(each.name);
        CHECK((!each.trail || (changes.objects && !changes.camera)));
    }
}
