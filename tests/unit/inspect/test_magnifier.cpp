// Pixels as squares.

#include <catch2/catch.hpp>

#include <algorithm>

#include "demos/inspect/magnifier.h"
#include "demos/inspect/pane.h"
#include "tests/unit/inspect/session_tools.h"

using namespace still;
using namespace still::inspect;

namespace {

Image<Rgb8> colourful(int width, int height) {
    Image<Rgb8> picture(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            picture.at(x, y) = {uint8_t(x), uint8_t(y), uint8_t(x * 7 + y * 13)};
        }
    }
    return picture;
}

}  // namespace

TEST_CASE("magnifier: each pixel is a square of its own colour around the middle",
          "[unit][magnifier]") {
    const Image<Rgb8> picture = colourful(200, 160);
    for (const int factor : {4, 8, 16}) {
        Image<Rgb8> out(200, 160);
        const Magnifier magnifier{
            .on = true, .x = 100, .y = 80, .factor = factor, .grid = false, .jitter = false};
        const LensSource source{.picture = picture.view(), .middle = {100, 80}};
        drawMagnifier(magnifier, std::span(&source, 1), out.view());
        const int pixels = lensPixels(factor, 200, 160);
        CHECK(pixels % 2 == 1);
        const int left = 100 - pixels * factor / 2, top = 80 - pixels * factor / 2;
        for (int row = 0; row < pixels; ++row) {
            for (int column = 0; column < pixels; ++column) {
                const Rgb8 expected = picture.at(100 - pixels / 2 + column, 80 - pixels / 2 + row);
                CHECK(out.at(left + column * factor + factor / 2,
                             top + row * factor + factor / 2) == expected);
            }
        }
        CHECK(out.at(left - 3, top) == Rgb8{});
    }
}

TEST_CASE("magnifier: stays within the window and shows grey beyond the picture",
          "[unit][magnifier]") {
    const Image<Rgb8> picture = colourful(60, 50);
    for (const int x : {-5, 0, 59, 200}) {
        for (const int y : {-9, 0, 49, 100}) {
            Image<Rgb8> out(60, 50);
            const LensSource source{.picture = picture.view(), .middle = {x, y}};
            const LensSource two[2] = {source, source};
            drawMagnifier({.on = true, .x = x, .y = y, .factor = 16}, two, out.view());
            drawMagnifier({.on = true, .x = x, .y = y, .factor = 4}, std::span(two, 1), out.view());
        }
    }
    Image<Rgb8> out(60, 50);
    const LensSource source{.picture = picture.view(), .middle = {0, 0}};
    drawMagnifier({.on = true, .factor = 4, .grid = false, .jitter = false}, std::span(&source, 1),
                  out.view());
    CHECK(out.at(2, 2) == Rgb8{40, 40, 40});
}

TEST_CASE("magnifier: the pattern's dots and this frame's lie where the samples do",
          "[unit][magnifier]") {
    Image<Rgb8> picture(200, 200);  // black, so dots are white
    Image<Rgb8> out(200, 200);
    const std::vector<SampleOffset> pattern{{-128, -128}, {0, 0}, {64, -64}};
    const LensSource source{
        .picture = picture.view(), .middle = {100, 100}, .pattern = pattern, .now = {64, -64}};
    drawMagnifier({.on = true, .x = 100, .y = 100, .factor = 8, .grid = false},
                  std::span(&source, 1), out.view());
    const int side = lensPixels(8, 200, 200) * 8, inset = side / 3;
    const int x0 = 100 - side / 2, y0 = 100 - side / 2 + side - inset;
    const auto at = [&](int x_fx8, int y_fx8) {
        return out.at(x0 + (x_fx8 + 128) * inset / 256, y0 + (y_fx8 + 128) * inset / 256);
    };
    CHECK(at(0, 0) == Rgb8{255, 255, 255});
    CHECK(at(64, -64) == Rgb8{255, 0, 0});
    CHECK(at(-64, 64) == Rgb8{});
}

TEST_CASE("magnifier: this frame's sample is one of the pattern's, however the camera moves",
          "[unit][magnifier]") {
    Workers workers(2);
    Film film;
    film.scene = sceneNamed("cubes");
    for (const Mesh& mesh : film.scene.meshes) {
        film.windings.push_back(windingBits(mesh));
    }
    for (const std::string mode : {"still", "tiny", "variance", "raw", "ssaa:16"}) {
        film.recording.frames.clear();
        Pane pane(film, {.width = 60, .height = 40}, modeCalled(mode), workers);
        for (int frame = 0; frame < 20; ++frame) {
            const CameraPose pose{.eye = {0.03 * frame * frame, 1, 6}, .target = {0, 0, 0}};
            film.recording.frames.push_back(Rig(pose, 0.1, 100).entry(1.5));
            film.recording.frames.back().scene_frame = 0;
            pane.render();
            const auto pattern = pane.pattern();
            const SampleOffset now = pane.jitter();
            const auto same = [&](const SampleOffset& offset) {
                return offset.x_fx8 == now.x_fx8 && offset.y_fx8 == now.y_fx8;
            };
            INFO(mode << ", frame " << frame);
            if (mode != "ssaa:16") {
                CHECK(std::any_of(pattern.begin(), pattern.end(), same));
            }
            const size_t expected = mode == "raw"       ? 1
                                    : mode == "ssaa:16" ? 16
                                                        : jitterPeriod(pane.mode().policy.jitter);
            CHECK(pattern.size() == expected);
        }
    }
}

TEST_CASE("magnifier: works while nothing else changes, and costs no frame", "[unit][magnifier]") {
    Workers workers(2);
    Session session(sceneNamed("cubes"), testSettings(), workers);
    session.look().split = true;
    drawToRest(session, 200);
    const size_t frames = session.recording(0).frames.size();
    const uint64_t before = hashOf(session.draw());
    session.look().magnifier = {.on = true, .x = 40, .y = 30, .factor = 4};
    CHECK(hashOf(session.draw()) != before);
    session.look().magnifier.x = 80;
    CHECK(session.draw().changed);
    CHECK_FALSE(session.draw().changed);
    session.look().magnifier.on = false;
    CHECK(hashOf(session.draw()) == before);
    CHECK(session.recording(0).frames.size() == frames);
}
