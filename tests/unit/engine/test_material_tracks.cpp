#include <catch2/catch.hpp>

#include "engine/frame_loop.h"
#include "engine/shapes.h"
#include "engine/timeline.h"
#include "rasterizer/texture_layout.h"

using namespace still;

namespace {

Texture greyTexture(Wrap wrap) {
    Texture texture;
    texture.wrap = wrap;
    texture.levels = {{1, 1, 0, 0}};
    texture.texels = {511};
    layOut(texture);
    return texture;
}

/// Object 0 has surfaces 1 (material 0) and 2 (material 1), object 1 likewise 3 and 4. Material 2
/// is only for swaps.
Scene twoObjects(Wrap wrap = Wrap::repeat) {
    Scene scene;
    scene.meshes.push_back(shapes::box(1, 1, 1));
    scene.meshes[0].parts = {{0, 4, 0}, {4, 8, 1}};
    scene.mesh_names = {"box"};
    scene.textures = {greyTexture(wrap)};
    scene.materials.resize(3);
    for (Material& material : scene.materials) {
        material.colour_texture = 0;
    }
    scene.materials[2].diffuse = {1, 0, 0};
    scene.objects.resize(2);
    return scene;
}

FrameState stateAt(const Scene& scene, int frame) {
    return frameStateAt(scene, {}, frame, 200, 100);
}

bool changed(const FrameState& state, uint32_t surface) {
    const size_t word = surface / 64;
    return word < state.changed_surfaces.size() &&
           (state.changed_surfaces[word] >> (surface % 64) & 1) != 0;
}

/// Surfaces of `state` that changed, in order.
std::vector<uint32_t> changedOnes(const FrameState& state, uint32_t count) {
    std::vector<uint32_t> surfaces;
    for (uint32_t surface = 0; surface <= count; ++surface) {
        if (changed(state, surface)) {
            surfaces.push_back(surface);
        }
    }
    return surfaces;
}

}  // namespace

TEST_CASE("materials: without tracks a frame borrows the scene's own", "[unit][timeline]") {
    const Scene scene = twoObjects();
    const FrameState state = stateAt(scene, 3);
    CHECK(state.materials.empty());
    CHECK(state.changed_surfaces.empty());
    CHECK(materialsOf(scene, state).data() == scene.materials.data());
}

TEST_CASE("materials: a swap lends another's values from its frame on", "[unit][timeline]") {
    Scene scene = twoObjects();
    scene.material_tracks = {{.material = 1, .offset = {}, .swaps = {{4, 2}, {7, 0}}}};
    for (int frame : {0, 3, 4, 6, 7, 100}) {
        CAPTURE(frame);
        const uint32_t source = frame < 4 ? 1 : frame < 7 ? 2 : 0;
        const FrameState state = stateAt(scene, frame);
        const auto materials = materialsOf(scene, state);
        REQUIRE(materials.size() == 3);
        CHECK(materials[0] == scene.materials[0]);
        CHECK(materials[1] == scene.materials[source]);
        CHECK(materials[2] == scene.materials[2]);
    }
    CHECK_FALSE(isStill(scene, {}));
}

TEST_CASE("materials: a swap marks the surfaces it reaches, in its frame only",
          "[unit][timeline]") {
    Scene scene = twoObjects();
    scene.material_tracks = {{.material = 1, .offset = {}, .swaps = {{4, 2}, {6, 2}}}};
    CHECK(stateAt(scene, 3).changed_surfaces.empty());
    CHECK(changedOnes(stateAt(scene, 4), 4) == std::vector<uint32_t>{2, 4});
    CHECK(stateAt(scene, 5).changed_surfaces.empty());
    CHECK(stateAt(scene, 6).changed_surfaces.empty());  // the same values again
    CHECK_FALSE(stateAt(scene, 4).lighting_changed);
}

TEST_CASE("materials: swaps to equal values and swaps before frame 0 change nothing",
          "[unit][timeline]") {
    Scene scene = twoObjects();
    scene.material_tracks = {{.material = 0, .offset = {}, .swaps = {{-5, 2}, {3, 2}}}};
    CHECK(isStill(scene, {}));
    CHECK(materialsOf(scene, stateAt(scene, 0))[0] == scene.materials[2]);
    scene.material_tracks[0].swaps = {{4, 1}};
    CHECK(isStill(scene, {}));
    CHECK(stateAt(scene, 4).changed_surfaces.empty());
}

TEST_CASE("materials: there is no change across a cut", "[unit][timeline]") {
    Scene scene = twoObjects();
    scene.cuts = {4};
    scene.material_tracks = {{.material = 1, .offset = {}, .swaps = {{4, 2}}}};
    CHECK(stateAt(scene, 4).changed_surfaces.empty());
    CHECK(materialsOf(scene, stateAt(scene, 4))[1] == scene.materials[2]);
}

TEST_CASE("materials: more than 64 surfaces are marked by number", "[unit][timeline]") {
    Scene scene = twoObjects();
    scene.objects.resize(100);
    scene.material_tracks = {{.material = 1, .offset = {}, .swaps = {{1, 2}}}};
    const FrameState state = stateAt(scene, 1);
    CHECK(state.changed_surfaces.size() == 4);
    for (uint32_t surface = 0; surface <= 200; ++surface) {
        CAPTURE(surface);
        CHECK(changed(state, surface) == (surface > 0 && surface % 2 == 0));
    }
}

TEST_CASE("materials: offsets of repeating textures stay within one repeat", "[unit][timeline]") {
    Scene scene = twoObjects();
    scene.materials[0].v_offset = 0.25f;
    scene.material_tracks = {{.material = 0, .offset = {{{0, {0, 0}}, {8, {4, -2}}}}, .swaps = {}}};
    const auto offsetAt = [&](int frame) {
        const FrameState state = stateAt(scene, frame);
        const Material& m = materialsOf(scene, state)[0];
        return std::array{m.u_offset, m.v_offset};
    };
    CHECK(offsetAt(0) == std::array{0.0f, 0.25f});
    CHECK(offsetAt(1) == std::array{0.5f, 0.0f});
    CHECK(offsetAt(2) == std::array{0.0f, 0.75f});
    CHECK(offsetAt(80) == std::array{0.0f, 0.25f});
}

TEST_CASE("materials: a far offset loses no precision", "[unit][timeline]") {
    Scene scene = twoObjects();
    const double per_frame = 1.0 / 1024;
    scene.material_tracks = {{.material = 0,
                              .offset = {{{0, {0, 0}}, {1 << 20, {per_frame * (1 << 20), 0}}}},
                              .swaps = {}}};
    const FrameState state = stateAt(scene, (1 << 20) - 1);
    CHECK(materialsOf(scene, state)[0].u_offset == float(1 - per_frame));
}

TEST_CASE("materials: offsets of clamped textures are not wrapped", "[unit][timeline]") {
    Scene scene = twoObjects(Wrap::clamp);
    scene.material_tracks = {{.material = 0, .offset = {{{0, {0, 0}}, {8, {4, -2}}}}, .swaps = {}}};
    const FrameState state = stateAt(scene, 8);
    CHECK(materialsOf(scene, state)[0].u_offset == 4.0f);
    CHECK(materialsOf(scene, state)[0].v_offset == -2.0f);
}

TEST_CASE("materials: only frames whose offset differs mark their surfaces", "[unit][timeline]") {
    Scene scene = twoObjects();
    scene.material_tracks = {
        {.material = 0, .offset = {{{2, {0, 0}}, {4, {0.5, 0}}}}, .swaps = {}}};
    CHECK_FALSE(isStill(scene, {}));
    CHECK(stateAt(scene, 2).changed_surfaces.empty());
    CHECK(changedOnes(stateAt(scene, 3), 4) == std::vector<uint32_t>{1, 3});
    CHECK(changedOnes(stateAt(scene, 4), 4) == std::vector<uint32_t>{1, 3});
    CHECK(stateAt(scene, 5).changed_surfaces.empty());
    // A whole repeat is the same picture.
    scene.material_tracks[0].offset.keys = {{2, {0, 0}}, {3, {1, 0}}};
    CHECK(stateAt(scene, 3).changed_surfaces.empty());
}

TEST_CASE("materials: the frame loop draws those of the frame, in any order", "[unit][timeline]") {
    Scene scene;
    scene.meshes.push_back(shapes::plane(1, 1, 1, 1, 1));
    scene.mesh_names = {"plane"};
    scene.materials.resize(2);
    scene.materials[0].diffuse = {0.25f, 0.25f, 0.25f};
    scene.materials[1].diffuse = {0.75f, 0.75f, 0.75f};
    scene.material_tracks = {{.material = 0, .offset = {}, .swaps = {{2, 1}, {3, 0}}}};
    scene.objects.resize(1);
    scene.lights.ambient = {1, 1, 1};
    scene.camera.eye.keys = {{0, {0, 1, 0}}};
    scene.camera.up.keys = {{0, {0, 0, -1}}};
    Workers workers(1, Schedule::serial);
    FrameLoop loop(scene,
                   {.width = 16, .height = 16, .anti_aliasing = AntiAliasing::none, .subframes = 1},
                   workers);
    for (int frame : {0, 1, 2, 3, 2, 0}) {
        CAPTURE(frame);
        CHECK(loop.render(frame).linear.red.at(8, 8) == (frame == 2 ? 3072 : 1024));
    }
}
