// Scenes for sampled light: what is hard for one sample a pixel and a denoiser.

#include "demos/scenes/paint.h"
#include "demos/scenes/scene_builder.h"
#include "demos/scenes/scenes.h"
#include "demos/scenes/solids.h"
#include "engine/shapes.h"

namespace still::scenes {
namespace {

/// Floor and back wall with textures, which a denoiser must not blur.
Scene stage(const char* name) {
    Scene scene;
    scene.name = name;
    const int32_t slabs = addTexture(scene, paintChecker({.cells = 8, .seed = 5}, 256));
    MeshBuilder floor(addMaterial(scene, {.diffuse = {0.8f, 0.8f, 0.8f}, .colour_texture = slabs}));
    floor.rectangle({-8, 0, 5}, {16, 0, 0}, {0, 0, -8}, 5);
    addObject(scene, "floor", floor.take());
    const int32_t bricks = addTexture(scene, paintBond({.columns = 4, .rows = 10, .seed = 8}, 256));
    MeshBuilder wall(addMaterial(scene, {.diffuse = {0.9f, 0.9f, 0.9f}, .colour_texture = bricks}));
    wall.rectangle({-8, 0, -3}, {16, 0, 0}, {0, 6, 0}, 2);
    addObject(scene, "wall", wall.take());
    scene.lights = {};
    scene.lights.ambient = {0.10f, 0.12f, 0.15f};
    setCamera(scene, {.eye = {0, 2.0, 6.2}, .target = {0, 0.95, 0}, .fov_y_deg = 36}, 0.1, 60);
    return scene;
}

SceneObject& addSolid(Scene& scene, const char* name, const Mesh& shape,
                      const std::array<float, 3>& colour, const dvec3& at, const dvec3& scale) {
    MeshBuilder out(addMaterial(scene, {.diffuse = colour}));
    out.append(shape, placed({0, 0, 0}, scale));
    SceneObject& object = addObject(scene, name, out.take());
    object.tracks.translation.keys = {{0, at}};
    return object;
}

/// A ball that shines, and its light. What is seen of it is dimmer than colour / radius², so that
/// its edge can be anti-aliased.
SceneObject& addLamp(Scene& scene, const char* name, double radius,
                     const std::array<float, 3>& colour, const Track<dvec3>& position) {
    MeshBuilder out(addMaterial(
        scene, {.diffuse = {0, 0, 0}, .emission = {colour[0] / 4, colour[1] / 4, colour[2] / 4}}));
    out.append(shapes::sphere(24, 12), placed({0, 0, 0}, dvec3{radius * 0.96}));
    SceneObject& ball = addObject(scene, name, out.take());
    ball.tracks.translation = position;
    scene.lights.spheres.push_back({.position = position, .radius = radius, .colour = colour});
    return ball;
}

void addStillLife(Scene& scene) {
    addSolid(scene, "ball", shapes::sphere(48, 24), {0.7f, 0.66f, 0.6f}, {-1.5, 0.7, 0.2},
             dvec3{0.7});
    addSolid(scene, "box", shapes::box(1, 1, 1), {0.3f, 0.45f, 0.7f}, {0.3, 0.5, -0.6}, dvec3{0.5});
    addSolid(scene, "pillar", shapes::cylinder(32), {0.75f, 0.4f, 0.25f}, {1.7, 0.9, 0.1},
             {0.25, 0.9, 0.25});
    MeshBuilder knot(addMaterial(scene, {.diffuse = {0.55f, 0.6f, 0.35f}}));
    addTorusKnot(knot, {.segments = 128, .sides = 12});
    SceneObject& object = addObject(scene, "knot", knot.take());
    object.base = placed({2.9, 0.62, -1.2}, dvec3{0.45});
}

}  // namespace

/// A board on a post goes through the light of a large lamp, from left to right, in frames 0 … 48;
/// its shadow is sharp at the post's foot and wide on the wall.
Scene makePenumbra() {
    Scene scene = stage("penumbra");
    addSolid(scene, "pillar", shapes::cylinder(32), {0.75f, 0.4f, 0.25f}, {2.2, 0.9, -0.4},
             {0.25, 0.9, 0.25});
    MeshBuilder board(addMaterial(scene, {.diffuse = {0.35f, 0.5f, 0.65f}}));
    board.box({-0.06, 0, -0.06}, {0.06, 1.2, 0.06}, 1);
    board.box({-0.7, 1.2, -0.05}, {0.7, 2.2, 0.05}, 1);
    SceneObject& moving = addObject(scene, "board", board.take());
    moving.tracks.translation.keys = {{0, {-2.4, 0, -0.2}}, {48, {2.4, 0, -0.2}}};
    addLamp(scene, "lamp", 0.5, {22, 19, 14}, {{{0, {0.5, 4.0, 3.2}}}});
    return scene;
}

/// A lamp flies over a still life, to the right and back, in frames 0 … 96.
Scene makeMovingLight() {
    Scene scene = stage("moving-light");
    addStillLife(scene);
    addLamp(scene, "lamp", 0.15, {6, 5.3f, 4.1f},
            {{{0, {-2.6, 2.1, 1.4}}, {48, {2.6, 2.1, 1.4}}, {96, {-2.6, 2.1, 1.4}}}});
    return scene;
}

/// Sky without a sun: nothing but contact shadows tells where things stand.
Scene makeContact() {
    Scene scene = stage("contact");
    addStillLife(scene);
    for (int i = 0; i < 9; ++i) {
        const double size = 0.08 + 0.02 * (i % 4);
        addSolid(scene, "pebble", shapes::sphere(16, 8), {0.6f, 0.58f, 0.55f},
                 {-2.6 + 0.65 * i, size * 0.9, 1.4 + 0.35 * ((i * 5) % 3)}, dvec3{size});
    }
    scene.lights.ambient = {0.75f, 0.82f, 0.95f};
    scene.lights.ambient_light = AmbientLight::traced_occlusion;
    scene.lights.occlusion_distance = 2.5;
    return scene;
}

/// Two lamps; the near one goes out in frame 32.
Scene makeSwitchOff() {
    Scene scene = stage("switch-off");
    addStillLife(scene);
    addLamp(scene, "far lamp", 0.3, {7.0f, 8.0f, 10.0f}, {{{0, {3.6, 3.2, 1.6}}}});
    SceneObject& ball = addLamp(scene, "near lamp", 0.25, {9, 7, 4}, {{{0, {-1.8, 3, 2.2}}}});
    scene.lights.spheres.back().intensity = {{{31, 1}, {32, 0}}};
    const uint32_t lit = scene.meshes[ball.mesh].parts[0].material;
    const uint32_t dark = addMaterial(scene, {.diffuse = {0.2f, 0.2f, 0.2f}});
    scene.material_tracks = {{.material = lit, .offset = {}, .swaps = {{32, dark}}}};
    return scene;
}

}  // namespace still::scenes
