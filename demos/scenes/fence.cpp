#include "demos/scenes/paint.h"
#include "demos/scenes/scene_builder.h"
#include "demos/scenes/scenes.h"
#include "demos/scenes/solids.h"

namespace still::scenes {

Scene makeFence() {
    Scene scene;
    scene.name = "fence";
    const int32_t bricks = addTexture(scene, paintBond({.seed = 14}, 256));
    MeshBuilder wall(addMaterial(scene, {.diffuse = {1, 1, 1}, .colour_texture = bricks}));
    wall.rectangle({-9, -5, -2.5}, {18, 0, 0}, {0, 10, 0}, 1.2);
    addObject(scene, "wall", wall.take());
    const int32_t link = addTexture(scene, paintChainLink(4, 0.14, 128));
    MeshBuilder wire(addMaterial(
        scene,
        {.diffuse = {0.55f, 0.57f, 0.6f}, .alpha_mode = AlphaMode::test, .alpha_texture = link}));
    wire.rectangle({-4, -1.4, 0.8}, {8, 0, -1.6}, {0, 2.6, 0}, 0.4);
    addObject(scene, "chain link", wire.take());
    MeshBuilder posts(addMaterial(scene, {.diffuse = {0.3f, 0.32f, 0.33f}}));
    for (int i = 0; i <= 3; ++i) {
        const dvec3 foot{-4 + 8 * i / 3.0, -1.5, 0.8 - 1.6 * i / 3.0};
        const dvec3 path[] = {foot, foot + dvec3{0, 2.8, 0}};
        addTube(posts, path, 0.04, 12);
    }
    addObject(scene, "posts", posts.take());
    setDaylight(scene);
    setCamera(scene, {.eye = {0.5, 0.2, 4.5}, .target = {0, 0, 0}, .fov_y_deg = 50}, 0.1, 100);
    return scene;
}

}  // namespace still::scenes
