// Offsets of texture coordinates, seen from outside.

#include <catch2/catch.hpp>

#include "rasterizer/texture_layout.h"
#include "tests/support/busy_scene.h"
#include "tests/support/plane_compare.h"

using namespace still;
using namespace still::test;

namespace {

/// A square picture whose texture coordinates run from `u` to u + 1 and from `v` to v + 1.
TestScene screen(const FrameView& view, float u, float v, uint32_t material = 0) {
    TestScene scene;
    std::array<TestVertex, 4> c{atPixel(view, 0, view.height, 0.5),
                                atPixel(view, view.width, view.height, 0.5),
                                atPixel(view, view.width, 0, 0.5), atPixel(view, 0, 0, 0.5)};
    const float du[4] = {0, 1, 1, 0}, dv[4] = {0, 0, 1, 1};
    for (size_t k = 0; k < 4; ++k) {
        c[k].attributes.u = u + du[k];
        c[k].attributes.v = v + dv[k];
    }
    scene.addQuad(c, material);
    return scene;
}

/// 8 × 8 texels, all different; the chain has one level only.
Texture numberedTexels() {
    Texture t;
    t.levels = {{8, 8, 0, 0}};
    for (uint32_t k = 0; k < 64; ++k) {
        t.texels.push_back(k * 16 | (k * 7 % 64 * 16) << 10 | (k * 29 % 64 * 16) << 20);
    }
    layOut(t);
    return t;
}

AlphaTexture numberedAlpha() {
    AlphaTexture t;
    t.levels = {{8, 8, 0, 0}};
    for (uint32_t k = 0; k < 64; ++k) {
        t.texels.push_back(uint8_t(k * 37 % 64 * 4));
    }
    layOut(t);
    return t;
}

FrameView square(int size) {
    FrameView view;
    view.width = size;
    view.height = size;
    return view;
}

}  // namespace

TEST_CASE("offset: it shows what texture coordinates moved by it show", "[texture]") {
    const FrameView view = square(64);
    Material material;
    material.diffuse = {1, 1, 1};
    material.colour_texture = 0;
    material.alpha_texture = 0;
    material.alpha_mode = AlphaMode::test;
    // Eighths: exact in the mesh, in the offset and in their sum.
    for (const auto& [u, v] : {std::pair{0.125f, 0.0f}, {0.0f, 0.5f}, {0.875f, -0.25f}}) {
        CAPTURE(u, v);
        GBuffer by_offset, by_mesh;
        TestScene scene = screen(view, 0, 0);
        scene.textures = {numberedTexels()};
        scene.alpha_textures = {numberedAlpha()};
        scene.materials = {material};
        scene.materials[0].u_offset = u;
        scene.materials[0].v_offset = v;
        draw(scene.list(), view, by_offset);
        TestScene moved = screen(view, u, v);
        moved.textures = scene.textures;
        moved.alpha_textures = scene.alpha_textures;
        moved.materials = {material};
        draw(moved.list(), view, by_mesh);
        CHECK(firstDifference(by_offset, by_mesh) == "");
    }
}

TEST_CASE("offset: a whole repeat shows the same bytes", "[texture]") {
    const FrameView view = square(64);
    GBuffer rest, repeated;
    TestScene scene = screen(view, 0, 0);
    scene.textures = {numberedTexels()};
    scene.materials[0].colour_texture = 0;
    draw(scene.list(), view, rest);
    scene.materials[0].u_offset = 1.0f;
    scene.materials[0].v_offset = -1.0f;
    draw(scene.list(), view, repeated);
    CHECK(firstDifference(rest, repeated) == "");
}

TEST_CASE("offset: mip levels stay those of the mesh", "[texture]") {
    // Every level has a colour of its own, so any other choice of level would show.
    const FrameView view = square(48);
    TestScene scene = screen(view, 0, 0);
    scene.textures = {levelTexture(256, {{0, 0, 0}, {300, 90, 9}, {600, 180, 18}, {1023, 270, 27}},
                                   Wrap::repeat)};
    scene.materials[0].colour_texture = 0;
    GBuffer rest, moved;
    draw(scene.list(), view, rest);
    scene.materials[0].u_offset = 0.3337f;
    scene.materials[0].v_offset = 0.777f;
    draw(scene.list(), view, moved);
    CHECK(firstDifference(rest, moved) == "");
}
