// Lines over the picture.

#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <utility>
#include <vector>

#include "demos/inspect/canvas.h"
#include "demos/inspect/lines.h"
#include "tests/unit/inspect/session_tools.h"

using namespace still;
using namespace still::inspect;

namespace {

/// Pixels in which two pictures differ.
std::vector<std::pair<int, int>> changedPixels(const Image<Rgb8>& a, ImageView<const Rgb8> b) {
    std::vector<std::pair<int, int>> changed;
    for (int y = 0; y < a.height(); ++y) {
        for (int x = 0; x < a.width(); ++x) {
            if (!(a.at(x, y) == b.at(x, y))) {
                changed.emplace_back(x, y);
            }
        }
    }
    return changed;
}

bool rowByRow(const std::pair<int, int>& a, const std::pair<int, int>& b) {
    return std::pair(a.second, a.first) < std::pair(b.second, b.first);
}

/// What an overlay changes of the picture that is shown.
std::vector<std::pair<int, int>> drawnBy(Session& session, const Overlays& overlays) {
    session.look().overlays = {};
    const Image<Rgb8> without = copyOf(session.draw().image);
    session.look().overlays = overlays;
    return changedPixels(without, session.draw().image);
}

}  // namespace

TEST_CASE("overlay: lines cover as many pixels as they are long, at any slant", "[unit][overlay]") {
    Workers workers(2);
    for (int degrees = 0; degrees < 360; degrees += 7) {
        Image<Rgb8> out(200, 200);
        const double angle = degrees * 3.14159265358979 / 180;
        Segment line{.x0 = 100, .y0 = 100, .colour = {255, 255, 255}};
        line.x1 = float(100 + 80 * std::cos(angle));
        line.y1 = float(100 + 80 * std::sin(angle));
        drawSegments(std::vector{line}, nullptr, out.view(), workers);
        int64_t sum = 0;
        for (int y = 0; y < 200; ++y) {
            for (int x = 0; x < 200; ++x) {
                const double along =
                    (x + 0.5 - 100) * std::cos(angle) + (y + 0.5 - 100) * std::sin(angle);
                const double across =
                    (y + 0.5 - 100) * std::cos(angle) - (x + 0.5 - 100) * std::sin(angle);
                if (out.at(x, y).g != 0) {
                    CHECK(std::abs(across) < 1.1);
                    CHECK(along > -1);
                    CHECK(along < 81);
                }
                sum += out.at(x, y).g;
            }
        }
        const double longer = std::max(std::abs(std::cos(angle)), std::abs(std::sin(angle)));
        CHECK(std::abs(double(sum) / 255 - 80 * longer) < 3);
    }
}

TEST_CASE("overlay: the same lines are drawn by any number of threads", "[unit][overlay]") {
    std::vector<uint64_t> hashes;
    for (const int threads : {1, 2, 5}) {
        Workers workers(threads);
        Session session(sceneNamed("zoo"), {.width = 200, .height = 150}, workers);
        session.look().overlays = {true, true, true, true, true};
        session.play(true);
        for (int i = 0; i < 3; ++i) {
            session.draw();
        }
        hashes.push_back(hashOf(session.draw()));
    }
    CHECK(hashes[0] == hashes[1]);
    CHECK(hashes[0] == hashes[2]);
}

TEST_CASE("overlay: lines do not move with the jitter", "[unit][overlay]") {
    Workers workers(2);
    for (const Overlays overlays : {Overlays{.grid = true}, Overlays{.axes = true},
                                    Overlays{.edges = true}, Overlays{.tiles = true}}) {
        Session plain(sceneNamed("cubes"), testSettings(), workers);
        Session drawn_over(sceneNamed("cubes"), testSettings(), workers);
        drawn_over.look().overlays = overlays;
        std::vector<std::pair<int, int>> first;
        for (int i = 0; i < 8; ++i) {
            const Image<Rgb8> picture = copyOf(plain.draw().image);
            const auto changed = changedPixels(picture, drawn_over.draw().image);
            CHECK_FALSE(changed.empty());
            first = i == 0 ? changed : first;
            // The faintest ends of lines change some colours by nothing.
            std::vector<std::pair<int, int>> apart;
            std::set_symmetric_difference(changed.begin(), changed.end(), first.begin(),
                                          first.end(), std::back_inserter(apart), rowByRow);
            CHECK(apart.size() * 30 <= first.size());
        }
        CHECK_FALSE(plain.report(0).at_rest);
    }
}

TEST_CASE("overlay: edges of the triangle are lines between its corners, and nothing else",
          "[unit][overlay]") {
    Workers workers(2);
    Session session(sceneNamed("triangle"), testSettings(), workers);
    drawToRest(session, 200);
    const auto changed = drawnBy(session, {.edges = true});
    const FrameState state = frameStateAt(session.scene(), {}, 0, kTestWidth, kTestHeight);
    const Mesh& mesh = session.scene().meshes[0];
    std::vector<glm::dvec2> corners;
    for (uint32_t i = 0; i < 3; ++i) {
        const glm::dvec4 clip =
            state.camera.view_projection * glm::dvec4(mesh.x[i], mesh.y[i], mesh.z[i], 1);
        corners.push_back({(clip.x / clip.w * 0.5 + 0.5) * kTestWidth,
                           (0.5 - clip.y / clip.w * 0.5) * kTestHeight});
    }
    REQUIRE(changed.size() > 60);
    for (const auto& [x, y] : changed) {
        double nearest = 1e9;
        for (size_t i = 0; i < 3; ++i) {
            const glm::dvec2 a = corners[i], along = corners[(i + 1) % 3] - a;
            const glm::dvec2 p = glm::dvec2(x + 0.5, y + 0.5) - a;
            const double cross = std::abs(p.x * along.y - p.y * along.x);
            nearest = std::min(nearest, cross / std::sqrt(along.x * along.x + along.y * along.y));
        }
        CHECK(nearest < 1.2);
    }
}

TEST_CASE("overlay: what lies behind a surface is hidden", "[unit][overlay]") {
    Workers workers(1);
    LineDepth depth;
    Image<uint32_t> plane(20, 20);
    for (int y = 0; y < 20; ++y) {
        for (int x = 0; x < 20; ++x) {
            plane.at(x, y) = x < 10 ? 0 : std::bit_cast<uint32_t>(0.5f);
        }
    }
    depth.take(plane.view(), workers);
    for (const float at : {0.4f, 0.4995f, 0.6f}) {
        Image<Rgb8> out(20, 20);
        const Segment line{.x0 = 0,
                           .y0 = 10.5f,
                           .depth0 = at,
                           .x1 = 20,
                           .y1 = 10.5f,
                           .depth1 = at,
                           .colour = {255, 255, 255}};
        drawSegments(std::vector{line}, &depth, out.view(), workers);
        CHECK(out.at(3, 10).g == 255);
        CHECK((out.at(15, 10).g == 255) == (at > 0.45f));
    }
}

TEST_CASE("overlay: borders of tiles lie at multiples of 64 pixels", "[unit][overlay]") {
    Workers workers(2);
    Session session(sceneNamed("triangle"), {.width = 150, .height = 130}, workers);
    drawToRest(session, 200);
    for (const auto& [x, y] : drawnBy(session, {.tiles = true})) {
        CHECK((x == 64 || x == 128 || y == 64 || y == 128));
    }
    CHECK(drawnBy(session, {.tiles = true}).size() >= 2 * 130);
}

TEST_CASE("overlay: arrows point to where things were", "[unit][overlay]") {
    Workers workers(2);
    Session plain(sceneNamed("checker"), testSettings(), workers);
    Session drawn_over(sceneNamed("checker"), testSettings(), workers);
    drawn_over.look().overlays.arrows = true;
    for (Session* session : {&plain, &drawn_over}) {
        session->draw();
        session->steer().look(0.003, 0);
    }
    const Image<Rgb8> picture = copyOf(plain.draw().image);
    // The camera turned to the right, so all was farther to the right; arrows begin at dots.
    int right = 0, left = 0;
    for (const auto& [x, y] : changedPixels(picture, drawn_over.draw().image)) {
        right += x % 24 >= 14 && x % 24 <= 18 ? 1 : 0;
        left += x % 24 >= 6 && x % 24 <= 10 ? 1 : 0;
    }
    CHECK(right > 30);
    CHECK(left == 0);
    drawToRest(drawn_over, 200);
    CHECK(drawnBy(drawn_over, {.arrows = true}).empty());  // at rest there are none
}

TEST_CASE("canvas: pictures are placed as they are, as squares, or smoothly", "[unit][canvas]") {
    Workers workers(2);
    Image<Rgb8> picture(5, 3);
    for (int y = 0; y < 3; ++y) {
        for (int x = 0; x < 5; ++x) {
            picture.at(x, y) = {uint8_t(40 * x), uint8_t(80 * y), 7};
        }
    }
    Image<Rgb8> same(5, 3), squares(20, 12), smooth(20, 12);
    placePicture(picture.view(), 0, 5, true, same.view(), workers);
    placePicture(picture.view(), 0, 20, false, squares.view(), workers);
    placePicture(picture.view(), 0, 20, true, smooth.view(), workers);
    CHECK(changedPixels(picture, same.view()).empty());
    for (int y = 0; y < 12; ++y) {
        for (int x = 0; x < 20; ++x) {
            CHECK(squares.at(x, y) == picture.at(x / 4, y / 4));
            // A ramp stays a ramp, between the first and the last pixel's centre.
            const double expected = std::clamp(40 * ((x + 0.5) / 4 - 0.5), 0.0, 160.0);
            CHECK(std::abs(smooth.at(x, y).r - expected) <= 1);
            CHECK(smooth.at(x, y).b == 7);
        }
    }
    Image<Rgb8> half(20, 12);
    placePicture(picture.view(), 7, 12, false, half.view(), workers);
    CHECK(half.at(6, 0) == Rgb8{});
    CHECK(half.at(7, 0) == picture.at(1, 0));
    CHECK(half.at(12, 0) == Rgb8{});
}
