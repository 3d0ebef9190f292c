// A session shows what a plain frame loop makes of its recording, and rests when nothing is new.

#include <catch2/catch.hpp>
#include <utility>

#include "engine/camera.h"
#include "engine/load.h"
#include "tests/support/data_path.h"
#include "tests/unit/inspect/session_tools.h"

using namespace still;
using namespace still::inspect;

namespace {

/// What a frame loop makes of the recording's last frame.
uint64_t renderedAgain(const Session& session, int pane, Workers& workers) {
    const CameraFile recording = session.recording(pane);
    FrameSettings settings = session.paneSettings(pane);
    settings.camera.file = &recording;
    FrameLoop loop(session.scene(), settings, workers);
    return hashPlane(loop.render(int(recording.frames.size()) - 1).output);
}

}  // namespace

TEST_CASE("session: a recording is rendered again with the same bytes", "[unit][session]") {
    for (const std::string scene : {"cubes", "glass", "pan"}) {
        Workers workers(2);
        Session session(sceneNamed(scene), testSettings(), workers);
        session.look().split = true;
        session.pane(0).mode = modeCalled("still");
        session.pane(1).mode = modeCalled("variance");
        session.play(true);
        for (int i = 0; i < 40; ++i) {
            switch (i) {
                case 5:
                    session.steer().orbit(0.02, 0.01);
                    break;
                case 9:
                    session.play(false);
                    break;
                case 14:
                    session.steer().dolly(0.8);
                    session.pane(1).mode = modeCalled("raw");
                    break;
                case 20:
                    session.pane(0).mode = modeCalled("fast");
                    session.step(1);
                    break;
                case 26:
                    session.scrub(3);
                    break;
                case 30:
                    session.setRenderScale(50);
                    break;
                case 34:
                    session.frameAll();
                    session.play(true);
                    break;
                default:
                    break;
            }
            session.draw();
            if (i % 3 == 2) {
                INFO(scene << ", draw " << i);
                CHECK(session.hash(0) == renderedAgain(session, 0, workers));
                CHECK(session.hash(1) == renderedAgain(session, 1, workers));
            }
        }
    }
}

TEST_CASE("session: a recording can be saved, loaded and rendered to the same bytes",
          "[unit][session]") {
    Workers workers(2);
    const TempFolder folder;
    Session session(sceneNamed("cubes"), testSettings(), workers);
    session.play(true);
    for (int i = 0; i < 9; ++i) {
        session.steer().orbit(0.013, 0.007);
        session.draw();
    }
    const CameraFile loaded =
        loadCameraFile(folder.write("seen.json", cameraFileText(session.recording(0)))).value();
    FrameSettings settings = session.paneSettings(0);
    settings.camera.file = &loaded;
    CHECK(loaded.width == settings.width);
    FrameLoop loop(session.scene(), settings, workers);
    CHECK(hashPlane(loop.render(int(loaded.frames.size()) - 1).output) == session.hash(0));
}

TEST_CASE("session: nothing changed, nothing done", "[unit][session]") {
    Workers workers(2);
    int clock = 0;
    SessionSettings settings = testSettings();
    settings.clock_ms = [&] { return double(++clock); };
    Session session(sceneNamed("triangle"), settings, workers);
    session.look().split = true;
    session.pane(1).mode = modeCalled("ssaa:16");
    const int draws = drawToRest(session, 200);
    CHECK(draws >= 64);
    CHECK(draws < 200);
    CHECK(session.report(0).at_rest);
    CHECK(session.report(1).at_rest);
    clock = 0;
    const uint64_t before = hashOf(session.draw());
    CHECK(clock == 0);
    session.look().divider = 0.25;
    const Drawn moved = session.draw();
    CHECK(moved.changed);
    CHECK(clock == 0);
    CHECK(hashOf(moved) != before);
    session.steer().pan(0.1, 0);
    CHECK(session.draw().changed);
    CHECK(clock > 0);
}

TEST_CASE("session: ssaa:N converges to the bytes of ssaa:N", "[unit][session]") {
    for (const int samples : {1, 7, 16}) {
        Workers workers(2);
        Session session(sceneNamed("glass"), testSettings(), workers);
        session.pane(0).mode = modeCalled("ssaa:" + std::to_string(samples));
        int last = 0;
        while (!session.report(0).at_rest) {
            session.draw();
            CHECK(session.report(0).samples > last);
            last = session.report(0).samples;
        }
        CHECK(last == samples);
        CHECK(session.hash(0) == renderedAgain(session, 0, workers));
    }
}

TEST_CASE("session: a recursive method rests when a period has changed nothing",
          "[unit][session]") {
    Workers workers(2);
    Session session(sceneNamed("triangle"), testSettings(), workers);
    session.pane(0).mode = modeCalled("basic");
    session.pane(0).mode.policy.jitter = JitterPattern::none;
    CHECK(drawToRest(session, 400) < 400);
    CHECK(session.report(0).at_rest);
}
