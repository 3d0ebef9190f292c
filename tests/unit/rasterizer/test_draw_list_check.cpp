#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <limits>
#include <string>

#include "rasterizer/draw_list_check.h"
#include "rasterizer/texture_layout.h"
#include "tests/support/busy_scene.h"

using namespace still;

namespace {

/// "" or what is wrong with the scene after `change`.
std::string flawAfter(const std::function<void(test::TestScene&, DrawList&)>& change) {
    test::TestScene scene = test::busyScene(1);
    DrawList list = scene.list();
    REQUIRE(flawOf(list) == nullptr);
    change(scene, list);
    const char* const flaw = flawOf(list);
    return flaw == nullptr ? "" : flaw;
}

/// The first one of the list that `which` is true for.
template <class List, class Which>
auto& firstThat(List& list, const Which& which) {
    const auto found = std::find_if(list.begin(), list.end(), which);
    REQUIRE(found != list.end());
    return *found;
}

}  // namespace

TEST_CASE("draw list check: what points nowhere is found", "[unit][rasterizer]") {
    using Scene = test::TestScene;
    const std::string index = "mesh: an index beyond the vertices";
    CHECK(flawAfter([](Scene&, DrawList&) {}).empty());
    CHECK(flawAfter([](Scene& s, DrawList&) {
              s.meshes[0].indices.back() = s.meshes[0].vertexCount();
          }) == index);
    CHECK(flawAfter([](Scene& s, DrawList&) { s.meshes[0].indices[0] = UINT32_MAX; }) == index);
    CHECK(flawAfter([](Scene& s, DrawList&) {
              s.meshes[0].parts.back().material = uint32_t(s.materials.size());
          }) == "mesh: a material that there is not");
    CHECK(flawAfter([](Scene& s, DrawList&) { ++s.meshes[0].parts.back().triangle_count; }) ==
          "mesh: triangles that are in no part, or parts without triangles");
    CHECK(flawAfter([](Scene& s, DrawList&) { ++s.meshes[0].parts.back().first_triangle; }) ==
          "mesh: parts that do not follow one another");
    CHECK(flawAfter([](Scene& s, DrawList&) { s.meshes[0].y.pop_back(); }) ==
          "mesh: coordinates and attributes of different numbers");
    CHECK(flawAfter([](Scene& s, DrawList&) { s.instances[0].mesh = uint32_t(s.meshes.size()); }) ==
          "instance: a mesh that there is not");
    CHECK(flawAfter([](Scene& s, DrawList&) { ++s.instances.back().first_surface; }) ==
          "instance: surfaces are not numbered one after the other");
    for (int32_t Material::*texture : {&Material::colour_texture, &Material::normal_texture,
                                       &Material::alpha_texture, &Material::height_texture}) {
        for (const int32_t wrong : {-2, 1000}) {
            CHECK(flawAfter([&](Scene& s, DrawList&) { s.materials[0].*texture = wrong; }) ==
                  "material: a texture that there is not");
        }
    }
    std::vector<WindingBits> few(1);
    CHECK(flawAfter([&](Scene&, DrawList& list) { list.windings = few; }) ==
          "windings: not of all triangles");
}

TEST_CASE("draw list check: a relief needs tangents", "[unit][rasterizer]") {
    test::TestScene scene = test::busyScene(1);
    const DrawList list = scene.list();
    Mesh& mesh = firstThat(scene.meshes, [](const Mesh& m) { return !m.tangents.empty(); });
    mesh.tangents.pop_back();
    CHECK(std::string(flawOf(list)) ==
          "mesh: a normal or height map without a tangent at each vertex");
}

TEST_CASE("draw list check: numbers out of range are found, NaN included", "[unit][rasterizer]") {
    using Scene = test::TestScene;
    for (const float wrong : {2e18f, -2e18f, std::numeric_limits<float>::infinity(),
                              std::numeric_limits<float>::quiet_NaN()}) {
        CHECK(flawAfter([=](Scene& s, DrawList&) { s.meshes[0].z.back() = wrong; }) ==
              "mesh: a coordinate out of range");
        CHECK(flawAfter([=](Scene& s, DrawList&) { s.meshes[0].attributes.back().nx = wrong; }) ==
              "mesh: a normal or texture coordinate out of range");
        CHECK(flawAfter([=](Scene& s, DrawList&) { s.materials[0].diffuse[1] = wrong; }) ==
              "material: a number out of range");
        CHECK(flawAfter([=](Scene&, DrawList& list) { list.lighting.ambient[2] = wrong; }) ==
              "light: ambient or sun out of range");
        CHECK(flawAfter([=](Scene&, DrawList& list) {
                  list.lighting.points.push_back({{wrong, 0, 0}, {1, 1, 1}});
              }) == "light: a point light with a number out of range");
        CHECK(flawAfter([=](Scene&, DrawList& list) {
                  list.lighting.sampled.spheres.push_back({{0, 0, 0}, wrong, {1, 1, 1}});
              }) == "light: a sphere with a number out of range");
        CHECK(flawAfter([=](Scene&, DrawList& list) {
                  list.lighting.sampled.rectangles.push_back({{0, 0, 0}, {wrong, 0, 0}, {}, {}});
              }) == "light: a rectangle with a number out of range");
        CHECK(flawAfter([=](Scene&, DrawList& list) { list.background[0] = wrong; }) ==
              "background: out of range");
    }
    CHECK(flawAfter([](Scene& s, DrawList&) { s.materials[0].shininess = 0.5f; }) ==
          "material: a number out of range");
}

TEST_CASE("draw list check: textures are whole and laid out", "[unit][rasterizer]") {
    const Texture sound = test::levelTexture(8, {{1, 2, 3}}, Wrap::repeat);
    REQUIRE(flawOf(sound) == nullptr);
    const auto after = [&](const auto& change) {
        Texture texture = sound;
        change(texture);
        const char* const flaw = flawOf(texture);
        return flaw == nullptr ? std::string() : std::string(flaw);
    };
    CHECK(after([](Texture& t) { t.texels.pop_back(); }) == "texture: another number of texels");
    CHECK(after([](Texture& t) { ++t.levels[1].offset; }) ==
          "texture: levels that are not laid out");
    CHECK(after([](Texture& t) { t.levels[0].width = 0; }) ==
          "texture: a level of no size or too large");
    CHECK(after([](Texture& t) { t.levels[1].width = 8; }) ==
          "texture: a level that is not half of the one before");
    CHECK(after([](Texture& t) { t.levels.clear(); }) == "texture: no levels, or no such wrap");
}
