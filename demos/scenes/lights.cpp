#include "demos/scenes/paint.h"
#include "demos/scenes/scene_builder.h"
#include "demos/scenes/scenes.h"
#include "engine/shapes.h"

namespace still::scenes {

Scene makeLights() {
    Scene scene;
    scene.name = "lights";
    const Bond bond{.columns = 4, .rows = 8, .aspect = 2, .relief = 1.5, .seed = 31};
    MeshBuilder wall(
        addMaterial(scene, {.diffuse = {1, 1, 1},
                            .specular = {0.15f, 0.15f, 0.15f},
                            .shininess = 25,
                            .colour_texture = addTexture(scene, paintBond(bond, 128)),
                            .normal_texture = addTexture(scene, paintBondRelief(bond, 128))}));
    wall.rectangle({-4, -1.5, -1.5}, {8, 0, 0}, {0, 5, 0}, 1.6);
    wall.rectangle({-4, -1.5, 3}, {8, 0, 0}, {0, 0, -4.5}, 1.6);
    addObject(scene, "wall and floor", wall.takeWithTangents());
    for (int i = 0; i < 3; ++i) {
        const float shininess = i == 0 ? 8.0f : (i == 1 ? 64.0f : 1024.0f);
        MeshBuilder ball(addMaterial(scene, {.diffuse = {0.25f, 0.3f, 0.4f},
                                             .specular = {0.8f, 0.8f, 0.8f},
                                             .shininess = shininess}));
        ball.append(shapes::sphere(24, 12), placed({-2.0 + 2.0 * i, -0.7, 0.2}, dvec3{0.8}));
        addObject(scene, "sphere " + std::to_string(i), ball.take());
    }
    scene.lights.ambient = {0.06f, 0.06f, 0.08f};
    scene.lights.sun.direction = {0, 0, -1};
    scene.lights.sun.colour = {0.15f, 0.15f, 0.2f};
    scene.lights.points = {{{-2.5f, 1.6f, 1.2f}, {2.4f, 1.5f, 0.7f}},
                           {{2.2f, 1.9f, 0.8f}, {0.5f, 1.1f, 2.4f}}};
    // The second lamp flickers out and comes back; the first one burns on.
    scene.lights.point_intensity = {{}, {{{0, 1}, {20, 1}, {22, 0.1}, {40, 1}}}};
    setCamera(scene, {.eye = {0, 0.7, 6}, .target = {0, 0, 0}, .fov_y_deg = 42}, 0.1, 100);
    return scene;
}

}  // namespace still::scenes
