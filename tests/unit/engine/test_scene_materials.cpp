#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include "engine/load.h"
#include "engine/timeline.h"
#include "tests/support/texels.h"

using namespace still;
namespace fs = std::filesystem;

namespace {

const fs::path kData = fs::path(STILL_SOURCE_DIR) / "tests" / "data";

/// Loads a scene file with the given text beside copies of the OBJ and the images it may name.
Result<Scene> load(const std::string& text) {
    const fs::path folder =
        fs::temp_directory_path() / ("still_materials_" + std::to_string(std::random_device{}()));
    fs::create_directories(folder);
    for (const char* name : {"quad.obj", "quad.mtl", "bricks.png", "bricks_height.png"}) {
        fs::copy_file(kData / name, folder / name);
    }
    std::ofstream(folder / "scene.json", std::ios::binary) << text;
    Result<Scene> scene = loadScene(folder / "scene.json");
    fs::remove_all(folder);
    if (!scene) {
        std::string message = scene.error().message;
        for (size_t at; (at = message.find(folder.string() + "/")) != std::string::npos;) {
            message.erase(at, folder.string().size() + 1);
        }
        return fail(message);
    }
    return scene;
}

std::string errorOf(const std::string& text) {
    const Result<Scene> scene = load(text);
    const std::string message = scene ? "" : scene.error().message;
    CHECK(message.find('\n') == std::string::npos);
    return message;
}

/// The error of a box with this "material".
std::string boxError(const std::string& material) {
    return errorOf(R"({"objects": [{"shape": "box", "material": )" + material + "}]}");
}

/// The error of the quad with this entry in "materials".
std::string quadError(const std::string& entry) {
    return errorOf(R"({"objects": [{"obj": "quad.obj", "materials": [)" + entry + "]}]}");
}

Scene example() {
    Result<Scene> scene = loadScene(kData / "example.scene.json");
    REQUIRE((scene ? "" : scene.error().message) == std::string());
    return std::move(*scene);
}

const MaterialTracks& tracksOf(const Scene& scene, uint32_t material) {
    for (const MaterialTracks& tracks : scene.material_tracks) {
        if (tracks.material == material) {
            return tracks;
        }
    }
    FAIL("no tracks");
    return scene.material_tracks.front();
}

}  // namespace

TEST_CASE("scene_materials: the documented example's floor", "[unit][scene_file]") {
    const Scene scene = example();
    const Mesh& floor = scene.meshes[scene.objects[1].mesh];
    const uint32_t number = floor.parts[0].material;
    const Material& bricks = scene.materials[number];
    REQUIRE(bricks.colour_texture != kNoTexture);
    const Texture& image = scene.textures[size_t(bricks.colour_texture)];
    CHECK(image.levels[0].width == 16);
    CHECK(image.wrap == Wrap::repeat);
    REQUIRE(bricks.height_texture != kNoTexture);
    CHECK(bricks.height_scale == 0.05f);
    const AlphaTexture& height = scene.alpha_textures[size_t(bricks.height_texture)];
    CHECK(test::texelAt(height, 0, 0, 0) == 255);  // on a brick
    CHECK(test::texelAt(height, 0, 7, 0) == 0);    // in a joint
    CHECK(floor.tangents.size() == floor.vertexCount());

    const MaterialTracks& tracks = tracksOf(scene, number);
    REQUIRE(tracks.offset.keys.size() == 2);
    CHECK(tracks.offset.keys[1].frame == 100);
    CHECK(tracks.offset.keys[1].value == glm::dvec2(1, 0.5));
    REQUIRE(tracks.swaps.size() == 2);
    CHECK(tracks.swaps[0].frame == 20);
    const Material& dark = scene.materials[tracks.swaps[0].material];
    CHECK(dark.diffuse == std::array{0.2f, 0.2f, 0.2f});
    CHECK(dark.colour_texture == bricks.colour_texture);  // read once
    CHECK(dark.height_texture == kNoTexture);
    const Material& deep = scene.materials[tracks.swaps[1].material];
    CHECK(deep.height_texture == bricks.height_texture);
    CHECK(deep.height_scale == 0.1f);
}

TEST_CASE("scene_materials: the documented example's OBJ", "[unit][scene_file]") {
    const Scene scene = example();
    const Mesh& sign = scene.meshes[scene.objects[0].mesh];
    const uint32_t number = sign.parts[0].material;
    CHECK(scene.materials[number].diffuse[0] == 0.5f);  // from the MTL
    CHECK(scene.materials[number].height_scale == 0.02f);
    CHECK(sign.tangents.size() == sign.vertexCount());
    const MaterialTracks& tracks = tracksOf(scene, number);
    REQUIRE(tracks.offset.keys.size() == 1);
    CHECK(tracks.offset.keys[0].value == glm::dvec2(0.5, 0));
    REQUIRE(tracks.swaps.size() == 1);
    CHECK(tracks.swaps[0].frame == 12);
    CHECK(scene.materials[tracks.swaps[0].material].emission == std::array{2.0f, 2.0f, 1.0f});
    const FrameState state = frameStateAt(scene, {}, 12, 160, 90);
    CHECK(materialsOf(scene, state)[number].u_offset == 0.5f);
    REQUIRE(state.changed_surfaces.size() == 1);
    CHECK(state.changed_surfaces[0] == 6);  // the sign's new material, the floor's offset
}

TEST_CASE("scene_materials: plain materials leave no tracks, textures or tangents",
          "[unit][scene_file]") {
    const Result<Scene> scene = load(
        R"({"objects": [{"shape": "box", "material": {"diffuse": [1, 0, 0]}}, {"shape": "box"},
                        {"obj": "quad.obj", "materials": []}]})");
    REQUIRE(scene);
    CHECK(scene->materials.size() == 3);
    CHECK(scene->material_tracks.empty());
    CHECK(scene->textures.empty());
    CHECK(scene->alpha_textures.empty());
    for (const Mesh& mesh : scene->meshes) {
        CHECK(mesh.tangents.empty());
    }
}

TEST_CASE("scene_materials: images that cannot be had are refused", "[unit][scene_file]") {
    const std::string missing = boxError(R"({"image": "none.png"})");
    CHECK(missing.find("scene.json: /objects/0/material/image: none.png: ") == 0);
    CHECK(boxError(R"({"image": "quad.mtl"})").find("scene.json: /objects/0/material/image: ") ==
          0);
    CHECK(boxError(R"({"image": 3})") ==
          "scene.json: /objects/0/material/image: expected a text, found 3");
    CHECK(boxError(R"({"height": {"image": "none.png", "scale": 0.1}})")
              .find("scene.json: /objects/0/material/height/image: none.png: ") == 0);
}

TEST_CASE("scene_materials: heights need an image and a scale", "[unit][scene_file]") {
    CHECK(boxError(R"({"height": {"image": "bricks_height.png"}})") ==
          "scene.json: /objects/0/material/height: expected the key \"scale\"");
    CHECK(
        boxError(R"({"height": {"image": "bricks_height.png", "scale": 2}})")
            .find("scene.json: /objects/0/material/height/scale: expected a number from 0 to 1") ==
        0);
    CHECK(boxError(R"({"height": "bricks_height.png"})")
              .find("scene.json: /objects/0/material/height: expected an object") == 0);
}

TEST_CASE("scene_materials: offsets and swaps are checked", "[unit][scene_file]") {
    CHECK(boxError(R"({"offset": [1, 2, 3]})")
              .find("scene.json: /objects/0/material/offset: expected an array of 2") == 0);
    CHECK(boxError(R"({"offset": [1, 1e9]})")
              .find("scene.json: /objects/0/material/offset/1: expected a number from -1e+06") ==
          0);
    CHECK(boxError(R"({"swaps": []})")
              .find("scene.json: /objects/0/material/swaps: expected an array") == 0);
    CHECK(boxError(R"({"swaps": [{"frame": 1}]})") ==
          "scene.json: /objects/0/material/swaps/0: expected the key \"material\"");
    CHECK(boxError(R"({"swaps": [{"frame": -1, "material": {}}]})")
              .find("scene.json: /objects/0/material/swaps/0/frame: expected a whole number") == 0);
    CHECK(boxError(R"({"swaps": [{"frame": 3, "material": {}}, {"frame": 3, "material": {}}]})") ==
          "scene.json: /objects/0/material/swaps/1/frame: expected a frame after that of the swap "
          "before, found 3");
    CHECK(boxError(R"({"swaps": [{"frame": 3, "material": {"opacity": -1}}]})")
              .find("scene.json: /objects/0/material/swaps/0/material/opacity: ") == 0);
}

TEST_CASE("scene_materials: an OBJ's materials go by name, each once", "[unit][scene_file]") {
    CHECK(quadError(R"({"name": "red"})") ==
          "scene.json: /objects/0/materials/0/name: expected a material that the OBJ uses, found "
          "\"red\"");
    CHECK(quadError(R"({"offset": [0, 0]})") ==
          "scene.json: /objects/0/materials/0: expected the key \"name\"");
    CHECK(quadError(R"({"name": "grey"}, {"name": "grey"})")
              .find("scene.json: /objects/0/materials/1/name: expected each material once") == 0);
    CHECK(errorOf(R"({"objects": [{"obj": "quad.obj", "materials": [{"name": "grey"}]},
                                  {"obj": "quad.obj", "materials": [{"name": "grey"}]}]})")
              .find("scene.json: /objects/1/materials/0/name: expected each material once") == 0);
    CHECK(errorOf(R"({"objects": [{"obj": "quad.obj", "material": {}}]})") ==
          "scene.json: /objects/0/material: expected \"materials\", since an OBJ brings its own");
    CHECK(errorOf(R"({"objects": [{"shape": "box", "materials": []}]})") ==
          "scene.json: /objects/0/materials: expected \"material\", since a shape has one");
}
