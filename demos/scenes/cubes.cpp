#include "demos/scenes/paint.h"
#include "demos/scenes/scene_builder.h"
#include "demos/scenes/scenes.h"
#include "engine/shapes.h"

namespace still::scenes {
namespace {

/// Boxes share a mesh but for their material.
uint32_t cubeMesh(Scene& scene, const std::string& name, uint32_t material) {
    MeshBuilder out(material);
    out.append(shapes::box(1, 1, 1), dmat4{1.0});
    return addMesh(scene, name, out.take());
}

void addMovingCubes(Scene& scene) {
    const uint32_t red = addMaterial(
        scene, {.diffuse = {0.65f, 0.12f, 0.08f}, .specular = {0.3f, 0.3f, 0.3f}, .shininess = 40});
    const uint32_t blue = addMaterial(scene, {.diffuse = {0.10f, 0.25f, 0.60f}});
    SceneObject& turning = addObject(scene, "turning cube", cubeMesh(scene, "red cube", red));
    turning.tracks.translation.keys = {{0, {-1.9, 0.9, 0.4}}};
    turning.tracks.rotation_axis = unit({1, 2, 0.5});
    turning.tracks.rotation_deg.keys = {{0, 10}, {120, 370}};
    turning.tracks.scale.keys = {{0, dvec3{0.55}}};
    SceneObject& travelling =
        addObject(scene, "travelling cube", cubeMesh(scene, "blue cube", blue));
    travelling.tracks.translation.keys = {{0, {-3.5, 0.0, 1.2}}, {120, {3.5, 0.0, 1.2}}};
    travelling.tracks.scale.keys = {{0, dvec3{0.4}}};
}

}  // namespace

Scene makeCubes() {
    Scene scene;
    scene.name = "cubes";
    const int32_t bricks = addTexture(scene, paintBond({.seed = 4}, 128));
    MeshBuilder wall(addMaterial(scene, {.diffuse = {1, 1, 1}, .colour_texture = bricks}));
    wall.rectangle({-6, -2, -2}, {12, 0, 0}, {0, 7, 0}, 1.5);
    addObject(scene, "wall", wall.take());
    const uint32_t white = cubeMesh(scene, "cube", addMaterial(scene, {}));
    for (int i = 0; i < 3; ++i) {
        addObject(scene, "still cube " + std::to_string(i), white).base =
            placed({-1.6 + 1.7 * i, -0.9 + 0.15 * i, -0.6}, dvec3{0.5 + 0.08 * i});
    }
    addMovingCubes(scene);
    setDaylight(scene);
    scene.background = {0.3f, 0.5f, 0.8f};
    setCamera(scene, {.eye = {0.3, 0.8, 6}, .target = {0, 0.3, 0}}, 0.1, 100);
    return scene;
}

}  // namespace still::scenes
