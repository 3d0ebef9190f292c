// Intermediates as pictures.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <map>
#include <vector>

#include "demos/inspect/pane.h"
#include "demos/inspect/views.h"
#include "postfx/metrics.h"
#include "tests/unit/inspect/session_tools.h"

using namespace still;
using namespace still::inspect;

namespace {

int distance(Rgb8 a, Rgb8 b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

int brightness(Rgb8 c) {
    return 2 * c.r + 5 * c.g + c.b;
}

template <class T>
bool samePlanes(const Image<T>& a, const Image<T>& b) {
    if (a.width() != b.width() || a.height() != b.height()) {
        return false;
    }
    for (int y = 0; y < a.height(); ++y) {
        for (int x = 0; x < a.width(); ++x) {
            if (!(a.at(x, y) == b.at(x, y))) {
                return false;
            }
        }
    }
    return true;
}

/// A session of one pane with a view.
struct Viewed {
    Workers workers{2};
    Session session;
    Viewed(const std::string& scene, const std::string& mode, View view)
        : session(sceneNamed(scene), testSettings(), workers) {
        session.pane(0) = {modeCalled(mode), view};
    }
    Rgb8 at(int x, int y) { return session.draw().image.at(x, y); }
};

}  // namespace

TEST_CASE("views: every view has a name of its own and can be drawn with every mode",
          "[unit][views]") {
    std::map<std::string_view, int> names;
    for (const ViewInfo& info : allViews()) {
        ++names[info.name];
        CHECK(viewNamed(info.name) == info.view);
        CHECK_FALSE(info.about.empty());
    }
    CHECK(names.size() == allViews().size());
    CHECK_FALSE(viewNamed("nonsense").has_value());
    Workers workers(2);
    for (const std::string& mode : modeNames()) {
        Session session(sceneNamed("zoo"), {.width = 70, .height = 66}, workers);
        session.pane(0).mode = modeCalled(mode);
        CHECK(nameOf(session.pane(0).mode) == mode);
        session.play(true);
        for (const ViewInfo& info : allViews()) {
            session.pane(0).view = info.view;
            CHECK(session.draw().changed);
        }
    }
    CHECK_FALSE(modeNamed("nonsense").has_value());
    CHECK_FALSE(modeNamed("ssaa:0").has_value());
    CHECK_FALSE(modeNamed("ssaa:4:denoise=off").has_value());
    CHECK(modeCalled("fast:denoise=off").denoise == Denoise::off);
    CHECK(nameOf(modeCalled("fast:denoise=off")) == "fast:denoise=off");
    CHECK_FALSE(modeCalled("fast:denoise=off") == modeCalled("fast"));
    Mode own = modeCalled("fast");
    own.policy.ring = 5;
    CHECK(nameOf(own) == "custom");
}

TEST_CASE("views: a pane's sample is the one that its frame loop resolved", "[unit][views]") {
    for (const std::string mode : {"still", "ema-consistent", "basic", "raw"}) {
        Workers workers(2);
        Film film;
        film.scene = sceneNamed("glass");
        for (const Mesh& mesh : film.scene.meshes) {
            film.windings.push_back(windingBits(mesh));
        }
        const FrameSettings base{.width = 90, .height = 70};
        Pane pane(film, base, modeCalled(mode), workers);
        FrameSettings settings = pane.settings();
        settings.camera = film.camera();
        settings.planes = {.normal = true, .motion = true};
        settings.fresh_gbuffer = true;
        FrameLoop loop(film.scene, settings, workers);
        for (int frame = 0; frame < 6; ++frame) {
            const CameraPose pose{.eye = {0.05 * frame, 1, 6 - 0.1 * frame}, .target = {0, 0.5, 0}};
            film.recording.frames.push_back(Rig(pose, 0.1, 100).entry(90.0 / 70));
            film.recording.frames.back().scene_frame = 2 * frame;
            pane.render();
            const GBuffer& expected = *loop.render(frame).gbuffer;
            const GBuffer& found = pane.sample();
            INFO(mode << ", frame " << frame);
            CHECK(samePlanes(found.red, expected.red));
            CHECK(samePlanes(found.depth, expected.depth));
            CHECK(samePlanes(found.id, expected.id));
            CHECK(samePlanes(found.normal, expected.normal));
            CHECK(samePlanes(found.motion, expected.motion));
        }
    }
}

TEST_CASE("views: sampled light is noisy, denoised it is nearer to what many samples show",
          "[unit][views]") {
    Workers workers(2);
    Session session(sceneNamed("cornell"), testSettings(), workers);
    const auto shown = [&](const std::string& mode, View view) {
        session.pane(0) = {modeCalled(mode), view};
        drawToRest(session, 40);
        return copyOf(session.draw().image);
    };
    const Image<Rgb8> many = shown("ssaa:256", View::picture);
    const auto distanceTo = [&](const Image<Rgb8>& picture) {
        return pixelError(picture.view(), many.view()).squared_sum;
    };
    const uint64_t noisy = distanceTo(shown("raw:denoise=off", View::picture));
    const uint64_t clean = distanceTo(shown("still", View::picture));
    CHECK(clean * 10 < noisy);
    const Image<Rgb8> light = shown("still", View::light);
    const Image<Rgb8> denoised = shown("still", View::denoised);
    CHECK(pixelError(light.view(), denoised.view()).squared_sum > 0);
    // The left wall is red, the light on it is not.
    const Rgb8 wall = shown("still", View::picture).at(35, 36), on_wall = denoised.at(35, 36);
    CHECK(wall.r > 3 * wall.g);
    CHECK(on_wall.g * 3 > on_wall.r);
    CHECK(on_wall.g > 30);
    CHECK(shown("raw:denoise=off", View::denoised).at(35, 36) == Rgb8{});
    session.setScene(sceneNamed("cubes"), false);
    CHECK(shown("still", View::light).at(35, 36) == Rgb8{});
}

TEST_CASE("views: ssaa:N of sampled light has the bytes of the frame loop", "[unit][views]") {
    Workers workers(2);
    for (const char* name : {"cornell", "contact"}) {
        const Scene scene = sceneNamed(name);
        Session session(scene, testSettings(), workers);
        session.pane(0).mode = modeCalled("ssaa:32");
        drawToRest(session, 64);
        const CameraFile recording = session.recording(0);
        FrameSettings settings = session.paneSettings(0);
        settings.camera.file = &recording;
        FrameLoop loop(scene, settings, workers);
        CHECK(session.hash(0) == hashPlane(loop.render(int(recording.frames.size()) - 1).output));
    }
}

TEST_CASE("views: nearer is never darker, and nothing is black", "[unit][views]") {
    Workers workers(2);
    GBuffer g;
    g.resize(40, 1, {});
    for (int x = 0; x < 40; ++x) {
        g.depth.at(x, 0) = x == 0 ? 0 : 0x3A000000u + uint32_t(x) * 0x00080000u;
    }
    Image<Rgb8> out(40, 1);
    paintDepth(g, out.view(), workers);
    CHECK(out.at(0, 0) == Rgb8{});
    for (int x = 1; x < 40; ++x) {
        CHECK(out.at(x, 0).g > (x == 1 ? 0 : out.at(x - 1, 0).g));
    }
    CHECK(out.at(39, 0) == Rgb8{255, 255, 255});
}

TEST_CASE("views: motion is a colour wheel around white", "[unit][views]") {
    CHECK(motionColour({}) == Rgb8{255, 255, 255});
    CHECK(motionColour({kNoHistory, 0}) == Rgb8{});
    // To the right: what is there now came from the left.
    CHECK(motionColour({-kMotionFull_fx8, 0}) == Rgb8{255, 0, 0});
    CHECK(motionColour({kMotionFull_fx8, 0}) == Rgb8{0, 255, 255});
    // Opposite directions are opposite colours, neighbours are alike, faster is fuller.
    constexpr int kRound = 360;
    const auto towards = [](int degrees, double speed) {
        const double angle = degrees * 3.14159265358979 / 180;
        return Motion{int16_t(std::lround(std::cos(angle) * speed)),
                      int16_t(std::lround(std::sin(angle) * speed))};
    };
    for (int degrees = 0; degrees < kRound; ++degrees) {
        const Rgb8 here = motionColour(towards(degrees, kMotionFull_fx8));
        const Rgb8 next = motionColour(towards(degrees + 1, kMotionFull_fx8));
        const Rgb8 opposite = motionColour(towards(degrees + 180, kMotionFull_fx8));
        CHECK(distance(here, next) <= 12);
        CHECK(std::abs(here.r + opposite.r - 255) <= 4);
        CHECK(std::abs(here.g + opposite.g - 255) <= 4);
        CHECK(std::abs(here.b + opposite.b - 255) <= 4);
        const Rgb8 slow = motionColour(towards(degrees, 100));
        CHECK(distance(slow, {255, 255, 255}) < distance(here, {255, 255, 255}));
    }
}

TEST_CASE("views: heat grows from black to white", "[unit][views]") {
    CHECK(heatColour(-1) == Rgb8{});
    CHECK(heatColour(0) == Rgb8{});
    CHECK(heatColour(255) == Rgb8{255, 255, 255});
    CHECK(heatColour(1000) == Rgb8{255, 255, 255});
    for (int value = 1; value < 256; ++value) {
        CHECK(brightness(heatColour(value)) >= brightness(heatColour(value - 1)));
        CHECK(distance(heatColour(value), heatColour(value - 1)) <= 8);
    }
}

TEST_CASE("views: reasons of rejection and kinds of work are told apart", "[unit][views]") {
    std::vector<Rgb8> reasons;
    for (int verdict = 0; verdict < kVerdicts; ++verdict) {
        reasons.push_back(verdictColour(Verdict(verdict)));
    }
    const std::vector<Rgb8> work{tileColour({}), tileColour({.drawn = true}),
                                 tileColour({.drawn = true, .recorded = true}),
                                 tileColour({.drawn = true, .recorded = true, .resolved = true})};
    for (const auto& colours : {reasons, work}) {
        for (size_t i = 0; i < colours.size(); ++i) {
            for (size_t j = 0; j < i; ++j) {
                CHECK(distance(colours[i], colours[j]) >= 50);
            }
        }
    }
}

TEST_CASE("views: rejection shows grey where all was taken, and the reason where it was not",
          "[unit][views]") {
    Workers workers(1);
    Image<Verdict> reason(2, 1);
    Image<uint8_t> lost(2, 1);
    Image<Rgb8> picture(2, 1), out(2, 1);
    picture.at(0, 0) = picture.at(1, 0) = {10, 200, 90};
    reason.at(1, 0) = Verdict::depth;
    lost.at(1, 0) = 255;
    paintRejection(reason.view(), lost.view(), picture.view(), out.view(), workers);
    CHECK(out.at(0, 0).r == out.at(0, 0).g);
    CHECK(out.at(0, 0).g == out.at(0, 0).b);
    CHECK(distance(out.at(1, 0), verdictColour(Verdict::depth)) < 20);
}

TEST_CASE("views: at rest no tile works and all samples are there", "[unit][views]") {
    Viewed tiles("triangle", "still", View::tiles);
    const auto reddish = [](Rgb8 c) { return c.r > c.g; };
    CHECK(reddish(tiles.at(1, 1)));
    drawToRest(tiles.session, 300);
    CHECK_FALSE(reddish(tiles.at(1, 1)));
    CHECK_FALSE(reddish(tiles.at(kTestWidth - 1, kTestHeight - 1)));
    Viewed counts("triangle", "still", View::count);
    CHECK(brightness(counts.at(60, 36)) < 8 * 100);
    drawToRest(counts.session, 300);
    CHECK(counts.at(60, 36) == Rgb8{255, 255, 255});
}

TEST_CASE("views: the error of the reference itself is nothing, that of one sample is not",
          "[unit][views]") {
    const auto litPixels = [](Viewed& viewed) {
        drawToRest(viewed.session, 400);
        const Drawn drawn = viewed.session.draw();
        int lit = 0;
        for (int y = 0; y < drawn.image.height; ++y) {
            for (int x = 0; x < drawn.image.width; ++x) {
                lit += drawn.image.at(x, y) == Rgb8{} ? 0 : 1;
            }
        }
        return lit;
    };
    Viewed same("cubes", "ssaa:256", View::error);
    CHECK(litPixels(same) == 0);
    CHECK(std::isinf(same.session.report(0).psnr_db.value()));
    Viewed raw("cubes", "raw", View::error);
    CHECK(litPixels(raw) > 100);
    Viewed taa("cubes", "still", View::error);
    litPixels(taa);
    CHECK(taa.session.report(0).psnr_db.value() > raw.session.report(0).psnr_db.value() + 10);
}

TEST_CASE("views: overdraw counts what lies behind", "[unit][views]") {
    Viewed one("triangle", "raw", View::overdraw);
    CHECK(one.at(60, 36) == heatColour(25));
    CHECK(one.at(0, 0) == Rgb8{});
}

TEST_CASE("views: a past that was carried here is near to the picture", "[unit][views]") {
    for (const std::string mode : {"still", "variance"}) {
        Workers workers(2);
        Session session(sceneNamed("checker"), testSettings(), workers);
        session.pane(0).mode = modeCalled(mode);
        for (int i = 0; i < 12; ++i) {
            session.steer().pan(0.01, 0);
            session.draw();
        }
        const Image<Rgb8> picture = copyOf(session.draw().image);
        const auto distanceTo = [&](View view) {
            session.pane(0).view = view;
            const Drawn drawn = session.draw();
            int64_t sum = 0;
            for (int y = 8; y < kTestHeight - 8; ++y) {
                for (int x = 8; x < kTestWidth - 8; ++x) {
                    sum += std::abs(drawn.image.at(x, y).g - session.picture(0).at(x, y).g);
                }
            }
            return sum;
        };
        session.steer().pan(0.05, 0);
        const int64_t kept = distanceTo(View::history);
        session.steer().pan(0.05, 0);
        const int64_t carried = distanceTo(View::reprojected);
        CHECK(carried * 2 < kept);
    }
}

TEST_CASE(
    "views: what comes in at the border was rejected as off-screen, and in the middle nothing was",
    "[unit][views]") {
    for (const std::string mode : {"still", "variance"}) {
        Workers workers(2);
        Session session(sceneNamed("checker"), testSettings(), workers);
        session.pane(0) = {modeCalled(mode), View::rejection};
        for (int i = 0; i < 10; ++i) {
            session.steer().look(0.002, 0);
            session.draw();
        }
        const auto cyan = [](Rgb8 c) { return c.g > c.r + 20 && c.b > c.r + 20; };
        session.steer().look(0.002, 0);
        const Drawn drawn = session.draw();
        int border = 0, inside = 0;
        for (int y = 4; y < kTestHeight - 4; ++y) {
            border += cyan(drawn.image.at(kTestWidth - 1, y)) ? 1 : 0;
            inside += cyan(drawn.image.at(kTestWidth / 2, y)) ? 1 : 0;
        }
        CHECK(border > kTestHeight / 2);
        CHECK(inside == 0);
    }
}
