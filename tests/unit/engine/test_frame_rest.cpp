// What a frame need not do when nothing in it is new.

#include <catch2/catch.hpp>
#include <utility>

#include "engine/frame_loop.h"
#include "engine/hash.h"
#include "tests/support/box_on_floor.h"

using namespace still;

namespace {

constexpr int kFinished = 64;  ///< samples, and so the first frame at rest

FrameSettings settingsOf(int width, int height) {
    FrameSettings settings;
    settings.width = width;
    settings.height = height;
    return settings;
}

}  // namespace

TEST_CASE("frame_loop: a frozen scene does no work", "[unit][frame_loop]") {
    const Scene scene = boxOnFloor(1000, 1001);
    FrameSettings settings = settingsOf(97, 70);
    int stages = 0;
    settings.clock_ms = [&stages] { return double(++stages); };
    Workers workers(1, Schedule::serial);
    FrameLoop loop(scene, settings, workers);
    const uint64_t finished = hashPlane(loop.render(kFinished - 1).output);
    CHECK(loop.counters().tiles == 4);
    for (int frame = kFinished; frame < kFinished + 80; ++frame) {
        stages = 0;
        const FrameResult result = loop.render(frame);
        INFO("frame " << frame);
        CHECK(loop.counters().triangles == 0);
        CHECK(loop.counters().tiles == 0);
        CHECK(stages == 0);
        CHECK(result.converged);
        REQUIRE(hashPlane(result.output) == finished);
    }
}

TEST_CASE("frame_loop: a frozen scene wakes for a moving object, a light, a material and a camera",
          "[unit][frame_loop]") {
    constexpr int event = kFinished + 10;
    const auto stepping = [](Track<double>& track) { track.keys = {{event - 1, 1}, {event, 0.5}}; };
    Scene moves = boxOnFloor(event, event + 1), lit = boxOnFloor(1000, 1001), flies = lit;
    Scene painted = lit, cut = lit;
    stepping(lit.lights.sun_intensity);
    flies.camera.eye.keys = {{event - 1, {1, 3, 5}}, {event, {1.1, 3, 5}}};
    painted.materials.push_back(painted.materials[0]);
    painted.materials[2].diffuse = {0.1f, 0.8f, 0.1f};
    painted.material_tracks = {{.material = 0, .offset = {}, .swaps = {{event, 2}}}};
    cut.cuts = {event};
    for (const Scene* scene : {&moves, &lit, &flies, &painted, &cut}) {
        Workers workers(1, Schedule::serial);
        FrameLoop loop(*scene, settingsOf(97, 70), workers);
        const uint64_t finished = hashPlane(loop.render(event - 1).output);
        CHECK(loop.counters().tiles == 0);
        const FrameResult woken = loop.render(event);
        CHECK(loop.counters().tiles > 0);
        CHECK_FALSE(woken.converged);
        CHECK(hashPlane(woken.output) != finished);
    }
}

TEST_CASE("frame_loop: only tiles in which something is new are drawn, and nobody sees it",
          "[unit][frame_loop]") {
    const Scene scene = boxOnFloor(kFinished + 6, kFinished + 9);
    FrameSettings settings = settingsOf(400, 280);
    Workers workers(1, Schedule::serial);
    FrameLoop lazy(scene, settings, workers);
    settings.fresh_gbuffer = true;
    FrameLoop eager(scene, settings, workers);
    constexpr uint64_t kTiles = 7 * 5;
    uint64_t last = 0;
    int frames_in_parts = 0;
    for (int frame = 0; frame < kFinished + 90; ++frame) {
        const FrameResult seen = eager.render(frame);
        INFO("frame " << frame);
        REQUIRE(hashPlane(lazy.render(frame).output) == hashPlane(seen.output));
        const uint64_t sample = hashPlane(std::as_const(seen.gbuffer->red).view());
        CHECK(sample != last);
        CHECK(eager.counters().tiles >= kTiles);
        CHECK(lazy.counters().tiles <= kTiles);
        frames_in_parts += lazy.counters().tiles > 0 && lazy.counters().tiles < kTiles ? 1 : 0;
        last = sample;
    }
    CHECK(frames_in_parts > 30);
    CHECK(lazy.counters().tiles == 0);
}

TEST_CASE("frame_loop: a late start finds the tiles at rest that a full run has there",
          "[unit][frame_loop]") {
    Scene scene = boxOnFloor(50, 110);
    scene.camera.eye.keys = {{100, {1, 3, 5}}, {130, {2, 3, 5}}};
    Workers workers(1, Schedule::serial);
    FrameLoop full(scene, settingsOf(400, 280), workers);
    int frames_in_parts = 0;
    for (int frame = 0; frame < 112; ++frame) {
        const uint64_t expected = hashPlane(full.render(frame).output);
        frames_in_parts += full.counters().tiles < 7 * 5 ? 1 : 0;
        if (frame == 90 || frame == 101 || frame == 104 || frame == 111) {
            FrameLoop late(scene, settingsOf(400, 280), workers);
            INFO("frame " << frame);
            CHECK(hashPlane(late.render(frame).output) == expected);
        }
    }
    CHECK(frames_in_parts > 20);
}

TEST_CASE("frame_loop: frames that nobody looks at leave no trace", "[unit][frame_loop]") {
    // Replayed frames and sub-frames are not looked at.
    const Scene scene = boxOnFloor(4, 12);
    Workers workers(1, Schedule::serial);
    for (const int ring : {2, 8}) {
        for (const int subframes : {1, 3, 20}) {
            FrameSettings settings = settingsOf(97, 70);
            settings.subframes = subframes;
            settings.policy.ring = ring;
            FrameLoop seen(scene, settings, workers);
            for (int frame = 0; frame < 16; ++frame) {
                const uint64_t expected = hashPlane(seen.render(frame).output);
                if (frame % 5 == 3) {
                    FrameLoop unseen(scene, settings, workers);
                    INFO("frame " << frame << ", " << subframes << " sub-frames, ring " << ring);
                    CHECK(hashPlane(unseen.render(frame).output) == expected);
                }
            }
        }
    }
}
