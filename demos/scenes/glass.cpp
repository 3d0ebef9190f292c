#include "demos/scenes/paint.h"
#include "demos/scenes/scene_builder.h"
#include "demos/scenes/scenes.h"

namespace still::scenes {

Scene makeGlass() {
    Scene scene;
    scene.name = "glass";
    const int32_t checks = addTexture(scene, paintChecker({.cells = 8, .seed = 24}, 256));
    MeshBuilder floor(addMaterial(scene, {.diffuse = {1, 1, 1}, .colour_texture = checks}));
    floor.rectangle({-6, -1, 5}, {12, 0, 0}, {0, 0, -12}, 4.0);
    addObject(scene, "floor", floor.take());
    const std::array<float, 3> colours[] = {
        {0.7f, 0.2f, 0.1f}, {0.2f, 0.6f, 0.2f}, {0.8f, 0.7f, 0.2f}};
    MeshBuilder boxes;
    for (int i = 0; i < 3; ++i) {
        boxes.useMaterial(addMaterial(scene, {.diffuse = colours[i]}));
        const dvec3 at{-2.0 + 2.0 * i, -1.0, -1.0 - 0.5 * i};
        boxes.box(at - dvec3{0.5, 0, 0.5}, at + dvec3{0.5, 1.2 + 0.4 * i, 0.5}, 1.0);
    }
    addObject(scene, "boxes", boxes.take());
    // Two panes one behind the other, so that there is glass through glass.
    const std::array<float, 3> tints[] = {{0.25f, 0.45f, 0.75f}, {0.75f, 0.35f, 0.45f}};
    for (int i = 0; i < 2; ++i) {
        MeshBuilder pane(addMaterial(scene, {.diffuse = tints[i],
                                             .specular = {0.4f, 0.4f, 0.4f},
                                             .shininess = 60,
                                             .opacity = 0.4f,
                                             .alpha_mode = AlphaMode::stochastic}));
        pane.rectangle({-2.2 + 1.1 * i, -0.8 + 0.3 * i, 1.2 - 0.7 * i}, {3.2, 0, -0.5}, {0, 1.8, 0},
                       1.0);
        addObject(scene, "pane " + std::to_string(i), pane.take());
    }
    setDaylight(scene);
    scene.background = {0.35f, 0.5f, 0.7f};
    setCamera(scene, {.eye = {0.4, 1.0, 6}, .target = {0, -0.1, 0}}, 0.1, 100);
    return scene;
}

}  // namespace still::scenes
