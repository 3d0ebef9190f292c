#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "engine/internal/mtl_parse.h"
#include "engine/internal/mtl_textures.h"
#include "engine/internal/obj_text.h"
#include "tests/support/data_path.h"
#include "tests/support/texels.h"

using namespace still;

namespace {

using Colour = std::array<float, 3>;
using Pixel = std::array<int, 4>;

MtlMaterial parseOne(const std::string& body) {
    std::vector<std::string> warnings;
    const auto materials = parseMtl("newmtl m\n" + body + "\n", "test.mtl", warnings);
    REQUIRE(materials.size() == 1);
    CHECK(warnings.empty());
    return materials[0];
}

/// A 2 × 1 TGA with alpha.
std::string tga(Pixel left, Pixel right) {
    std::string bytes{0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 1, 0, 32, 8};
    for (const Pixel& p : {left, right}) {
        bytes += {char(p[2]), char(p[1]), char(p[0]), char(p[3])};
    }
    return bytes;
}

/// Materials of an MTL text in `folder`, one source per block.
MaterialSet build(const TempFolder& folder, const std::string& text) {
    const auto path = folder.write("test.mtl", text);
    std::vector<std::string> warnings;
    std::vector<MtlSource> sources;
    for (const MtlMaterial& m : parseMtl(text, path.string(), warnings)) {
        sources.push_back({m, path});
    }
    InputLog log;
    return buildMaterials(sources, log);
}

}  // namespace

TEST_CASE("mtl: numbers are read and clamped", "[unit][engine]") {
    const MtlMaterial m =
        parseOne("Kd 0.1 0.2 0.3\nKs .5 .5 .5\nKe 2 0 0\nNs 5000\nd 0.25\nKa 1 1 1\nillum 2");
    CHECK(m.diffuse == Colour{0.1f, 0.2f, 0.3f});
    CHECK(m.specular == Colour{0.5f, 0.5f, 0.5f});
    CHECK(m.emission == Colour{2, 0, 0});
    CHECK(m.shininess == 1024.0f);
    CHECK(m.opacity == 0.25f);
    CHECK(parseOne("Ns 0").shininess == 1.0f);
    CHECK(parseOne("d 7").opacity == 1.0f);
    CHECK(parseOne("d -halo 0.5").opacity == 0.5f);
    CHECK(parseOne("Kd 0.5").diffuse == Colour{0.5f, 0.5f, 0.5f});
    CHECK(parseOne("Kd -1 2 0").diffuse == Colour{0, 2, 0});
}

TEST_CASE("mtl: d wins over Tr whatever the order", "[unit][engine]") {
    CHECK(parseOne("Tr 0.25").opacity == 0.75f);
    CHECK(parseOne("Tr 0.25\nd 0.5").opacity == 0.5f);
    CHECK(parseOne("d 0.5\nTr 0.25").opacity == 0.5f);
}

TEST_CASE("mtl: without Kd a material is grey, or white under its image", "[unit][engine]") {
    CHECK(parseOne("Ns 3").diffuse == Colour{0.8f, 0.8f, 0.8f});
    CHECK(parseOne("map_Kd a.png").diffuse == Colour{1, 1, 1});
    std::vector<std::string> warnings;
    const auto two = parseMtl("newmtl a\nKd 0 0 0\nnewmtl b\nmap_Kd b.png", "x.mtl", warnings);
    CHECK(two[1].diffuse == Colour{1, 1, 1});
}

TEST_CASE("mtl: broken numbers give a warning and the default", "[unit][engine]") {
    std::vector<std::string> warnings;
    const auto m = parseMtl("newmtl a\nKd nan 0 0\nNs x\nd inf\nKs 1 2", "x.mtl", warnings);
    REQUIRE(m.size() == 1);
    CHECK(m[0].diffuse == Colour{0.8f, 0.8f, 0.8f});
    CHECK(m[0].shininess == 10.0f);
    CHECK(m[0].opacity == 1.0f);
    CHECK(warnings.size() == 4);
    CHECK(warnings[0] == "x.mtl:2: \"nan\" is not a finite number, the default is used");
}

TEST_CASE("mtl: image statements with options", "[unit][engine]") {
    CHECK(parseOne("map_Kd a b.png").map_kd.file == "a b.png");
    CHECK(parseOne("map_Kd -clamp on a.png").map_kd.clamp);
    CHECK_FALSE(parseOne("map_Kd -clamp off a.png").map_kd.clamp);
    CHECK(parseOne("map_d -clamp on -blendu off m.png").map_d.file == "m.png");
    CHECK(parseOne("bump -bm 2.5 b.png").bump.bump_scale == 2.5f);
    CHECK(parseOne("map_Bump -bm 0.5 b.png").bump.file == "b.png");
    CHECK(parseOne("norm n.png").norm.file == "n.png");
    for (const char* options : {"-o 0.1", "-o 0.1 0.2", "-s 2 2 2", "-t 1", "-s 2 -clamp on"}) {
        INFO(options);
        const MtlMaterial m = parseOne("map_Kd " + std::string(options) + " a b.png");
        CHECK(m.map_kd.file == "a b.png");
        CHECK(m.map_kd.moved);
    }
    CHECK_FALSE(parseOne("map_Kd -s 1 1 1 -o 0 a.png").map_kd.moved);
    CHECK(parseOne("map_Kd").map_kd.file.empty());
    CHECK(parseOne("map_Kd -s").map_kd.file.empty());
}

TEST_CASE("mtl: names with blanks, indented lines, comments, statements before newmtl",
          "[unit][engine]") {
    std::vector<std::string> warnings;
    const auto m = parseMtl("Kd 1 0 0\n# c\n\n  newmtl  dark  red \r\n\tKd 1 0 0\r\nnewmtl\n",
                            "x.mtl", warnings);
    REQUIRE(m.size() == 1);
    CHECK(m[0].name == "dark  red");
    CHECK(m[0].diffuse == Colour{1, 0, 0});
    CHECK(parseMtl("", "x.mtl", warnings).empty());
    CHECK(parseMtl(std::string("\0\0newmtl\0", 9), "x.mtl", warnings).empty());
}

TEST_CASE("materials: alpha comes from map_d, else from map_Kd, else from nowhere",
          "[unit][engine]") {
    const TempFolder folder;
    folder.write("rgba.tga", tga({10, 20, 30, 255}, {10, 20, 30, 0}));
    folder.write("opaque.tga", tga({10, 20, 30, 255}, {10, 20, 30, 255}));
    folder.write("mask.tga", tga({0, 0, 0, 255}, {200, 200, 200, 255}));
    folder.write("mask_in_alpha.tga", tga({255, 255, 255, 7}, {255, 255, 255, 9}));
    folder.write("white.tga", tga({255, 255, 255, 255}, {255, 255, 255, 255}));
    const MaterialSet set = build(folder,
                                  "newmtl a\nmap_Kd rgba.tga\n"
                                  "newmtl b\nmap_Kd opaque.tga\n"
                                  "newmtl c\nmap_Kd rgba.tga\nmap_d mask.tga\n"
                                  "newmtl d\nmap_Kd rgba.tga\nmap_d mask_in_alpha.tga\n"
                                  "newmtl e\nmap_Kd rgba.tga\nmap_d white.tga\n"
                                  "newmtl f\nmap_Kd rgba.tga\nd 0.5\n"
                                  "newmtl g\nmap_Kd opaque.tga\nd 0.5\n"
                                  "newmtl h\nmap_Kd rgba.tga\nmap_d missing.tga\n");
    const auto alpha = [&](size_t m) {
        const int32_t number = set.materials[m].alpha_texture;
        return number == kNoTexture
                   ? Pixel{-1, -1}
                   : Pixel{test::texelAt(set.alpha_textures[size_t(number)], 0, 0, 0),
                           test::texelAt(set.alpha_textures[size_t(number)], 0, 1, 0)};
    };
    CHECK(alpha(0) == Pixel{255, 0});
    CHECK(set.materials[0].alpha_mode == AlphaMode::test);
    CHECK(alpha(1) == Pixel{-1, -1});
    CHECK(set.materials[1].alpha_mode == AlphaMode::opaque);
    CHECK(alpha(2) == Pixel{0, 200});
    CHECK(alpha(3) == Pixel{7, 9});
    CHECK(alpha(4) == Pixel{-1, -1});
    CHECK(alpha(5) == Pixel{255, 0});
    CHECK(set.materials[5].alpha_mode == AlphaMode::stochastic);
    CHECK(alpha(6) == Pixel{-1, -1});
    CHECK(set.materials[6].alpha_mode == AlphaMode::stochastic);
    CHECK(alpha(7) == Pixel{255, 0});
    CHECK(set.warnings.size() == 1);
    // The same file used in the same way is one texture.
    CHECK(set.materials[0].colour_texture == set.materials[2].colour_texture);
    CHECK(set.textures.size() == 2);
}

TEST_CASE("materials: a grey bump map is a height, a coloured one a normal map", "[unit][engine]") {
    const TempFolder folder;
    folder.write("grey.tga", tga({100, 100, 100, 255}, {100, 100, 100, 255}));
    folder.write("blue.tga", tga({128, 128, 255, 255}, {255, 128, 128, 255}));
    const MaterialSet set =
        build(folder,
              "newmtl a\nbump grey.tga\nnewmtl b\nbump blue.tga\n"
              "newmtl c\nnorm grey.tga\nbump blue.tga\n"
              "newmtl d\nbump -bm 3 grey.tga\nnewmtl e\nbump -clamp on grey.tga");
    const auto texel = [&](size_t m, uint32_t x) {
        return test::texelAt(set.textures.at(size_t(set.materials[m].normal_texture)), 0, x, 0);
    };
    CHECK(texel(0, 0) == (512u | 512u << 10 | 1023u << 20));
    CHECK((texel(1, 1) & 1023) == 1023);
    CHECK((texel(2, 0) >> 20) == 401);
    CHECK(set.textures.size() == 5);
    CHECK(set.textures[size_t(set.materials[4].normal_texture)].wrap == Wrap::clamp);
}

TEST_CASE("materials: missing and broken images are warned about once each", "[unit][engine]") {
    const TempFolder folder;
    folder.write("broken.png", "this is no image");
    folder.write("sub/my image.tga", tga({1, 2, 3, 255}, {1, 2, 3, 255}));
    const MaterialSet set = build(folder,
                                  "newmtl a\nmap_Kd none.png\nmap_d none.png\n"
                                  "newmtl b\nmap_Kd broken.png\nnewmtl c\nmap_Kd broken.png\n"
                                  "newmtl d\nmap_Kd sub\\my image.tga\n"
                                  "newmtl e\nmap_Kd \"sub/my image.tga\"\n"
                                  "newmtl f\nmap_Kd C:\\work\\sub\\broken.png\n"
                                  "newmtl g\nmap_Kd -s 2 2 sub/my image.tga\n"
                                  "newmtl h\nmap_Kd sub/my image.tga -s 2 2\n");
    REQUIRE(set.warnings.size() == 3);
    CHECK(isOneLineAbout(set.warnings[0], "none.png"));
    CHECK(isOneLineAbout(set.warnings[1], "test.mtl"));
    CHECK(isOneLineAbout(set.warnings[2], "broken.png"));
    CHECK(set.materials[0].colour_texture == kNoTexture);
    CHECK(set.materials[1].colour_texture == kNoTexture);
    for (const size_t m : {3u, 4u, 6u, 7u}) {
        CHECK(set.materials[m].colour_texture == 0);
    }
}

TEST_CASE("materials: the three ways to give the tree's alpha agree", "[unit][engine][data]") {
    std::vector<std::vector<uint8_t>> alphas;
    for (const char* name : {"tree.mtl", "tree_map_d_only.mtl", "tree_kd_alpha_only.mtl"}) {
        const auto path = dataFile(std::string("tree/") + name);
        if (path.empty()) {
            return;
        }
        std::vector<MtlSource> sources;
        std::vector<std::string> warnings;
        const Result<std::string> text = readFile(path);
        REQUIRE(text);
        for (const MtlMaterial& m : parseMtl(*text, path.string(), warnings)) {
            sources.push_back({m, path});
        }
        InputLog log;
        const MaterialSet set = buildMaterials(sources, log);
        CHECK(set.warnings.empty());
        CHECK(set.materials.at(0).alpha_texture == kNoTexture);
        REQUIRE(set.alpha_textures.size() == 1);
        CHECK(set.materials.at(1).alpha_mode == AlphaMode::test);
        alphas.push_back(set.alpha_textures[0].texels);
    }
    CHECK(alphas[0] == alphas[1]);
    CHECK(alphas[0] == alphas[2]);
}
