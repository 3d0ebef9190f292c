#include "demos/scenes/scene_builder.h"
#include "demos/scenes/scenes.h"
#include "demos/scenes/solids.h"

namespace still::scenes {

Scene makeWires() {
    Scene scene;
    scene.name = "wires";
    MeshBuilder wall(addMaterial(scene, {.diffuse = {0.7f, 0.72f, 0.75f}}));
    wall.rectangle({-8, -5, -1}, {16, 0, 0}, {0, 10, 0}, 1.0);
    addObject(scene, "wall", wall.take());
    // At 720 rows a pixel is 7 mm wide here; the wires go from a fifth of that to one pixel.
    MeshBuilder wires(addMaterial(scene, {.diffuse = {0.02f, 0.02f, 0.03f}}));
    for (int i = 0; i < 12; ++i) {
        const double y = -2.4 + 0.35 * i, radius = 0.0007 + 0.00025 * i;
        addCable(wires, {-5, y - 0.4 - 0.1 * i, 0}, {5, y + 1.0 + 0.15 * i, 0}, 0.05 * i, radius,
                 12, 4);
    }
    addObject(scene, "wires", wires.take());
    setDaylight(scene);
    setCamera(scene, {.eye = {0, 0, 6}, .target = {0, 0, 0}}, 0.1, 100);
    return scene;
}

}  // namespace still::scenes
