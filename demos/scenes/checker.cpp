#include "demos/scenes/paint.h"
#include "demos/scenes/scene_builder.h"
#include "demos/scenes/scenes.h"

namespace still::scenes {

Scene makeChecker() {
    Scene scene;
    scene.name = "checker";
    const int32_t texture = addTexture(scene, paintChecker({.seed = 6}, 256));
    MeshBuilder floor(addMaterial(scene, {.diffuse = {1, 1, 1}, .colour_texture = texture}));
    floor.rectangle({-400, 0, 400}, {800, 0, 0}, {0, 0, -800}, 8.0);
    addObject(scene, "floor", floor.take());
    setDaylight(scene);
    scene.background = {0.35f, 0.55f, 0.85f};
    setCamera(scene, {.eye = {0.4, 1.6, 0}, .target = {2.0, 1.1, -8}, .fov_y_deg = 50}, 0.05, 2000);
    return scene;
}

}  // namespace still::scenes
