// Height maps, seen from outside.

#include <catch2/catch.hpp>
#include <cmath>

#include "rasterizer/fixed.h"
#include "rasterizer/texture_layout.h"
#include "tests/support/busy_scene.h"
#include "tests/support/plane_compare.h"

using namespace still;
using namespace still::test;

namespace {

constexpr int kSize = 96;
constexpr uint32_t kTexels = 64;

/// So far away that all rays are parallel: towards (3, 1, 4) / √26.
FrameView slantedView() {
    FrameView view;
    view.width = view.height = kSize;
    view.eye = {3e6f, 1e6f, 4e6f};
    return view;
}

/// Red rises with u and green with v, from 0 to 1 in linear light.
Texture ramps() {
    Texture t;
    t.wrap = Wrap::clamp;
    t.levels = {{kTexels, kTexels, 0, 0}};
    for (uint32_t y = 0; y < kTexels; ++y) {
        for (uint32_t x = 0; x < kTexels; ++x) {
            const auto code = [](double share) { return uint32_t(std::sqrt(share) * 1023 + 0.5); };
            t.texels.push_back(code((x + 0.5) / kTexels) | code(1 - (y + 0.5) / kTexels) << 10);
        }
    }
    layOut(t);
    return t;
}

/// height(u) in 0 … 1, the same for all v.
template <class Height>
AlphaTexture ridges(Height&& height) {
    AlphaTexture t;
    t.levels = {{256, 1, 0, 0}};
    for (int x = 0; x < 256; ++x) {
        t.texels.push_back(uint8_t(std::lround(height((x + 0.5) / 256) * 255)));
    }
    layOut(t);
    return t;
}

/// Fills the picture; u and v run over its middle, 0.25 … 0.75. Texture 0 shows coordinates as
/// colours, height map 0 is `height`.
TestScene plate(const FrameView& view, AlphaTexture height, float height_scale) {
    TestScene scene;
    scene.textures = {ramps()};
    scene.alpha_textures = {std::move(height)};
    scene.materials[0].diffuse = {1, 1, 1};
    scene.materials[0].colour_texture = 0;
    scene.materials[0].height_texture = 0;
    scene.materials[0].height_scale = height_scale;
    std::array<TestVertex, 4> c{atPixel(view, 0, view.height, 0.5),
                                atPixel(view, view.width, view.height, 0.5),
                                atPixel(view, view.width, 0, 0.5), atPixel(view, 0, 0, 0.5)};
    for (TestVertex& v : c) {
        v.attributes.u = 0.5f + 0.25f * v.x;
        v.attributes.v = 0.5f + 0.25f * v.y;
    }
    scene.addQuad(c);
    scene.meshes[0].tangents.assign(4, {1, 0, 0, 1});
    return scene;
}

GBuffer drawn(TestScene& scene, const FrameView& view) {
    GBuffer out;
    draw(scene.list(), view, out);
    return out;
}

/// Texture coordinates of a pixel's centre on the plate.
double coordinate(int pixel) {
    return 0.25 + 0.5 * (pixel + 0.5) / kSize;
}

double linear(const Image<uint16_t>& plane, int x, int y) {
    return plane.at(x, y) / double(kColourOne);
}

}  // namespace

TEST_CASE("parallax: ground at full height shows the plain surface", "[parallax]") {
    const FrameView view = slantedView();
    TestScene scene = plate(view, constantAlpha(16, 255), 0.2f);
    const GBuffer mapped = drawn(scene, view);
    scene.materials[0].height_texture = kNoTexture;
    CHECK(firstDifference(mapped, drawn(scene, view)) == "");
}

TEST_CASE("parallax: ground at a constant depth is shifted along the ray", "[parallax]") {
    const FrameView view = slantedView();
    const uint8_t height = GENERATE(0, 1, 100, 254);
    TestScene scene = plate(view, constantAlpha(16, height), 0.1f);
    const GBuffer out = drawn(scene, view);
    const double depth = (1 - height / 255.0) * 0.1;
    double worst = 0;
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            const double u = coordinate(x) - depth * 3 / 4;
            const double v = 1 - coordinate(y) - depth * 1 / 4;
            worst = std::max({worst, std::abs(linear(out.red, x, y) - u),
                              std::abs(linear(out.green, x, y) - v)});
        }
    }
    CHECK(worst < 0.002);  // the ramps' own codes
}

TEST_CASE("parallax: on smooth ground the crossing is that of a fine search", "[parallax]") {
    const FrameView view = slantedView();
    const auto height = [](double u) { return 0.5 + 0.4 * std::sin(u * 4 * 6.283185307179586); };
    TestScene scene = plate(view, ridges(height), 0.08f);
    const GBuffer out = drawn(scene, view);
    double worst = 0;
    for (int x = 0; x < kSize; ++x) {
        const auto along = [&](double d) { return coordinate(x) - d * 0.08 * 3 / 4; };
        double d = 0;
        while (1 - height(along(d)) > d) {
            d += 1e-4;
        }
        worst = std::max(worst, std::abs(linear(out.red, x, kSize / 2) - along(d)));
    }
    CHECK(worst < 0.08 * 3 / 4 / 16);  // within a step; interpolation does better nearly everywhere
}

TEST_CASE("parallax: grazing rays are held at eight times the height", "[parallax]") {
    FrameView view = slantedView();
    view.eye = {1e7f, 0, 1};
    TestScene scene = plate(view, constantAlpha(16, 0), 0.02f);
    const GBuffer out = drawn(scene, view);
    CHECK(linear(out.red, 70, 40) == Approx(coordinate(70) - 8 * 0.02).margin(0.002));
}

TEST_CASE("parallax: the ground lies behind the side that is seen", "[parallax]") {
    FrameView view = slantedView();
    view.eye.z = -view.eye.z;
    view.view_projection[0][0] = view.view_projection_before[0][0] =
        -1;  // seen from the other side
    TestScene scene = plate(view, constantAlpha(16, 0), 0.1f);
    const double u = coordinate(kSize - 1 - 70) - 0.1 * 3 / 4;
    for (float outward : {-1.0f, 1.0f}) {
        for (VertexAttributes& a : scene.meshes[0].attributes) {
            a.nz = outward;
        }
        const GBuffer out = drawn(scene, view);
        CAPTURE(outward);
        CHECK(linear(out.red, 70, 40) == Approx(u).margin(0.002));
    }
}

TEST_CASE("parallax: alpha is tested where the ray meets the ground", "[parallax]") {
    const FrameView view = slantedView();
    TestScene scene = plate(view, constantAlpha(16, 0), 0.1f);
    scene.alpha_textures.push_back(ridges([](double u) { return u < 0.5 ? 0.0 : 1.0; }));
    scene.materials[0].alpha_texture = 1;
    scene.materials[0].alpha_mode = AlphaMode::test;
    const GBuffer out = drawn(scene, view);
    const int edge = int(kSize / 2 + 0.1 * 3 / 4 * 2 * kSize);
    CHECK(out.id.at(edge - 2, 30) == 0);
    CHECK(out.id.at(edge + 2, 30) == 1);
}

TEST_CASE("parallax: a mesh without tangents is plain", "[parallax]") {
    const FrameView view = slantedView();
    TestScene scene = plate(view, constantAlpha(16, 0), 0.1f);
    scene.meshes[0].tangents.clear();
    CHECK(linear(drawn(scene, view).red, 70, 40) == Approx(coordinate(70)).margin(0.002));
}

TEST_CASE("parallax: a mirrored instance shows what a mirrored mesh shows", "[parallax]") {
    const FrameView view = slantedView();
    const auto mapped = [&] {
        TestScene scene =
            plate(view, ridges([](double u) { return 0.5 + 0.3 * std::sin(u * 25); }), 0.1f);
        // A normal map that leans towards +v.
        Texture leaning = levelTexture(4, {{511, 800, 900}}, Wrap::repeat);
        scene.textures.push_back(std::move(leaning));
        scene.materials[0].normal_texture = 1;
        scene.lighting.sun = {{0.48f, 0.6f, -0.64f}, {0.7f, 0.7f, 0.7f}};
        return scene;
    };
    TestScene by_instance = mapped();
    by_instance.instances[0].transform[0] = -1;
    by_instance.instances[0].transform_before = by_instance.instances[0].transform;
    TestScene by_mesh = mapped();
    for (float& x : by_mesh.meshes[0].x) {
        x = -x;
    }
    by_mesh.meshes[0].tangents.assign(4, {-1, 0, 0, -1});
    CHECK(firstDifference(drawn(by_instance, view), drawn(by_mesh, view)) == "");
}
