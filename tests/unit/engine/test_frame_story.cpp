// What a frame loop tells about the frame that it rendered last.

#include <catch2/catch.hpp>
#include <string>

#include "engine/frame_loop.h"
#include "engine/hash.h"
#include "tests/support/box_on_floor.h"

using namespace still;

namespace {

constexpr int kWidth = 97, kHeight = 70;

FrameSettings settingsOf(const char* preset) {
    FrameSettings settings;
    settings.width = kWidth;
    settings.height = kHeight;
    settings.policy = findPreset(preset)->policy;
    return settings;
}

/// The first pixel whose story's output is not that of the frame, as "x, y"; "" when all are.
std::string firstUntrue(const FrameLoop& loop, const FrameResult& frame) {
    for (int y = 0; y < frame.output.height; ++y) {
        for (int x = 0; x < frame.output.width; ++x) {
            const auto story = loop.story(x, y);
            const StoryColour shown{frame.linear.red.at(x, y), frame.linear.green.at(x, y),
                                    frame.linear.blue.at(x, y)};
            if (!story || story->output != shown) {
                return std::to_string(x) + ", " + std::to_string(y);
            }
        }
    }
    return "";
}

}  // namespace

TEST_CASE("frame_loop: stories have the frame's colours, also of sub-frames, jumps and new sizes",
          "[unit][frame_loop]") {
    const Scene scene = boxOnFloor(1, 30);
    Workers workers(1, Schedule::serial);
    for (const char* preset : {"still", "tiny", "variance", "fsr-like"}) {
        FrameSettings settings = settingsOf(preset);
        settings.policy.sharpness_q15 = 0;
        settings.planes.normal = true;
        for (const int subframes : {1, 3}) {
            settings.subframes = subframes;
            INFO(preset << ", " << subframes << " sub-frames");
            FrameLoop loop(scene, settings, workers);
            CHECK_FALSE(loop.story(0, 0));
            CHECK(loop.tileWork().empty());
            for (const int frame : {0, 1, 6, 29, 3, 40}) {
                const FrameResult result = loop.render(frame);
                INFO("frame " << frame);
                CHECK(firstUntrue(loop, result) == "");
                const auto story = loop.story(9, 9);
                CHECK(story->jitter_x_fx8 == result.jitter.x_fx8);
                CHECK(story->jitter_y_fx8 == result.jitter.y_fx8);
            }
            loop.resize(50, 66);
            CHECK(firstUntrue(loop, loop.render(41)) == "");
            CHECK(firstUntrue(loop, loop.render(42)) == "");
            CHECK_FALSE(loop.story(50, 0));
            CHECK_FALSE(loop.story(-1, 0));
            CHECK_FALSE(loop.story(0, 66));
        }
    }
}

TEST_CASE("frame_loop: a finished picture tells that it is finished", "[unit][frame_loop]") {
    const Scene scene = boxOnFloor(1000, 1001);
    Workers workers(1, Schedule::serial);
    FrameLoop loop(scene, settingsOf("still"), workers);
    for (const int frame : {63, 64, 90}) {
        const FrameResult result = loop.render(frame);
        CHECK(firstUntrue(loop, result) == "");
        for (int i = 0; i < kHeight; ++i) {
            const auto story = loop.story(i, i);
            CHECK(story->source == PixelSource::mean);
            CHECK(story->finished);
            CHECK(story->count == 64);
        }
        CHECK(loop.tileWork().size() == 4);
        for (const TileWork& work : loop.tileWork()) {
            CHECK(work.finished);
            CHECK(work.drawn == (frame == 63));
            CHECK(work.summed == (frame == 63));
        }
    }
}

TEST_CASE("frame_loop: asking for stories changes no frame", "[unit][frame_loop]") {
    const Scene scene = boxOnFloor(1, 12);
    Workers workers(2);
    for (const char* preset : {"still", "godot"}) {
        FrameLoop asked(scene, settingsOf(preset), workers);
        FrameLoop silent(scene, settingsOf(preset), workers);
        Image<uint16_t> red(kWidth, kHeight), green(kWidth, kHeight), blue(kWidth, kHeight);
        Image<Verdict> reason(kWidth, kHeight);
        Image<uint8_t> lost(kWidth, kHeight);
        for (int frame = 0; frame < 20; ++frame) {
            const uint64_t wanted = hashPlane(silent.render(frame).output);
            const FrameResult result = asked.render(frame);
            INFO(preset << " frame " << frame);
            CHECK(hashPlane(result.output) == wanted);
            CHECK(
                asked.storyPlane(StoryPlane::reprojected, {red.view(), green.view(), blue.view()}));
            CHECK(asked.rejections({reason.view(), lost.view()}));
            CHECK(hashPlane(result.output) == wanted);
        }
    }
}

TEST_CASE("frame_loop: without TAA there is no story, and all tiles are drawn",
          "[unit][frame_loop]") {
    const Scene scene = boxOnFloor(1, 12);
    Workers workers(1, Schedule::serial);
    FrameSettings settings = settingsOf("still");
    settings.anti_aliasing = AntiAliasing::none;
    FrameLoop loop(scene, settings, workers);
    loop.render(5);
    CHECK_FALSE(loop.story(10, 10));
    Image<uint16_t> plane(kWidth, kHeight);
    Image<Verdict> reason(kWidth, kHeight);
    Image<uint8_t> lost(kWidth, kHeight);
    CHECK_FALSE(loop.storyPlane(StoryPlane::history, {plane.view(), plane.view(), plane.view()}));
    CHECK_FALSE(loop.rejections({reason.view(), lost.view()}));
    CHECK(loop.tileWork().size() == 4);
    for (const TileWork& work : loop.tileWork()) {
        CHECK((work.drawn && work.resolved));
    }
}
