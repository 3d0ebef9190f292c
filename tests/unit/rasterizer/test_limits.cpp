// Sizes and numbers at the edge of what is allowed, and beyond it.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/support/busy_scene.h"
#include "tests/support/plane_compare.h"
#include "tests/support/random_triangles.h"

using namespace still;
using namespace still::test;

namespace {

int coveredPixels(const GBuffer& out) {
    int count = 0;
    for (int y = 0; y < out.height(); ++y) {
        for (int x = 0; x < out.width(); ++x) {
            count += out.id.at(x, y) != 0 ? 1 : 0;
        }
    }
    return count;
}

void addFullTriangle(TestScene& scene, const FrameView& view) {
    const double w = view.width, h = view.height;
    scene.addTriangle(atPixel(view, -1, -1, 0.5), atPixel(view, 2 * w + 2, -1, 0.5),
                      atPixel(view, -1, 2 * h + 2, 0.5));
}

}  // namespace

TEST_CASE("limits: vertices that are not finite drop their triangles only", "[limits]") {
    const float bad =
        GENERATE(std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                 -std::numeric_limits<float>::infinity(), 3e38f, -3e38f);
    Random random(1);
    for (int component = 0; component < 3; ++component) {
        const FrameView view = deepView(90, 70, random);
        TestScene scene, without;
        for (int k = 0; k < 30; ++k) {
            Random same(uint64_t(k) + 10);
            addDeep(scene, DeepKind::in_front, same);
            Random again(uint64_t(k) + 10);
            addDeep(without, DeepKind::in_front, again);
        }
        // Of the last three triangles one corner is bad; in the other scene they are not there.
        Mesh& mesh = scene.meshes[0];
        for (size_t t = 27; t < 30; ++t) {
            const size_t v = t * 3 + t % 3;
            (component == 0 ? mesh.x : component == 1 ? mesh.y : mesh.z)[v] = bad;
            for (size_t k = 0; k < 3; ++k) {
                without.meshes[0].indices[t * 3 + k] = uint32_t(t * 3);
            }
        }
        const bool huge = std::isfinite(bad);
        for (SimdTarget target : availableSimdTargets()) {
            GBuffer a, b;
            draw(scene.list(), view, a, {.simd = target, .planes = kAllPlanes});
            draw(without.list(), view, b, {.simd = target, .planes = kAllPlanes});
            CAPTURE(bad, component, name(target));
            CHECK(coveredPixels(a) > 0);
            // A huge but finite corner is legal; it only must do no harm.
            CHECK((huge || firstDifference(a, b) == ""));
        }
    }
}

TEST_CASE("limits: a target of one pixel works", "[limits]") {
    Random random(2);
    for (int round = 0; round < 20; ++round) {
        const FrameView view = flatView(1, 1, random);
        TestScene scene;
        addFullTriangle(scene, view);
        GBuffer out;
        draw(scene.list(), view, out);
        CHECK(out.id.at(0, 0) == 1);
        CHECK(out.tiles.size() == 1);
    }
}

TEST_CASE("limits: targets of every size about a tile are filled", "[limits]") {
    Random random(3);
    for (int width : {1, 2, 7, 8, 63, 64, 65, 127, 129}) {
        for (int height : {1, 3, 64, 66}) {
            const FrameView view = flatView(width, height, random);
            TestScene scene;
            addFullTriangle(scene, view);
            GBuffer out;
            draw(scene.list(), view, out);
            CAPTURE(width, height);
            CHECK(coveredPixels(out) == width * height);
        }
    }
}

TEST_CASE("limits: long and narrow targets are filled", "[limits]") {
    Random random(4);
    const bool wide = GENERATE(false, true);
    const FrameView view = flatView(wide ? kMaxTargetSize : 3, wide ? 3 : kMaxTargetSize, random);
    TestScene scene;
    addFullTriangle(scene, view);
    GBuffer out;
    draw(scene.list(), view, out);
    CHECK(coveredPixels(out) == 3 * kMaxTargetSize);
}

TEST_CASE("limits: the largest target is covered exactly once", "[limits][slow]") {
    Random random(5);
    const FrameView view = flatView(kMaxTargetSize, kMaxTargetSize, random);
    TestScene scene;
    const auto centre = atPixel(view, 4000.3, 4100.7, 0.5);
    constexpr int kSpokes = 37;
    for (int k = 0; k < kSpokes; ++k) {
        const auto corner = [&](int spoke) {
            const double angle = 6.283185307179586 * (spoke % kSpokes) / kSpokes;
            return atPixel(view, 4000 + 9000 * std::cos(angle), 4100 + 9000 * std::sin(angle), 0.5);
        };
        scene.addTriangle(centre, corner(k), corner(k + 1));
    }
    GBuffer out;  // one for both, it takes 800 MB
    draw(scene.list(), view, out, {.planes = {}});
    CHECK(coveredPixels(out) == kMaxTargetSize * kMaxTargetSize);
    std::vector<uint16_t> ascending;
    for (int y = 0; y < view.height; ++y) {
        const uint16_t* row = out.id.view().row(y);
        ascending.insert(ascending.end(), row, row + view.width);
    }
    std::reverse(scene.meshes[0].indices.begin(), scene.meshes[0].indices.end());
    draw(scene.list(), view, out, {.planes = {}});
    int twice = 0;
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) {
            const int first = ascending[size_t(y) * size_t(view.width) + size_t(x)];
            twice += first + out.id.at(x, y) == kSpokes + 1 ? 0 : 1;
        }
    }
    CHECK(twice == 0);
}

TEST_CASE("limits: an empty list gives the background", "[limits]") {
    FrameView view;
    view.width = 70;
    view.height = 50;
    TestScene scene;
    DrawList list = scene.list();
    list.background = {0.25f, 0.5f, 20.0f};
    GBuffer out;
    draw(list, view, out);
    CHECK(coveredPixels(out) == 0);
    CHECK(out.red.at(69, 49) == 1024);
    CHECK(out.green.at(0, 0) == 2048);
    CHECK(out.blue.at(30, 30) == 65535);
    for (const TileFacts& facts : out.tiles) {
        CHECK(facts.still());
    }
}

TEST_CASE("limits: two rasterizers may take turns on one G-buffer", "[limits]") {
    FrameView view;
    view.width = 100;
    view.height = 80;
    TestScene scene;
    addFullTriangle(scene, view);
    FrameView moving = view;
    moving.view_projection_before = rigid(0, 0.01, 0, 0);
    const DrawList list = scene.list();
    Workers workers(1);
    Rasterizer first, second;
    GBuffer out, expected;
    draw(list, view, expected);
    for (const auto& [rasterizer, v] :
         {std::pair{&first, view}, {&second, moving}, {&first, view}}) {
        rasterizer->transformAndBin(list, v, {.planes = kAllPlanes}, workers);
        rasterizer->rasterize(out, workers);
    }
    CHECK(firstDifference(out, expected) == "");
}

TEST_CASE("limits: counters tell what became of the triangles", "[limits]") {
    Random random(6);
    const FrameView view = deepView(90, 70, random);
    TestScene scene;
    addDeep(scene, DeepKind::behind, random);
    scene.addTriangle({-1, -1, -3, {}}, {1, -1, -3, {}}, {0, 1, -3, {}});
    scene.addTriangle({-1, -1, -3, {}}, {1, -1, -3, {}}, {0, 4, 3, {}});
    const DrawList list = scene.list();
    Workers workers(1);
    Rasterizer rasterizer;
    rasterizer.transformAndBin(list, view, {}, workers);
    CHECK(rasterizer.counters().triangles == 3);
    CHECK(rasterizer.counters().clipped == 1);
    CHECK(rasterizer.counters().binned >= 2);
    CHECK(rasterizer.counters().tile_refs >= 2);
}

TEST_CASE("limits: counters tell what became of tiles, blocks and pixels", "[limits]") {
    FrameView view;
    view.width = 3 * kTileSize;
    view.height = kTileSize;
    TestScene scene;
    // Covers half of the middle tile, twice: the farther one second.
    for (const float z : {-0.5f, 0.5f}) {
        const float x = 1.0f / 3;
        scene.addTriangle({-x, -1, z, {}}, {x, -1, z, {}}, {-x, 1, z, {}});
    }
    const DrawList list = scene.list();
    Workers workers(2);
    Rasterizer rasterizer;
    GBuffer out;
    for (int frame = 0; frame < 2; ++frame) {  // counters are of one frame
        rasterizer.transformAndBin(list, view, {}, workers);
        rasterizer.rasterize(out, workers);
        const RasterCounters& counters = rasterizer.counters();
        CHECK(counters.tiles_empty == 2);
        const int seen = coveredPixels(out);
        CHECK(seen > kTileSize * kTileSize / 2 - kTileSize);
        CHECK(counters.pixels_shaded == uint64_t(seen));
        CHECK(counters.ticks.shade == 0);
        if (bestSimdTarget() != SimdTarget::scalar) {
            // All but the blocks on the diagonal are as much hidden as they are outside.
            CHECK(counters.blocks_hidden >= 28);
            CHECK(counters.blocks_outside >= 28);
        }
    }
}

TEST_CASE("limits: blocks count as hidden within a triangle's box, and nowhere else", "[limits]") {
    FrameView view;
    view.width = view.height = kTileSize;
    TestScene scene;
    const double far = 4 * kTileSize;
    scene.addTriangle(atPixel(view, -far, -far, 0.5), atPixel(view, -far, far, 0.5),
                      atPixel(view, far, far / 8, 0.5));
    // Columns 20 … 50 and rows 12 … 38, all of it behind.
    scene.addTriangle(atPixel(view, 20, 12, 0.25), atPixel(view, 20, 39, 0.25),
                      atPixel(view, 51, 12, 0.25));
    const DrawList list = scene.list();
    Workers workers(1);
    for (SimdTarget target : availableSimdTargets()) {
        Rasterizer rasterizer;
        GBuffer out;
        rasterizer.transformAndBin(list, view, {.simd = target, .planes = {}}, workers);
        rasterizer.rasterize(out, workers);
        REQUIRE(coveredPixels(out) == kTileSize * kTileSize);
        if (target != SimdTarget::scalar) {
            CAPTURE(name(target));
            CHECK(rasterizer.counters().blocks_hidden == 5 * 4);
            CHECK(rasterizer.counters().blocks_outside == 0);
        }
    }
}
