// Motion vectors without an oracle: the depth plane tells where in the world a pixel is, and the
// motion vector must lead to where that point was.

#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "rasterizer/fixed.h"
#include "tests/support/test_scene.h"

using namespace still;
using namespace still::test;

namespace {

FrameView viewAt(const glm::dmat4& camera, const glm::dmat4& camera_before) {
    FrameView view;
    view.width = 190;
    view.height = 110;
    view.jitter_x_fx8 = 61;
    view.jitter_y_fx8 = -77;
    const glm::dmat4 projection = perspective(1.5, double(view.width) / view.height, 0.1, 100);
    view.view_projection = projection * camera;
    view.view_projection_before = projection * camera_before;
    return view;
}

/// A floor cut into squares and a tilted card before it.
TestScene floorAndCard() {
    TestScene scene;
    scene.addMesh();
    for (int row = 0; row < 6; ++row) {
        for (int column = 0; column < 6; ++column) {
            const float x = float(column) * 2 - 6, z = -float(row) * 2 - 1;
            scene.addQuad(
                {TestVertex{x, -1, z}, {x + 2, -1, z}, {x + 2, -1, z - 2}, {x, -1, z - 2}});
        }
    }
    scene.addMesh();
    scene.addQuad(
        {TestVertex{-0.7f, -0.5f, 0}, {0.7f, -0.5f, 0.3f}, {0.7f, 0.6f, 0}, {-0.7f, 0.6f, -0.3f}});
    return scene;
}

void place(Instance& card, const glm::dmat4& now, const glm::dmat4& before) {
    card.transform = toAffine(now);
    card.transform_before = toAffine(before);
}

glm::dmat4 toMatrix(const Affine& a) {
    glm::dmat4 m(1.0);
    for (int k = 0; k < 12; ++k) {
        m[k % 4][k / 4] = double(a[size_t(k)]);
    }
    return m;
}

glm::dvec2 samplePosition(const FrameView& view, int x, int y) {
    return {x + 0.5 + view.jitter_x_fx8 / 256.0, y + 0.5 + view.jitter_y_fx8 / 256.0};
}

/// World position of what the depth plane holds.
glm::dvec4 unproject(const FrameView& view, const glm::dvec2& p, double reversed) {
    const glm::dvec4 ndc(p.x / view.width * 2 - 1, 1 - p.y / view.height * 2, 1 - 2 * reversed, 1);
    const glm::dvec4 world = glm::inverse(view.view_projection) * ndc;
    return world / world.w;
}

struct Seen {
    glm::dvec2 position;
    double depth;
};

Seen project(const FrameView& view, const glm::dmat4& view_projection, const glm::dvec4& world) {
    const glm::dvec4 c = view_projection * world;
    return {{(c.x / c.w + 1) * 0.5 * view.width, (1 - c.y / c.w) * 0.5 * view.height},
            0.5 * (c.w - c.z) / c.w};
}

struct Worst {
    double motion_fx8 = 0, depth_steps = 0;
    int moved_pixels = 0, wrong_flags = 0, denied = 0;
};

Worst follow(const TestScene& scene, const DrawList& list, const FrameView& view) {
    GBuffer out;
    draw(list, view, out);
    Worst worst;
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) {
            const uint16_t id = out.id.at(x, y);
            if (id == 0) {
                continue;
            }
            const bool is_card = (id & kSurfaceMask) == scene.instances[1].first_surface;
            const Instance& instance = scene.instances[is_card ? 1 : 0];
            worst.wrong_flags += ((id & kMovedBit) != 0) != instance.moved ? 1 : 0;
            worst.moved_pixels += instance.moved ? 1 : 0;
            const glm::dvec2 p = samplePosition(view, x, y);
            const glm::dvec4 world = unproject(view, p, std::bit_cast<float>(out.depth.at(x, y)));
            const glm::dvec4 world_before = toMatrix(instance.transform_before) *
                                            glm::inverse(toMatrix(instance.transform)) * world;
            const Seen before = project(view, view.view_projection_before, world_before);
            const Motion motion = out.motion.at(x, y);
            if (motion.x_fx8 == kNoHistory) {
                ++worst.denied;
                continue;
            }
            worst.motion_fx8 =
                std::max({worst.motion_fx8,
                          std::abs((before.position.x - p.x) * kSubpixelOne - motion.x_fx8),
                          std::abs((before.position.y - p.y) * kSubpixelOne - motion.y_fx8)});
            const int steps = logDepth16(std::bit_cast<uint32_t>(float(before.depth)));
            worst.depth_steps = std::max(
                worst.depth_steps, std::abs(double(steps) - double(out.depth_before.at(x, y))));
        }
    }
    return worst;
}

}  // namespace

TEST_CASE("motion: previous position of every pixel is the same surface point", "[motion]") {
    const bool camera_moves = GENERATE(false, true);
    const bool card_moves = GENERATE(false, true);
    const glm::dmat4 camera = rigid(0.01, 0, 0, 0);
    const glm::dmat4 before = camera_moves ? rigid(0.004, 0.05, -0.02, 0.1) : camera;
    const FrameView view = viewAt(camera, before);
    TestScene scene = floorAndCard();
    place(scene.instances[1], rigid(0.05, 0.1, 0, -3),
          card_moves ? rigid(0.03, 0.05, 0.02, -3.1) : rigid(0.05, 0.1, 0, -3));
    const DrawList list = scene.list();
    const Worst worst = follow(scene, list, view);
    CAPTURE(camera_moves, card_moves);
    CHECK((worst.moved_pixels > 500) == card_moves);
    CHECK(worst.wrong_flags == 0);
    CHECK(worst.denied == 0);
    // Half a step of rounding, and snapping: the depth plane is up to 1/512 px off the geometry.
    CHECK(worst.motion_fx8 < 0.85);
    CHECK(worst.depth_steps <= 1);
}

TEST_CASE("motion: a camera and objects at rest have none", "[motion]") {
    const glm::dmat4 camera = rigid(0.013, 0.3, 0.1, 0.2);
    const FrameView view = viewAt(camera, camera);
    TestScene scene = floorAndCard();
    place(scene.instances[1], rigid(0.05, 0.1, 0, -3), rigid(0.05, 0.1, 0, -3));
    GBuffer out;
    draw(scene.list(), view, out);
    int moving = 0;
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) {
            moving += out.motion.at(x, y) == Motion{} ? 0 : 1;
            moving += (out.id.at(x, y) & kMovedBit) != 0 ? 1 : 0;
        }
    }
    CHECK(moving == 0);
    for (const TileFacts& facts : out.tiles) {
        CHECK(facts.still());
    }
}

TEST_CASE("motion: at rest the expected previous depth is the depth", "[motion]") {
    const glm::dmat4 camera = rigid(0.013, 0.3, 0.1, 0.2);
    const FrameView view = viewAt(camera, camera);
    TestScene scene = floorAndCard();
    place(scene.instances[1], rigid(0.05, 0.1, 0, -3), rigid(0.05, 0.1, 0, -3));
    GBuffer out;
    draw(scene.list(), view, out);
    int different = 0;
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) {
            different += out.depth_before.at(x, y) == logDepth16(out.depth.at(x, y)) ? 0 : 1;
        }
    }
    CHECK(different == 0);
}

TEST_CASE("motion: the background moves with the turning camera", "[motion]") {
    const FrameView view = viewAt(rigid(0.01, 0, 0, 0), rigid(0.0, 0, 0, 0));
    TestScene scene;
    GBuffer out;
    scene.addMesh();
    draw(scene.list(), view, out);
    double worst_fx8 = 0;
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) {
            const glm::dvec2 p = samplePosition(view, x, y);
            const glm::dvec4 far_away =
                glm::inverse(view.view_projection) *
                glm::dvec4(p.x / view.width * 2 - 1, 1 - p.y / view.height * 2, 1, 1);
            const Seen before = project(view, view.view_projection_before, far_away);
            worst_fx8 = std::max(
                worst_fx8, std::abs((before.position.x - p.x) * 256 - out.motion.at(x, y).x_fx8));
        }
    }
    CHECK(worst_fx8 < 0.6);
}

TEST_CASE("motion: an object that was behind the camera has no history", "[motion]") {
    const glm::dmat4 camera(1.0);
    const FrameView view = viewAt(camera, camera);
    TestScene scene = floorAndCard();
    place(scene.instances[1], rigid(0, 0, 0, -3), rigid(0, 0, 0, 3));
    GBuffer out;
    draw(scene.list(), view, out);
    int card = 0, denied = 0;
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) {
            if ((out.id.at(x, y) & kMovedBit) != 0) {
                ++card;
                denied += out.motion.at(x, y).x_fx8 == kNoHistory ? 1 : 0;
            }
        }
    }
    CHECK(card > 500);
    CHECK(denied == card);
}

TEST_CASE("motion: tiles know whether something moved in them", "[motion]") {
    const glm::dmat4 camera(1.0);
    const FrameView view = viewAt(camera, camera);
    TestScene scene = floorAndCard();
    // Near the left edge now, near the right edge before.
    place(scene.instances[1], rigid(0, -4, 0, -5), rigid(0, 4, 0, -5));
    GBuffer out;
    draw(scene.list(), view, out);
    REQUIRE(out.tiles_x == 3);
    CHECK(out.tiles[0].moved);
    CHECK_FALSE(out.tiles[1].moved);
    CHECK(out.tiles[2].moved);
    CHECK_FALSE(out.tiles[0].camera_moved);
}
