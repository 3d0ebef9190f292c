// Sampled light: means are what mathematics says, bytes are the same everywhere.

#include "rasterizer/light_sampler.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "rasterizer/internal/light_random.h"
#include "tests/support/busy_scene.h"
#include "tests/unit/rasterizer/light_runs.h"

using namespace still;
using namespace still::test;

namespace {

const FrameView kSmall = viewOfFloor(9, 9);

}  // namespace

TEST_CASE("light sampler: a sun gives its colour times the cosine, however large its disc is") {
    TestScene scene = floorScene();
    scene.lighting.sun = {.direction = {0.6f, -0.8f, 0.0f}, .colour = {1, 1, 1}};
    scene.lighting.sampled.sun_shadow = SunShadow::traced;
    for (float tangent : {0.0f, 0.1f, 0.5f}) {
        scene.lighting.sampled.sun_tangent = tangent;
        CHECK(meanLight(scene, kSmall, 256).direct == Approx(0.8).epsilon(0.005));
    }
}

TEST_CASE("light sampler: half of the sun's disc behind an edge gives half of its light") {
    TestScene scene = floorScene();
    scene.lighting.sun = {.direction = {0, -1, 0}, .colour = {1, 1, 1}};
    scene.lighting.sampled.sun_shadow = SunShadow::traced;
    scene.lighting.sampled.sun_tangent = 0.2f;
    addFloor(scene, 50, 0, 50, 10);  // covers x > 0, above the picture
    CHECK(meanLight(scene, kSmall, 256).direct == Approx(0.5).epsilon(0.02));
    scene.lighting.sampled.sun_tangent = 0.0f;
    addFloor(scene, -50, 0, 60, 10);
    CHECK(meanLight(scene, kSmall, 4).direct == 0.0);
}

TEST_CASE("light sampler: spheres and rectangles light like points from afar, by areas when near") {
    TestScene scene = floorScene();
    scene.lighting.sampled.spheres = {{{0, 10, 0}, 0.5f, {50, 50, 50}}};
    CHECK(meanLight(scene, kSmall, 64).direct == Approx(0.5).epsilon(0.01));
    // Straight above, the whole ball over the horizon: sine² of its edge, exactly.
    scene.lighting.sampled.spheres = {{{0, 2, 0}, 1.5f, {2, 2, 2}}};
    CHECK(meanLight(scene, kSmall, 512).direct == Approx(0.5).epsilon(0.02));

    scene.lighting.sampled.spheres.clear();
    scene.lighting.sampled.rectangles = {{{0, 10, 0}, {0.5f, 0, 0}, {0, 0, 0.5f}, {50, 50, 50}}};
    CHECK(meanLight(scene, kSmall, 64).direct == Approx(0.5).epsilon(0.01));  // shines down
    // Of a square from the point below its middle, of half its side away, the form factor is
    // 4 / π · q · atan(q), q = 1 / √2; its radiance is π · colour / area.
    scene.lighting.sampled.rectangles = {{{0, 1, 0}, {2, 0, 0}, {0, 0, 2}, {1, 1, 1}}};
    const double q = 1 / std::sqrt(2.0);
    const double expected = 4 * q * std::atan(q) / 4;
    CHECK(meanLight(scene, kSmall, 1024).direct == Approx(expected).epsilon(0.02));
    scene.lighting.sampled.rectangles[0].edge_u = {-2, 0, 0};  // shines up
    CHECK(meanLight(scene, kSmall, 4).direct == 0.0);
}

TEST_CASE("light sampler: many lights bring the sum of what each brings") {
    TestScene scene = floorScene();
    auto& sampled = scene.lighting.sampled;
    sampled.spheres = {{{0, 4, 0}, 0.5f, {4, 4, 4}}, {{5, 3, 1}, 0.2f, {8, 8, 8}}};
    sampled.rectangles = {{{-3, 2, 0}, {1, 0, 0}, {0, 0, 1}, {3, 3, 3}}};
    const double together = meanLight(scene, kSmall, 2048).direct;
    double sum = 0;
    const auto all = sampled;
    for (size_t i = 0; i < 3; ++i) {
        sampled.spheres.clear();
        sampled.rectangles.clear();
        if (i < 2) {
            sampled.spheres = {all.spheres[i]};
        } else {
            sampled.rectangles = all.rectangles;
        }
        sum += meanLight(scene, kSmall, 1024).direct;
    }
    CHECK(together == Approx(sum).epsilon(0.02));
}

TEST_CASE("light sampler: a wall takes half of the sky, one out of reach nothing") {
    TestScene scene = floorScene();
    scene.lighting.ambient = {1, 1, 1};
    scene.lighting.sampled.ambient = AmbientLight::traced_occlusion;
    scene.lighting.sampled.occlusion_distance = 1000.0f;
    CHECK(meanLight(scene, kSmall, 16).indirect == 1.0);
    // Endless to both sides and high, right beside the middle: seen from its foot half the sky.
    scene.addQuad({cornerAt(-0.01, 0, 4000, 1, 0, 0), cornerAt(-0.01, 0, -4000, 1, 0, 0),
                   cornerAt(-0.01, 8000, -4000, 1, 0, 0), cornerAt(-0.01, 8000, 4000, 1, 0, 0)});
    FrameView view = kSmall;
    CHECK(meanLight(scene, view, 1024).indirect == Approx(0.5).epsilon(0.03));
    scene.lighting.sampled.occlusion_distance = 0.001f;
    CHECK(meanLight(scene, view, 64).indirect == 1.0);
}

TEST_CASE("light sampler: a bounce brings albedo times the light of what is all around") {
    // A cube with a point light in its middle: every bounce hits a wall, and the mean of what it
    // brings is an integral over the hemisphere.
    TestScene scene;
    scene.lighting = {};
    scene.materials[0].diffuse = {0.5f, 0.5f, 0.5f};
    scene.addMesh();
    const double r = 3;
    for (int side = 0; side < 6; ++side) {
        const int k = side / 2;
        const double s = side % 2 == 0 ? r : -r;
        std::array<TestVertex, 4> corners;
        for (int c = 0; c < 4; ++c) {
            double p[3], n[3] = {0, 0, 0};
            p[k] = s;
            p[(k + 1) % 3] = (c == 0 || c == 3) ? -r : r;
            p[(k + 2) % 3] = c < 2 ? -r : r;
            n[k] = s > 0 ? -1 : 1;
            corners[size_t(c)] = cornerAt(p[0], p[1], p[2], n[0], n[1], n[2]);
        }
        scene.addQuad(corners);
    }
    scene.lighting.points = {{{0, 0, 0}, {9, 9, 9}}};
    scene.lighting.ambient = {5, 5, 5};  // outside: never seen
    scene.lighting.sampled.ambient = AmbientLight::bounce;
    FrameView view;
    view.width = view.height = 9;
    view.view_projection = perspective(8.0, 1.0, 0.1, 100);  // along −z, from the middle
    view.view_projection_before = view.view_projection;
    // From the middle of the wall z = −3 into a grid of the hemisphere.
    double expected = 0;
    constexpr int kGrid = 400;
    for (int i = 0; i < kGrid; ++i) {
        for (int j = 0; j < kGrid; ++j) {
            const double rho = std::sqrt((i + 0.5) / kGrid), phi = 6.283185307 * (j + 0.5) / kGrid;
            const double d[3] = {rho * std::cos(phi), rho * std::sin(phi),
                                 std::sqrt(1 - rho * rho)};
            double t = 2 * r / d[2];
            t = std::min({t, r / std::fabs(d[0]), r / std::fabs(d[1])});
            const double p[3] = {d[0] * t, d[1] * t, d[2] * t - r};
            const double d2 = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
            const double largest = std::max({std::fabs(p[0]), std::fabs(p[1]), std::fabs(p[2])});
            expected += 0.5 * 9 * largest / (std::sqrt(d2) * d2) / (kGrid * kGrid);
        }
    }
    CHECK(meanLight(scene, view, 1024).indirect == Approx(expected).epsilon(0.01));
}

TEST_CASE("light sampler: no surface shadows itself, and no light leaks in under a wall") {
    TestScene scene = floorScene();
    scene.lighting.sun = {.direction = {0, -0.6f, 0.8f}, .colour = {1, 1, 1}};
    scene.lighting.sampled.sun_shadow = SunShadow::traced;
    const FrameView view = viewOfFloor(64, 64);  // a pixel is 3.5 cm wide
    Sampling open;
    open.frame(scene, view);
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            REQUIRE(open.light.direct_green.at(x, y) == 2458);
        }
    }
    // Stands on the floor with its lit side away from the eye.
    scene.addQuad({cornerAt(-9, 0, -0.2, 0, 0, 1), cornerAt(9, 0, -0.2, 0, 0, 1),
                   cornerAt(9, 0.3, -0.2, 0, 0, 1), cornerAt(-9, 0.3, -0.2, 0, 0, 1)});
    Sampling walled;
    walled.frame(scene, view);
    int feet = 0;
    for (int y = 1; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            const bool wall_above = walled.gbuffer.id.at(x, y - 1) == 2;
            if (wall_above && walled.gbuffer.id.at(x, y) == 1) {
                ++feet;
                REQUIRE(walled.light.direct_green.at(x, y) == 0);
            }
        }
    }
    CHECK(feet == 64);
}

TEST_CASE("light sampler: highlights are those of the rasterizer where nothing is in the way") {
    TestScene scene = floorScene();
    scene.materials[0].specular = {0.5f, 0.4f, 0.3f};
    scene.materials[0].diffuse = {0, 0, 0};
    scene.materials[0].shininess = 20;
    scene.lighting.sun = {.direction = {0, -0.4472136f, 0.8944272f}, .colour = {2, 2, 2}};
    const FrameView view = viewOfFloor(32, 32);
    GBuffer plain;
    draw(scene.list(), view, plain);
    scene.lighting.sampled.sun_shadow = SunShadow::traced;
    Sampling run;
    run.frame(scene, view);
    int brightest = 0, largest = 0;
    // Whatever the rasterizer itself leaves out, the sum is the highlight once.
    GBuffer unlit;
    scene.lighting.sun.colour = {0, 0, 0};
    draw(scene.list(), view, unlit);
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 32; ++x) {
            brightest = std::max(brightest, int(plain.red.at(x, y)));
            largest = std::max(largest,
                               std::abs(int(plain.red.at(x, y)) - int(run.gbuffer.red.at(x, y))));
        }
    }
    CHECK(brightest > 2000);
    CHECK(largest <= 12);
}

TEST_CASE("light sampler: the same bytes on every target, in every order", "[determinism]") {
    for (uint64_t seed : {1u, 2u}) {
        TestScene scene = busyScene(seed);
        auto& sampled = scene.lighting.sampled;
        sampled.sun_shadow = SunShadow::traced;
        sampled.sun_tangent = 0.05f;
        sampled.ambient = AmbientLight::bounce;
        sampled.spheres = {{{0, 3, -5}, 1.0f, {20, 10, 10}}};
        sampled.rectangles = {{{2, 3, -6}, {1, 0, 0}, {0, 0, 1}, {20, 30, 10}}};
        FrameView view = busyView(seed);
        view.sample = 5;
        Workers serial(1, Schedule::serial);
        const std::vector<uint16_t> all = busyBytes(scene, view, serial, SimdTarget::scalar);
        REQUIRE(std::count(all.begin(), all.end(), 0) < ptrdiff_t(all.size()) * 3 / 4);
        CAPTURE(seed);
        CHECK(differingBytes(scene, view) == "");
    }
}

TEST_CASE(
    "light sampler: where nothing changes there is no change, where light changes it is told") {
    TestScene scene = floorScene();
    scene.lighting.ambient = {0.5f, 0.5f, 0.5f};
    auto& sampled = scene.lighting.sampled;
    sampled.ambient = AmbientLight::traced_occlusion;
    sampled.occlusion_distance = 5.0f;
    sampled.spheres = {{{0, 3, 0}, 1.0f, {4, 4, 4}}};
    scene.addMesh();
    addFloor(scene, 0.4, 0, 0.2, 0.5);  // something that throws a shadow
    FrameView view = viewOfFloor(64, 48);
    Sampling run;
    run.frame(scene, view);
    CHECK_FALSE(run.changed);
    view.sample = 1;
    run.frame(scene, view);
    CHECK_FALSE(run.changed);
    view.sample = 2;
    view.view_projection = perspective(4.0, 1.2, 0.1, 100) * rigid(0.01, 0, -1, -4);
    run.frame(scene, view);  // the camera alone changes no light
    CHECK_FALSE(run.changed);

    view = viewOfFloor(64, 48);
    view.sample = 3;
    run.frame(scene, view);
    sampled.spheres[0].colour = {2, 2, 2};
    view.sample = 4;
    run.frame(scene, view);
    REQUIRE(run.changed);
    REQUIRE(run.change.direct_now.width() == 22);
    REQUIRE(run.change.direct_now.height() == 16);
    int lit = 0;
    for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 21; ++x) {
            const int before = run.change.direct_before.at(x, y);
            const int now = run.change.direct_now.at(x, y);
            lit += before > 0;
            CAPTURE(x, y, before, now);
            REQUIRE(std::abs(before - 2 * now) <= 2);
            REQUIRE(run.change.indirect_before.at(x, y) == run.change.indirect_now.at(x, y));
        }
    }
    CHECK(lit > 250);
}

TEST_CASE("light sampler: a moving object changes light where its shadow was, and nowhere else") {
    TestScene scene = floorScene();
    auto& sampled = scene.lighting.sampled;
    sampled.sun_shadow = SunShadow::traced;
    scene.lighting.sun = {.direction = {0, -1, 0}, .colour = {1, 1, 1}};
    scene.addMesh();
    addFloor(scene, -0.4, 0, 0.2, 1.0);
    const FrameView view = viewOfFloor(96, 96);
    Sampling run;
    run.frame(scene, view);
    scene.list();  // numbers the surfaces
    Instance& mover = scene.instances[1];
    mover.transform = toAffine(rigid(0, 0.6, 0, 0));
    mover.identity = false;
    mover.moved = true;
    FrameView next = view;
    next.sample = 1;
    run.frame(scene, next);
    REQUIRE(run.changed);
    int brighter = 0, darker = 0, same = 0;
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 32; ++x) {
            const int before = run.change.direct_before.at(x, y);
            const int now = run.change.direct_now.at(x, y);
            brighter += now > before;
            darker += now < before;
            same += now == before && now > 0;
        }
    }
    CHECK(brighter > 10);
    CHECK(darker > 10);
    CHECK(same > 32 * 32 * 3 / 4);
}

TEST_CASE("light random: the first samples of a pixel, and a frame's neighbours, are even") {
    using namespace still::internal;
    const PixelNumbers pixels;
    const auto even = [](const std::vector<RandomPair>& points) {
        // A (0, k, 2)-net: one point in each box of every shape that has 2^-k of the square.
        const uint32_t k = uint32_t(std::countr_zero(points.size()));
        for (uint32_t a = 0; a <= k; ++a) {
            std::vector<int> boxes(points.size(), 0);
            for (const RandomPair& p : points) {
                const uint32_t x = a == 0 ? 0 : p.x >> (32 - a);
                const uint32_t y = a == k ? 0 : p.y >> (32 - (k - a));
                ++boxes[(x << (k - a)) | y];
            }
            if (std::count(boxes.begin(), boxes.end(), 1) != ptrdiff_t(points.size())) {
                return false;
            }
        }
        return true;
    };
    const auto at = [&](int x, int y, uint32_t sample, RandomUse use) {
        return pixels.tileOf(x, y, numbersOfSample(sample)).at(x, y, use);
    };
    for (RandomUse use : {kRandomSun, kRandomLight, kRandomHemisphere}) {
        for (uint32_t count : {4u, 8u, 16u, 32u, 256u}) {
            for (uint32_t first : {0u, count * 3}) {
                std::vector<RandomPair> points;
                for (uint32_t i = 0; i < count; ++i) {
                    points.push_back(at(77, 130, first + i, use));
                }
                CHECK(even(points));
            }
        }
        for (int side : {2, 4, 8, 64}) {
            std::vector<RandomPair> points;
            for (int y = 0; y < side; ++y) {
                for (int x = 0; x < side; ++x) {
                    points.push_back(at(192 + x, 64 + y, 9, use));
                }
            }
            CHECK(even(points));
        }
    }
}
