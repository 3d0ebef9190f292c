// Light without rays: the sun's shadow map and occlusion out of the depth plane, held against
// mathematics and against what rays find.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "tests/support/busy_scene.h"
#include "tests/unit/rasterizer/light_runs.h"

using namespace still;
using namespace still::test;

namespace {

constexpr int kSide = 48;

/// Means over `samples` of the green light of every pixel: direct, then indirect.
struct Means {
    std::vector<double> direct, indirect;
    std::vector<int> surface;
};

Means means(TestScene& scene, int samples) {
    FrameView view = viewOfFloor(kSide, kSide);
    Means mean;
    mean.direct.assign(kSide * kSide, 0);
    mean.indirect = mean.direct;
    mean.surface.resize(kSide * kSide);
    Sampling run;
    for (int i = 0; i < samples; ++i) {
        view.sample = uint32_t(i);
        run.frame(scene, view);
        for (int p = 0; p < kSide * kSide; ++p) {
            const int x = p % kSide, y = p / kSide;
            mean.direct[size_t(p)] += run.light.direct_green.at(x, y) / kOne / samples;
            mean.indirect[size_t(p)] += run.light.indirect_green.at(x, y) / kOne / samples;
            mean.surface[size_t(p)] = run.gbuffer.id.at(x, y);
        }
    }
    return mean;
}

/// Largest and mean difference of two pictures.
struct Difference {
    double largest = 0, mean = 0;
};
Difference differenceOf(const std::vector<double>& a, const std::vector<double>& b) {
    Difference d;
    for (size_t i = 0; i < a.size(); ++i) {
        d.largest = std::max(d.largest, std::fabs(a[i] - b[i]));
        d.mean += std::fabs(a[i] - b[i]) / double(a.size());
    }
    return d;
}

std::vector<uint16_t> greenOf(const Sampling& run) {
    std::vector<uint16_t> all;
    for (int y = 0; y < kSide; ++y) {
        const uint16_t* row = run.light.direct_green.view().row(y);
        all.insert(all.end(), row, row + kSide);
    }
    return all;
}

/// A wall across the whole picture, 1.5 high, that stands on the floor and faces the eye.
void addWall(TestScene& scene) {
    scene.addQuad({cornerAt(-9, 0, -0.2, 0, 0, 1), cornerAt(9, 0, -0.2, 0, 0, 1),
                   cornerAt(9, 1.5, -0.2, 0, 0, 1), cornerAt(-9, 1.5, -0.2, 0, 0, 1)});
}

TestScene sunScene(std::array<float, 3> direction) {
    TestScene scene = floorScene();
    scene.lighting.sun = {.direction = direction, .colour = {1, 1, 1}};
    scene.lighting.sampled.sun_shadow = SunShadow::mapped;
    return scene;
}

}  // namespace

TEST_CASE("sun map: a floor under any sun lies in its light, without a shadow of its own") {
    const std::vector<std::array<float, 3>> directions = {
        {0, -1, 0}, {0.6f, -0.8f, 0}, {0, -0.6f, 0.8f}, {-0.64f, -0.6f, -0.48f}, {0.8f, -0.6f, 0}};
    for (const std::array<float, 3>& direction : directions) {
        TestScene scene = sunScene(direction);
        const Means mean = means(scene, 2);
        const double expected = std::round(-double(direction[1]) * kOne) / kOne;
        CAPTURE(direction[0], direction[1], direction[2]);
        CHECK(differenceOf(mean.direct, std::vector<double>(kSide * kSide, expected)).largest <=
              1.01 / kOne);
    }
}

TEST_CASE("sun map: half of the sun's disc behind an edge gives half of its light") {
    TestScene scene = sunScene({0, -1, 0});
    scene.lighting.sampled.sun_tangent = 0.2f;
    addFloor(scene, 20, 0, 20, 10);  // covers x > 0, above the picture
    CHECK(meanLight(scene, viewOfFloor(9, 9), 1024).direct == Approx(0.5).margin(0.03));
    addFloor(scene, -20, 0, 20.1, 10);
    CHECK(meanLight(scene, viewOfFloor(9, 9), 64).direct == 0.0);
}

TEST_CASE("sun map: its shadows are those that rays find, but for texels at their edges") {
    for (float tangent : {0.0f, 0.1f}) {
        TestScene scene = sunScene({0.48f, -0.6f, 0.64f});
        scene.lighting.sampled.sun_tangent = tangent;
        scene.addMesh();
        addFloor(scene, -0.3, -0.3, 0.25, 0.5);
        addFloor(scene, 0.3, 0.1, 0.1, 0.2);
        const Means mapped = means(scene, 64);
        scene.lighting.sampled.sun_shadow = SunShadow::traced;
        const Means traced = means(scene, 64);
        const auto dark = std::count_if(traced.direct.begin(), traced.direct.end(),
                                        [](double light) { return light < 0.1; });
        CAPTURE(tangent);
        REQUIRE(dark > 30);  // there is a shadow
        // A texel is 0.08 wide, the picture about 1.1.
        CHECK(differenceOf(mapped.direct, traced.direct).mean < 0.03);
    }
}

TEST_CASE("sun map: what faces away from the sun gets nothing of it") {
    TestScene scene = sunScene({0, -1, 0});
    scene.lighting.sun.direction = {0, 1, 0};  // shines up, at the floor's back
    CHECK(meanLight(scene, viewOfFloor(9, 9), 4).direct == 0.0);
}

TEST_CASE("sun map: it follows what moves, and stays where nothing does") {
    TestScene scene = sunScene({0, -1, 0});
    scene.addMesh();
    addFloor(scene, 0, 0, 0.2, 1);
    const FrameView view = viewOfFloor(kSide, kSide);
    Sampling run;
    run.frame(scene, view);
    const int middle = kSide / 2;
    REQUIRE(run.light.direct_green.at(middle, middle) == 0);
    const std::vector<uint16_t> first = greenOf(run);
    run.frame(scene, view);
    CHECK(greenOf(run) == first);
    scene.instances[1].transform = toAffine(rigid(0, 0.8, 0, 0));
    scene.instances[1].identity = false;
    run.frame(scene, view);
    CHECK(run.light.direct_green.at(middle, middle) == 4096);
    // The same as of a map that has never seen anything else.
    Sampling fresh;
    fresh.frame(scene, view);
    CHECK(greenOf(run) == greenOf(fresh));
    scene.lighting.sun.direction = {0.6f, -0.8f, 0};
    run.frame(scene, view);
    CHECK(run.light.direct_green.at(middle, middle) == 3277);
}

TEST_CASE("screen occlusion: nothing occludes a plane, nor what is out of reach") {
    TestScene scene = floorScene();
    scene.lighting.ambient = {1, 1, 1};
    auto& sampled = scene.lighting.sampled;
    sampled.ambient = AmbientLight::screen_occlusion;
    sampled.occlusion_distance = 0.5f;
    const std::vector<double> open(kSide * kSide, 1.0);
    CHECK(differenceOf(means(scene, 8).indirect, open).largest == 0.0);
    addWall(scene);
    sampled.occlusion_distance = 1e-5f;
    CHECK(differenceOf(means(scene, 8).indirect, open).largest == 0.0);
}

TEST_CASE("screen occlusion: along a wall it finds about what rays find") {
    TestScene scene = floorScene();
    addWall(scene);
    scene.lighting.ambient = {1, 1, 1};
    auto& sampled = scene.lighting.sampled;
    sampled.occlusion_distance = 0.5f;
    sampled.ambient = AmbientLight::screen_occlusion;
    const Means screen = means(scene, 128);
    sampled.ambient = AmbientLight::traced_occlusion;
    const Means traced = means(scene, 128);
    // Row by row: of floor in front of the wall, down the picture.
    double before = 0, foot = 1;
    int rows = 0;
    for (int y = 1; y < kSide; ++y) {
        const size_t p = size_t(y) * kSide + kSide / 2;
        const bool on_floor = screen.surface[p] == 1, below_wall = screen.surface[p - kSide] == 2;
        if (on_floor && below_wall) {
            foot = screen.indirect[p];
            before = 0;
        }
        if (foot < 1 && on_floor) {
            CAPTURE(y, screen.indirect[p], traced.indirect[p]);
            CHECK(screen.indirect[p] == Approx(traced.indirect[p]).margin(0.2));
            CHECK(screen.indirect[p] >= traced.indirect[p] - 0.01);  // what is hidden is missed
            CHECK(screen.indirect[p] >= before - 0.03);              // brighter away from the wall
            before = screen.indirect[p];
            ++rows;
        }
    }
    CHECK(rows > 8);
    CHECK(foot < 0.75);
    CHECK(before == 1.0);
}

TEST_CASE("rough light: the same bytes on every target, in every order", "[determinism]") {
    TestScene scene = busyScene(3);
    auto& sampled = scene.lighting.sampled;
    scene.lighting.ambient = {0.4f, 0.5f, 0.6f};
    sampled.sun_shadow = SunShadow::mapped;
    sampled.sun_tangent = 0.05f;
    sampled.ambient = AmbientLight::screen_occlusion;
    sampled.occlusion_distance = 1.0f;
    FrameView view = busyView(3);
    view.sample = 6;
    CHECK(differingBytes(scene, view) == "");
}
