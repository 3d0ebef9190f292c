// What a picked pixel tells.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>

#include "tests/unit/inspect/session_tools.h"

using namespace still;
using namespace still::inspect;

namespace {

std::string textOf(const std::vector<StoryLine>& lines) {
    std::string text;
    for (const StoryLine& line : lines) {
        text += line.text + "\n";
    }
    return text;
}

bool holds(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("story: the picked pixel is the one under the window's, at any scale", "[unit][story]") {
    Workers workers(2);
    Session session(sceneNamed("cubes"), testSettings(), workers);
    session.pane(0).mode = modeCalled("raw");
    for (const int percent : {100, 50, 30}) {
        session.setRenderScale(percent);
        session.draw();
        for (int x = 0; x < kTestWidth; x += 7) {
            for (int y = 0; y < kTestHeight; y += 5) {
                session.pick(x, y);
                const PickedPixel pixel = session.look().picked.value();
                const auto story = session.pickedStory().value();
                CHECK(story.output == session.picture(0).at(pixel.x, pixel.y));
                session.look().picked.reset();
                CHECK(session.draw().image.at(x, y) == story.output);
            }
        }
        session.pick(-10, 1000);
        CHECK(session.look().picked == PickedPixel{0, 0, session.renderHeight() - 1});
    }
    session.look().split = true;
    session.look().divider = 0.25;
    session.draw();
    CHECK(session.paneAt(kTestWidth / 4 - 1) == 0);
    CHECK(session.paneAt(kTestWidth / 4) == 1);
}

TEST_CASE("story: tells the output's bits, the surface and every tap's verdict", "[unit][story]") {
    Workers workers(2);
    for (const std::string mode : {"still", "variance", "filament"}) {
        Session session(sceneNamed("cubes"), testSettings(), workers);
        session.pane(0).mode = modeCalled(mode);
        session.play(true);
        for (int i = 0; i < 12; ++i) {
            session.draw();
        }
        for (int y = 3; y < kTestHeight; y += 9) {
            for (int x = 3; x < kTestWidth; x += 9) {
                session.pick(x, y);
                const PickedStory story = session.pickedStory().value();
                const std::string text = textOf(storyLines(story));
                char bits[32];
                std::snprintf(bits, sizeof bits, "#%02x%02x%02x", story.output.r, story.output.g,
                              story.output.b);
                CHECK(holds(text, bits));
                CHECK(holds(text, "pixel"));
                REQUIRE(story.taa.has_value());
                CHECK(shownColour(story.taa->output, Tone::linear) == story.output);
                for (const PixelTap& tap : story.taa->taps) {
                    CHECK(holds(text, std::string(verdictName(tap.verdict))));
                }
                const auto point = session.surfaceAt(x, y);
                if (point && !story.surface.empty() && point->surface == std::stoi(story.surface)) {
                    CHECK(holds(text, session.scene().objects[size_t(point->object)].name));
                }
            }
        }
    }
}

TEST_CASE("story: modes without a past tell what they have", "[unit][story]") {
    Workers workers(2);
    for (const std::string mode : {"raw", "fxaa", "ssaa:8"}) {
        Session session(sceneNamed("triangle"), testSettings(), workers);
        session.pane(0).mode = modeCalled(mode);
        CHECK_FALSE(session.pickedStory().has_value());
        session.draw();
        CHECK_FALSE(session.pickedStory().has_value());
        session.pick(60, 36);
        const PickedStory story = session.pickedStory().value();
        CHECK_FALSE(story.taa.has_value());
        CHECK(holds(textOf(storyLines(story)), mode));
        CHECK(holds(textOf(storyLines(story)), mode == "ssaa:8" ? "4 of 8 samples" : "sample at"));
        CHECK(storyPlot(story, 64).width() == 128);
    }
}

TEST_CASE("story: the plot holds box, samples and result inside its frame", "[unit][story]") {
    Workers workers(2);
    for (const std::string mode : {"still", "variance", "inside"}) {
        Session session(sceneNamed("cubes"), testSettings(), workers);
        session.pane(0).mode = modeCalled(mode);
        session.play(true);
        for (int i = 0; i < 8; ++i) {
            session.draw();
        }
        session.pick(kTestWidth / 2, kTestHeight / 2);
        for (const int side : {32, 200}) {
            const Image<Rgb8> plot = storyPlot(session.pickedStory().value(), side);
            REQUIRE(plot.height() == side);
            const Rgb8 paper = plot.at(1, 1);
            int inked = 0;
            for (int y = 0; y < side; ++y) {
                CHECK(plot.at(0, y) == paper);
                CHECK(plot.at(2 * side - 1, y) == paper);
                for (int x = 0; x < side; ++x) {
                    inked += plot.at(x, y) == paper ? 0 : 1;
                }
            }
            CHECK(inked > 20);
        }
    }
}

TEST_CASE("story: working colours look like the light they stand for", "[unit][story]") {
    for (const int level : {0, 100, 2048, 4096, 9000}) {
        const StoryColour linear{level, level / 2, level / 3};
        StoryColour toned{};
        for (size_t c = 0; c < 3; ++c) {  // c / (1 + max), fx15
            toned[c] = int(double(linear[c]) / (4096.0 + level) * 32768 + 0.5);
        }
        const Rgb8 a = shownColour(linear, Tone::linear), b = shownColour(toned, Tone::reinhard);
        CHECK(std::abs(a.r - b.r) <= 1);
        CHECK(std::abs(a.g - b.g) <= 1);
        CHECK(std::abs(a.b - b.b) <= 1);
    }
}

TEST_CASE("story: a surface's place is seen in its pixel", "[unit][story]") {
    Workers workers(2);
    for (const bool orthographic : {false, true}) {
        Session session(sceneNamed("cubes"), testSettings(), workers);
        session.steer().setOrthographic(orthographic);
        session.draw();
        const CameraFileFrame entry = session.recording(0).frames.back();
        int found = 0;
        for (int y = 2; y < kTestHeight; y += 11) {
            for (int x = 2; x < kTestWidth; x += 11) {
                if (const auto point = session.surfaceAt(x, y)) {
                    const glm::dvec4 clip =
                        entry.projection * entry.view * glm::dvec4(point->position, 1);
                    CHECK((clip.x / clip.w * 0.5 + 0.5) * kTestWidth ==
                          Approx(x + 0.5).margin(1e-3));
                    CHECK((0.5 - clip.y / clip.w * 0.5) * kTestHeight ==
                          Approx(y + 0.5).margin(1e-3));
                    ++found;
                }
            }
        }
        CHECK(found > 10);
    }
}
