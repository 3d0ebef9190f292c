// Time, camera and size of a session.

#include <catch2/catch.hpp>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "engine/camera.h"
#include "tests/unit/inspect/session_tools.h"

using namespace still;
using namespace still::inspect;

namespace {

const CameraFileFrame& lastEntry(const CameraFile& recording) {
    return recording.frames.back();
}

/// The largest |x| and |y| that any vertex of frame 0 has in clip space.
glm::dvec2 extentSeen(const Scene& scene, const CameraFileFrame& entry) {
    glm::dvec2 extent(0);
    const FrameState state = frameStateAt(scene, {}, 0, 1, 1);
    for (const Instance& instance : state.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        const Affine& m = instance.transform;
        for (uint32_t i = 0; i < mesh.vertexCount(); ++i) {
            const glm::dvec4 world(m[0] * mesh.x[i] + m[1] * mesh.y[i] + m[2] * mesh.z[i] + m[3],
                                   m[4] * mesh.x[i] + m[5] * mesh.y[i] + m[6] * mesh.z[i] + m[7],
                                   m[8] * mesh.x[i] + m[9] * mesh.y[i] + m[10] * mesh.z[i] + m[11],
                                   1);
            const glm::dvec4 clip = entry.projection * entry.view * world;
            REQUIRE(clip.w > 0);
            extent = glm::max(extent, glm::abs(glm::dvec2(clip.x, clip.y) / clip.w));
        }
    }
    return extent;
}

}  // namespace

TEST_CASE("session: while time runs each picture is a frame on, and the last is followed by a cut",
          "[unit][session]") {
    Workers workers(2);
    Session session(sceneNamed("cubes"), testSettings(), workers);
    const int last = session.lastSceneFrame();
    REQUIRE(last > 3);
    session.draw();
    CHECK(session.sceneFrame() == 0);
    session.scrub(last - 2);
    session.draw();
    CHECK(lastEntry(session.recording(0)).cut);
    session.play(true);
    for (int frame = last - 1; frame <= last; ++frame) {
        session.draw();
        CHECK(session.sceneFrame() == frame);
        CHECK(lastEntry(session.recording(0)).scene_frame == frame);
        CHECK_FALSE(lastEntry(session.recording(0)).cut);
    }
    session.draw();
    CHECK(session.sceneFrame() == 0);
    CHECK(lastEntry(session.recording(0)).cut);
}

TEST_CASE("session: single steps have a past, jumps have none, and both stop time",
          "[unit][session]") {
    Workers workers(2);
    Session session(sceneNamed("cubes"), testSettings(), workers);
    session.draw();
    session.play(true);
    session.step(1);
    CHECK_FALSE(session.playing());
    session.draw();
    CHECK_FALSE(lastEntry(session.recording(0)).cut);
    session.step(-1);
    session.draw();
    CHECK_FALSE(lastEntry(session.recording(0)).cut);
    session.step(2);
    session.draw();
    CHECK(lastEntry(session.recording(0)).cut);
    session.scrub(1 << 20);
    CHECK(session.sceneFrame() == session.lastSceneFrame());
    session.step(-(1 << 20));
    CHECK(session.sceneFrame() == 0);
}

TEST_CASE("session: while time stands, samples go on being added", "[unit][session]") {
    Workers workers(2);
    Session session(sceneNamed("cubes"), testSettings(), workers);
    session.play(true);
    for (int i = 0; i < 5; ++i) {
        session.draw();
    }
    session.play(false);
    const int instant = session.sceneFrame();
    const int draws = drawToRest(session, 300);
    CHECK(draws >= 64);
    CHECK(draws < 300);
    CHECK(session.sceneFrame() == instant);
    // The finished picture is the mean of the pattern's samples: near to that of any 64 others.
    session.pane(0).mode = modeCalled("ssaa:64");
    const Image<Rgb8> finished = copyOf(session.picture(0));
    drawToRest(session, 300);
    int64_t difference = 0;
    for (int y = 0; y < kTestHeight; ++y) {
        for (int x = 0; x < kTestWidth; ++x) {
            difference += std::abs(finished.at(x, y).g - session.picture(0).at(x, y).g);
        }
    }
    CHECK(difference < kTestWidth * kTestHeight);  // less than 1 of 255 on average
}

TEST_CASE("session: the scene's camera is followed until it is steered, and after a reset",
          "[unit][session]") {
    Workers workers(2);
    Session session(sceneNamed("pan"), testSettings(), workers);
    const auto eyeAt = [&](int frame) { return poseAt(session.scene(), {}, frame).eye; };
    session.scrub(7);
    CHECK(session.rig().pose().eye == eyeAt(7));
    session.steer();
    CHECK_FALSE(session.followsScene());
    session.scrub(11);
    CHECK(session.rig().pose().eye == eyeAt(7));
    session.resetCamera();
    CHECK(session.followsScene());
    CHECK(session.rig().pose().eye == eyeAt(11));
    session.draw();
    // Over the scene's own cut, even in a single step.
    session.scrub(19);
    session.draw();
    session.step(1);
    session.draw();
    session.look().split = true;
    session.pane(1).mode = modeCalled("still");
    session.draw();
    CHECK(session.report(1).frames == 1);
}

TEST_CASE("session: all of the scene fills the picture, from any side and in parallel projection",
          "[unit][session]") {
    Workers workers(2);
    for (const bool orthographic : {false, true}) {
        Session session(sceneNamed("triangle"), testSettings(), workers);
        session.steer().setOrthographic(orthographic);
        for (const glm::dvec3& side : {glm::dvec3(0, 0, 1), glm::dvec3(1, 1, 1),
                                       glm::dvec3(-1, 0.5, 2), glm::dvec3(0, 1, 1)}) {
            session.lookFrom(side);
            session.draw();
            const CameraFileFrame entry = lastEntry(session.recording(0));
            CHECK(entry.cut);
            const glm::dvec2 extent = extentSeen(session.scene(), entry);
            CHECK(std::max(extent.x, extent.y) <= 0.9 + 1e-6);
            CHECK(std::max(extent.x, extent.y) > 0.88);
        }
        const glm::dvec3 eye = session.rig().pose().eye;
        session.frameAll();
        CHECK(glm::length(session.rig().pose().eye - eye) < 1e-6);
    }
}

TEST_CASE("session: another size begins anew and is that of the picture", "[unit][session]") {
    Workers workers(2);
    Session session(sceneNamed("cubes"), testSettings(), workers);
    session.draw();
    session.resize(97, 43);
    const Drawn drawn = session.draw();
    CHECK(drawn.image.width == 97);
    CHECK(drawn.image.height == 43);
    CHECK(session.report(0).frames == 1);
    session.setRenderScale(50);
    session.draw();
    CHECK(session.picture(0).width == 48);
    CHECK(session.picture(0).height == 21);
    CHECK(session.draw().image.width == 97);
    session.resize(1, 1);
    CHECK(session.draw().image.height == 1);
}

TEST_CASE("session: panes that upscale in time change their frames' size, and go on",
          "[unit][session]") {
    Workers workers(2);
    Session session(sceneNamed("cubes"), testSettings(), workers);
    session.pane(0).mode = modeCalled("quality");
    session.draw();
    session.draw();
    CHECK(session.renderScale() == 67);
    session.setRenderScale(50);
    session.draw();
    CHECK(session.renderScale() == 50);
    CHECK(session.picture(0).width == kTestWidth);
    CHECK(session.report(0).frames == 3);
    session.resetRenderScale();
    CHECK(session.renderScale() == 67);
    session.setRenderScale(40);
    session.pane(0).mode = modeCalled("performance");
    session.draw();
    CHECK(session.renderScale() == 50);
    // Beside one that does not, all begin anew at the smaller size.
    session.look().split = true;
    session.setRenderScale(50);
    session.draw();
    CHECK(session.picture(0).width == kTestWidth / 2);
    session.resetRenderScale();
    CHECK(session.renderScale() == 100);
}

TEST_CASE("session: modes that upscale have every view, at the window's size", "[unit][session]") {
    Workers workers(2);
    for (const char* scene : {"cubes", "cornell"}) {
        for (const char* mode : {"quality", "ultra", "bicubic"}) {
            Session session(sceneNamed(scene), testSettings(), workers);
            session.pane(0).mode = modeCalled(mode);
            session.look().overlays.tiles = session.look().overlays.arrows = true;
            session.pick(kTestWidth - 1, kTestHeight - 1);
            for (const ViewInfo& info : allViews()) {
                CAPTURE(scene, mode, info.name);
                session.pane(0).view = info.view;
                session.draw();
                CHECK(session.draw().image.width == kTestWidth);
            }
        }
    }
}

TEST_CASE("session: a picked pixel stays where it is when the panes' scale changes",
          "[unit][session]") {
    Workers workers(2);
    Session session(sceneNamed("cubes"), testSettings(), workers);
    for (int x = 0; x < kTestWidth; x += 13) {
        session.pick(x, kTestHeight - 1);
        session.setRenderScale(30);
        CHECK(std::abs(session.look().picked->x - x * 3 / 10) <= 1);
        CHECK(session.look().picked->x < session.renderWidth());
        CHECK(session.look().picked->y == session.renderHeight() - 1);
        session.setRenderScale(100);
        CHECK(std::abs(session.look().picked->x - x) <= 3);
    }
}

TEST_CASE("session: a scene's own matrices are followed, and their cuts let time stand",
          "[unit][session]") {
    Workers workers(2);
    Scene scene = sceneNamed("triangle");
    scene.camera_file = CameraFile{.width = 10, .height = 10};
    for (int frame = 0; frame < 4; ++frame) {
        const CameraPose pose{.eye = {0.1 * frame, 0.2, 4}};
        scene.camera_file->frames.push_back(cameraFrame(pose, 0.1, 100, 1));
        scene.camera_file->frames.back().cut = frame == 2;
    }
    Session session(std::move(scene), testSettings(), workers);
    for (int frame = 0; frame < 4; ++frame) {
        session.scrub(frame);
        session.draw();
        const CameraFileFrame entry = lastEntry(session.recording(0));
        CHECK(entry.view == session.scene().camera_file->frames[size_t(frame)].view);
        CHECK(entry.cut == (frame == 2 || frame == 0));
        CHECK(drawToRest(session, 300) < 300);
    }
}

TEST_CASE("session: a scene loaded again keeps camera and time when asked to", "[unit][session]") {
    Workers workers(2);
    Session session(sceneNamed("cubes"), testSettings(), workers);
    session.scrub(9);
    session.steer().orbit(0.1, 0);
    const glm::dvec3 eye = session.rig().pose().eye;
    session.draw();
    session.setScene(sceneNamed("cubes"), true);
    session.draw();
    CHECK(session.rig().pose().eye == eye);
    CHECK(session.sceneFrame() == 9);
    session.setScene(sceneNamed("triangle"), false);
    session.draw();
    CHECK(session.followsScene());
    CHECK(session.sceneFrame() == 0);
    CHECK(session.scene().name == sceneNamed("triangle").name);
}

TEST_CASE("session: an empty scene is drawn and steered", "[unit][session]") {
    Workers workers(1);
    Scene empty;
    empty.background = {0.5f, 0.5f, 0.5f};
    Session session(std::move(empty), testSettings(), workers);
    session.look().overlays = {true, true, true, true, true};
    session.frameAll();
    session.steer().orbit(0.1, 0.1);
    session.play(true);
    session.draw();
    session.pick(5, 5);
    CHECK(session.pickedStory()->surface.empty());
    CHECK_FALSE(session.surfaceAt(5, 5).has_value());
    CHECK(session.lastSceneFrame() == 0);
}
