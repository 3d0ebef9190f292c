// Mip levels, alpha test and stochastic transparency, seen from outside.

#include <catch2/catch.hpp>
#include <cmath>

#include "rasterizer/fixed.h"
#include "rasterizer/texture_layout.h"
#include "tests/support/busy_scene.h"

using namespace still;
using namespace still::test;

namespace {

FrameView square(int size) {
    FrameView view;
    view.width = size;
    view.height = size;
    return view;
}

/// Fills the picture; the texture is repeated `tiles` times in each axis. Surface `depth` in 0 … 1.
void addScreen(TestScene& scene, const FrameView& view, double depth, float tiles,
               uint32_t material) {
    std::array<TestVertex, 4> c{atPixel(view, 0, view.height, depth),
                                atPixel(view, view.width, view.height, depth),
                                atPixel(view, view.width, 0, depth), atPixel(view, 0, 0, depth)};
    const float u[4] = {0, tiles, tiles, 0}, v[4] = {0, 0, tiles, tiles};
    for (size_t k = 0; k < 4; ++k) {
        c[k].attributes.u = u[k];
        c[k].attributes.v = v[k];
    }
    scene.addQuad(c, material);
}

Material textured() {
    Material m;
    m.diffuse = {1, 1, 1};
    m.colour_texture = 0;
    return m;
}

/// Level k is grey of linear light k / 8.
Texture numberedLevels(uint32_t size) {
    std::vector<std::array<uint32_t, 3>> colours;
    for (int level = 0; level <= 8; ++level) {
        const auto code = uint32_t(std::sqrt(level / 8.0) * 1023 + 0.5);
        colours.push_back({code, code, code});
    }
    return levelTexture(size, colours, Wrap::repeat);
}

double levelAt(const GBuffer& out, int x, int y) {
    return out.red.at(x, y) * 8.0 / kColourOne;
}

int covered(const GBuffer& out, uint16_t surface) {
    int count = 0;
    for (int y = 0; y < out.height(); ++y) {
        for (int x = 0; x < out.width(); ++x) {
            count += (out.id.at(x, y) & kSurfaceMask) == surface ? 1 : 0;
        }
    }
    return count;
}

}  // namespace

TEST_CASE("texture: a texel per pixel takes level 0, each halving the next level", "[texture]") {
    const FrameView view = square(128);
    for (int level = 0; level <= 8; ++level) {
        TestScene scene;
        scene.textures = {numberedLevels(256)};
        scene.materials = {textured()};
        addScreen(scene, view, 0.5, std::exp2(float(level)) / 2, 0);
        GBuffer out;
        draw(scene.list(), view, out);
        CAPTURE(level);
        CHECK(levelAt(out, 64, 64) == Approx(level).margin(0.05));
        CHECK(levelAt(out, 3, 100) == Approx(level).margin(0.05));
    }
}

TEST_CASE("texture: levels between are blended, magnification stays at level 0", "[texture]") {
    const FrameView view = square(128);
    const auto level_for = [&](double texels_per_pixel) {
        TestScene scene;
        scene.textures = {numberedLevels(256)};
        scene.materials = {textured()};
        addScreen(scene, view, 0.5, float(texels_per_pixel / 2), 0);
        GBuffer out;
        draw(scene.list(), view, out);
        return levelAt(out, 70, 30);
    };
    CHECK(level_for(0.1) == Approx(0).margin(0.01));
    CHECK(level_for(1.5) == Approx(std::log2(1.5)).margin(0.05));
    CHECK(level_for(3.0) == Approx(std::log2(3.0)).margin(0.05));
    CHECK(level_for(1e5) == Approx(8).margin(0.01));
}

TEST_CASE("texture: levels grow with distance on a floor", "[texture]") {
    FrameView view = square(128);
    view.view_projection = perspective(1.5, 1, 0.1, 1000);
    view.view_projection_before = view.view_projection;
    TestScene scene;
    scene.textures = {numberedLevels(256)};
    scene.materials = {textured()};
    std::array<TestVertex, 4> c{
        TestVertex{-90, -1, -0.5f}, {90, -1, -0.5f}, {90, -1, -300}, {-90, -1, -300}};
    for (TestVertex& v : c) {
        v.attributes = {0, 1, 0, v.x, v.z};
    }
    scene.addQuad(c);
    GBuffer out;
    draw(scene.list(), view, out);
    for (int y = 67; y < 127; ++y) {
        CAPTURE(y);
        CHECK(levelAt(out, 64, y) >= levelAt(out, 64, y + 1) - 0.01);
    }
    // Row y sees the floor at distance d = 1.5 · 64 / (y + ½ − 64); along it a pixel is d² / 96
    // long.
    const double d = 96.0 / (100.5 - 64);
    CHECK(levelAt(out, 64, 100) == Approx(std::log2(d * d / 96 * 256)).margin(0.1));
}

TEST_CASE("texture: bilinear filtering is exact at and between texel centres", "[texture]") {
    const FrameView view = square(64);
    TestScene scene;
    Texture t;
    t.wrap = Wrap::repeat;
    t.levels = {{2, 1, 0, 0}, {1, 1, 0, 0}};
    t.texels = {0, 1023, 511};
    layOut(t);
    scene.textures = {t};
    scene.materials = {textured()};
    addScreen(scene, view, 0.5, 1, 0);
    GBuffer out;
    draw(scene.list(), view, out);
    // Texel centres at pixels 16 and 48; u runs from dark to light between them, and back around.
    CHECK(out.red.at(32, 10) / 4096.0 == Approx(0.5 + 0.5 / 32).margin(0.002));
    CHECK(out.red.at(16, 10) / 4096.0 == Approx(0.5 / 32).margin(0.002));
    CHECK(out.red.at(63, 10) / 4096.0 == Approx(0.5 + 0.5 / 32).margin(0.002));
    CHECK(out.red.at(0, 10) / 4096.0 == Approx(0.5 - 0.5 / 32).margin(0.002));
}

TEST_CASE("texture: clamp holds the border, repeat does not", "[texture]") {
    const FrameView view = square(64);
    for (Wrap wrap : {Wrap::clamp, Wrap::repeat}) {
        TestScene scene;
        Texture t;
        t.wrap = wrap;
        t.levels = {{2, 1, 0, 0}, {1, 1, 0, 0}};
        t.texels = {0, 1023, 511};
        layOut(t);
        scene.textures = {t};
        scene.materials = {textured()};
        addScreen(scene, view, 0.5, 2, 0);
        GBuffer out;
        draw(scene.list(), view, out);
        CHECK((out.red.at(40, 10) > 4090) == (wrap == Wrap::clamp));
    }
}

TEST_CASE("texture: v grows upwards, row 0 is the top", "[texture]") {
    const FrameView view = square(64);
    TestScene scene;
    Texture t;
    t.wrap = Wrap::clamp;
    t.levels = {{1, 2, 0, 0}, {1, 1, 0, 0}};
    t.texels = {1023, 0, 511};
    layOut(t);
    scene.textures = {t};
    scene.materials = {textured()};
    addScreen(scene, view, 0.5, 1, 0);
    GBuffer out;
    draw(scene.list(), view, out);
    CHECK(out.red.at(30, 2) > 4090);
    CHECK(out.red.at(30, 61) < 5);
}

TEST_CASE("alpha test: samples exist where alpha reaches one half", "[alpha]") {
    const FrameView view = square(64);
    TestScene scene;
    AlphaTexture alpha;
    alpha.wrap = Wrap::clamp;
    alpha.levels = {{2, 1, 0, 0}, {1, 1, 0, 0}};
    alpha.texels = {0, 255, 127};
    layOut(alpha);
    scene.alpha_textures = {alpha};
    Material holes;
    holes.alpha_mode = AlphaMode::test;
    holes.alpha_texture = 0;
    scene.materials = {holes, Material{}};
    addScreen(scene, view, 0.7, 1, 0);
    addScreen(scene, view, 0.2, 1, 1);
    GBuffer out;
    draw(scene.list(), view, out);
    int wrong = 0;
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            wrong += out.id.at(x, y) == (x < 32 ? 2 : 1) ? 0 : 1;
        }
    }
    CHECK(wrong == 0);
}

TEST_CASE("alpha test: full and empty textures keep and drop everything", "[alpha]") {
    const FrameView view = square(100);
    const uint8_t value = GENERATE(0, 127, 128, 255);
    TestScene scene;
    scene.alpha_textures = {constantAlpha(16, value)};
    Material m;
    m.alpha_mode = AlphaMode::test;
    m.alpha_texture = 0;
    scene.materials = {m};
    addScreen(scene, view, 0.5, 3, 0);
    GBuffer out;
    draw(scene.list(), view, out);
    CHECK(covered(out, 1) == (value >= 128 ? 100 * 100 : 0));
}

TEST_CASE("stochastic: the share of samples is the opacity", "[alpha]") {
    const FrameView view = square(80);
    const float opacity = GENERATE(0.0f, 0.1f, 0.5f, 0.77f, 1.0f);
    TestScene scene;
    Material m;
    m.alpha_mode = AlphaMode::stochastic;
    m.opacity = opacity;
    scene.materials = {m};
    addScreen(scene, view, 0.5, 1, 0);
    std::vector<int> hits(80 * 80, 0);
    constexpr int kSamples = 64;
    int total = 0;
    for (int sample = 0; sample < kSamples; ++sample) {
        FrameView now = view;
        now.sample = uint32_t(sample);
        GBuffer out;
        draw(scene.list(), now, out);
        for (int k = 0; k < 80 * 80; ++k) {
            hits[size_t(k)] += out.id.at(k % 80, k / 80) != 0 ? 1 : 0;
        }
        const int count = covered(out, 1);
        total += count;
        CHECK(count / 6400.0 == Approx(double(opacity)).margin(0.04));
    }
    CHECK(total / 6400.0 / kSamples == Approx(double(opacity)).margin(0.004));
    // Each pixel by itself converges, too: otherwise accumulation would freeze its noise.
    double worst = 0;
    for (int hit : hits) {
        worst = std::max(worst, std::abs(hit / double(kSamples) - double(opacity)));
    }
    CHECK(worst < 0.08);
}

TEST_CASE("stochastic: two panes are independent of each other", "[alpha]") {
    const FrameView view = square(80);
    TestScene scene;
    Material m;
    m.alpha_mode = AlphaMode::stochastic;
    m.opacity = 0.5f;
    scene.materials = {m, Material{}};
    addScreen(scene, view, 0.8, 1, 0);
    addScreen(scene, view, 0.6, 1, 0);
    addScreen(scene, view, 0.2, 1, 1);
    double shares[4] = {};
    for (uint32_t sample = 0; sample < 64; ++sample) {
        FrameView now = view;
        now.sample = sample;
        GBuffer out;
        draw(scene.list(), now, out);
        for (uint16_t surface = 0; surface < 4; ++surface) {
            shares[surface] += covered(out, surface) / 6400.0 / 64;
        }
    }
    CHECK(shares[0] == 0);
    CHECK(shares[1] == Approx(0.5).margin(0.01));
    CHECK(shares[2] == Approx(0.25).margin(0.02));
    CHECK(shares[3] == Approx(0.25).margin(0.02));
}
