// Moving everything by whole pixels moves the picture; a smaller target is a crop of a larger one.

#include <bit>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/random_triangles.h"

using namespace still;
using namespace still::test;

namespace {

/// The same scene in multiples of 1/256 px: adding whole pixels is then exact in float.
/// Precondition: width and height are powers of two.
void onGrid(TestScene& scene, const FrameView& view) {
    for (Mesh& mesh : scene.meshes) {
        for (float& x : mesh.x) {
            x = std::round(x * float(128 * view.width)) / float(128 * view.width);
        }
        for (float& y : mesh.y) {
            y = std::round(y * float(128 * view.height)) / float(128 * view.height);
        }
    }
}

TestScene randomScene(const FrameView& view, uint64_t seed) {
    Random random(seed);
    TestScene scene;
    for (int k = 0; k < 40; ++k) {
        const std::array kinds{FlatKind::ordinary, FlatKind::sliver, FlatKind::sub_pixel,
                               FlatKind::on_samples};
        addFlat(scene, view, kinds[size_t(k) % kinds.size()], random);
    }
    onGrid(scene, view);
    return scene;
}

/// Planes are evaluated elsewhere in the picture, so depth may differ by their rounding, which is
/// much for slivers, whose planes are steep.
bool sameDepth(uint32_t a, uint32_t b) {
    return std::abs(std::bit_cast<float>(a) - std::bit_cast<float>(b)) <= 1e-4f;
}

struct Differences {
    int pixels = 0, ids = 0, depths = 0;
};

/// Compares a at (x, y) with b at (x + dx, y + dy) where both exist.
Differences compareShifted(const GBuffer& a, const GBuffer& b, int dx, int dy) {
    Differences d;
    for (int y = 0; y < a.height(); ++y) {
        for (int x = 0; x < a.width(); ++x) {
            const int bx = x + dx, by = y + dy;
            if (bx < 0 || by < 0 || bx >= b.width() || by >= b.height()) {
                continue;
            }
            ++d.pixels;
            d.ids += a.id.at(x, y) != b.id.at(bx, by) ? 1 : 0;
            d.depths += !sameDepth(a.depth.at(x, y), b.depth.at(bx, by)) ? 1 : 0;
        }
    }
    return d;
}

}  // namespace

TEST_CASE("shift: a scene moved by whole pixels gives the moved picture", "[coverage]") {
    FrameView view;
    view.width = 256;
    view.height = 128;
    view.jitter_x_fx8 = 37;
    view.jitter_y_fx8 = -90;
    for (const auto& [dx, dy] : {std::array{1, 0}, {0, 1}, {-7, 13}, {64, -64}, {100, 31}}) {
        TestScene scene = randomScene(view, uint64_t(dx + 200));
        GBuffer at_home, moved;
        draw(scene.list(), view, at_home);
        for (float& x : scene.meshes[0].x) {
            x += float(2 * dx) / float(view.width);
        }
        for (float& y : scene.meshes[0].y) {
            y -= float(2 * dy) / float(view.height);
        }
        draw(scene.list(), view, moved);
        const Differences d = compareShifted(at_home, moved, dx, dy);
        CAPTURE(dx, dy);
        CHECK(d.pixels > 1000);
        CHECK(d.ids == 0);
        CHECK(d.depths == 0);
    }
}

TEST_CASE("shift: jitter moves the sample as moving the scene the other way does", "[coverage]") {
    FrameView view;
    view.width = 128;
    view.height = 128;
    TestScene scene = randomScene(view, 3);
    view.jitter_x_fx8 = 100;
    view.jitter_y_fx8 = -128;
    GBuffer jittered, moved;
    draw(scene.list(), view, jittered);
    for (float& x : scene.meshes[0].x) {
        x -= 100.0f / float(128 * view.width);
    }
    for (float& y : scene.meshes[0].y) {
        y += -128.0f / float(128 * view.height);
    }
    view.jitter_x_fx8 = view.jitter_y_fx8 = 0;
    draw(scene.list(), view, moved);
    CHECK(compareShifted(jittered, moved, 0, 0).ids == 0);
}

TEST_CASE("shift: a smaller target is the crop of a larger one", "[coverage]") {
    FrameView large;
    large.width = 256;
    large.height = 256;
    TestScene scene = randomScene(large, 4);
    GBuffer whole;
    draw(scene.list(), large, whole);
    FrameView small = large;
    small.width = 128;
    small.height = 64;
    // The same pixels around the centre: a narrower field of view, scaled by powers of two.
    small.view_projection[0][0] = 2;
    small.view_projection[1][1] = 4;
    small.view_projection_before = small.view_projection;
    GBuffer crop;
    draw(scene.list(), small, crop);
    const Differences d = compareShifted(crop, whole, 64, 96);
    CHECK(d.pixels == 128 * 64);
    CHECK(d.ids == 0);
    CHECK(d.depths == 0);
}
