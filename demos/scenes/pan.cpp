#include "demos/scenes/noise.h"
#include "demos/scenes/paint.h"
#include "demos/scenes/scene_builder.h"
#include "demos/scenes/scenes.h"

namespace still::scenes {

Scene makePan() {
    Scene scene;
    scene.name = "pan";
    const int32_t bricks = addTexture(scene, paintBond({.seed = 81}, 128));
    const int32_t checks = addTexture(scene, paintChecker({.cells = 4, .seed = 82}, 128));
    MeshBuilder out(addMaterial(scene, {.diffuse = {1, 1, 1}, .colour_texture = checks}));
    out.rectangle({-20, -1, 10}, {40, 0, 0}, {0, 0, -30}, 4.0);
    addObject(scene, "floor", out.take());
    out.useMaterial(addMaterial(scene, {.diffuse = {1, 1, 1}, .colour_texture = bricks}));
    for (int i = 0; i < 24; ++i) {
        const dvec3 foot{-9.0 + 18.0 * i / 23, -1, hashRange(i, 0, 83, -9, -1)};
        const double half = hashRange(i, 1, 83, 0.2, 0.55);
        const double height = hashRange(i, 2, 83, 0.6, 3.2);
        out.box(foot - dvec3{half, 0, half}, foot + dvec3{half, height, half}, 1.2);
    }
    addObject(scene, "boxes", out.take());
    setDaylight(scene);
    scene.background = {0.35f, 0.55f, 0.85f};
    setCamera(scene, {.eye = {-3, 0.8, 5}, .target = {-3, 0.2, -3}, .fov_y_deg = 50}, 0.1, 200);
    // About 4 pixels a frame at 1280 × 720 on the middle boxes, some looking around on top, then a
    // cut to the other side.
    scene.camera.eye.keys = {
        {0, {-3, 0.8, 5}}, {19, {-2.1, 0.8, 5}}, {20, {3, 1.4, 4}}, {40, {2.2, 1.4, 4}}};
    scene.camera.target.keys = {
        {0, {-3, 0.2, -3}}, {19, {-1.7, 0.2, -3}}, {20, {2, 0, -4}}, {40, {0.8, 0.1, -4}}};
    scene.cuts = {20};
    return scene;
}

}  // namespace still::scenes
