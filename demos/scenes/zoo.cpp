#include "demos/scenes/paint.h"
#include "demos/scenes/scene_builder.h"
#include "demos/scenes/scenes.h"
#include "demos/scenes/solids.h"
#include "engine/shapes.h"

namespace still::scenes {
namespace {

void addSurroundings(Scene& scene) {
    // The floor passes under and behind the camera, so it is cut by the near plane; the wall
    // reaches far outside the guard band.
    const int32_t checks = addTexture(scene, paintChecker({.cells = 4, .seed = 91}, 64));
    MeshBuilder floor(addMaterial(scene, {.diffuse = {1, 1, 1},
                                          .specular = {0.2f, 0.2f, 0.2f},
                                          .shininess = 30,
                                          .colour_texture = checks}));
    floor.rectangle({-30, -1, 40}, {60, 0, 0}, {0, 0, -80}, 4.0);
    addObject(scene, "floor", floor.take());
    const Bond bond{.columns = 4, .rows = 8, .aspect = 2, .seed = 92};
    MeshBuilder wall(
        addMaterial(scene, {.diffuse = {1, 1, 1},
                            .colour_texture = addTexture(scene, paintBond(bond, 64)),
                            .normal_texture = addTexture(scene, paintBondRelief(bond, 64))}));
    wall.rectangle({-5000, -1, -6}, {10000, 0, 0}, {0, 4.5, 0}, 1.6);
    addObject(scene, "wall", wall.takeWithTangents());
}

void addCutOuts(Scene& scene) {
    const int32_t link = addTexture(scene, paintChainLink(4, 0.2, 64));
    MeshBuilder fence(addMaterial(
        scene,
        {.diffuse = {0.5f, 0.5f, 0.5f}, .alpha_mode = AlphaMode::test, .alpha_texture = link}));
    fence.rectangle({0.6, -1, -0.4}, {2.6, 0, -1.2}, {0, 1.6, 0}, 0.7);
    addObject(scene, "fence", fence.take());
    const int32_t leaves = addTexture(scene, paintLeafShapes(93, 64));
    const int32_t colours =
        addTexture(scene, paintLeafColours({140, 170, 70}, {60, 100, 40}, 93, 64));
    MeshBuilder bush(addMaterial(scene, {.diffuse = {1, 1, 1},
                                         .alpha_mode = AlphaMode::test,
                                         .colour_texture = colours,
                                         .alpha_texture = leaves}));
    addFoliage(bush, {.centre = {-2.3, -0.3, -0.8},
                      .radii = {0.7, 0.6, 0.7},
                      .cards = 60,
                      .card_size = 0.5,
                      .seed = 94});
    addObject(scene, "bush", bush.take());
    MeshBuilder pane(addMaterial(scene, {.diffuse = {0.2f, 0.5f, 0.7f},
                                         .specular = {0.5f, 0.5f, 0.5f},
                                         .shininess = 80,
                                         .opacity = 0.4f,
                                         .alpha_mode = AlphaMode::stochastic}));
    pane.rectangle({-1.4, -0.9, 1.0}, {1.5, 0, 0.2}, {0, 1.3, 0}, 1.0);
    addObject(scene, "pane", pane.take());
}

void addMovers(Scene& scene) {
    MeshBuilder knot(addMaterial(
        scene, {.diffuse = {0.55f, 0.3f, 0.06f}, .specular = {0.9f, 0.8f, 0.6f}, .shininess = 90}));
    addTorusKnot(knot, {.segments = 48, .sides = 8});
    SceneObject& turning = addObject(scene, "knot", knot.take());
    turning.tracks.translation.keys = {
        {0, {-1.0, 0.2, -2}}, {30, {1.6, 0.5, -2}}, {60, {-1.0, 0.2, -2}}};
    turning.tracks.rotation_axis = unit({1, 1, 0.2});
    turning.tracks.rotation_deg.keys = {{0, 0}, {60, 360}};
    turning.tracks.scale.keys = {{0, dvec3{0.5}}, {60, {0.7, 0.5, 0.6}}};
    // Flies through the near plane past the camera.
    MeshBuilder box(addMaterial(scene, {.diffuse = {0.6f, 0.1f, 0.1f}}));
    box.append(shapes::box(0.15f, 0.15f, 0.6f), dmat4{1.0});
    SceneObject& flying = addObject(scene, "flying box", box.take());
    flying.tracks.translation.keys = {{0, {0.9, 0.7, 0}}, {20, {0.6, 0.6, 5.5}}};
    MeshBuilder wires(addMaterial(scene, {.diffuse = {0.02f, 0.02f, 0.02f}}));
    addCable(wires, {-4, 1.8, -4}, {4, 2.2, -3}, 0.4, 0.006, 12, 3);
    addObject(scene, "wire", wires.take());
}

}  // namespace

Scene makeZoo() {
    Scene scene;
    scene.name = "zoo";
    addSurroundings(scene);
    addCutOuts(scene);
    addMovers(scene);
    setDaylight(scene);
    scene.lights.sun_intensity.keys = {{0, 1}, {40, 1}, {50, 0.6}};
    scene.lights.points = {{{-0.5f, 1.0f, -3.5f}, {1.6f, 1.0f, 0.5f}}};
    scene.background = {0.3f, 0.45f, 0.75f};
    setCamera(scene, {.eye = {0, 0.6, 4.5}, .target = {0, 0, -1}, .fov_y_deg = 50}, 0.1, 500);
    scene.camera.eye.keys = {{0, {0, 0.6, 4.5}}, {8, {0, 0.6, 4.5}}, {24, {0.8, 0.8, 4.2}}};
    scene.cuts = {16};
    return scene;
}

}  // namespace still::scenes
