#include "demos/scenes/scene_builder.h"
#include "demos/scenes/scenes.h"

namespace still::scenes {

Scene makeDepth() {
    Scene scene;
    scene.name = "depth";
    const uint32_t front = addMaterial(scene, {.diffuse = {0.8f, 0.75f, 0.3f}});
    const uint32_t back = addMaterial(scene, {.diffuse = {0.1f, 0.2f, 0.7f}});
    // Near 0.01, far 1000. At each distance a yellow pane hides a blue one a thousandth behind it;
    // a blue speck inside a yellow pane is a depth error.
    double distance = 0.02;
    for (int i = 0; i < 16; ++i) {
        const double angle = -0.55 + 1.1 * (i % 4) / 3, rise = -0.3 + 0.6 * (i / 4) / 3;
        const dvec3 centre{angle * distance, rise * distance, -distance};
        const double half = 0.07 * distance;
        for (int layer = 0; layer < 2; ++layer) {
            MeshBuilder pane(layer == 0 ? back : front);
            // The hidden pane comes first, so that equal depths would show it.
            const double push = layer == 0 ? 1.001 : 1.0;
            pane.rectangle((centre - dvec3{half, half, 0.3 * half}) * push,
                           dvec3{2 * half, 0, 0} * push, dvec3{0, 2 * half, 0.6 * half} * push,
                           1.0);
            addObject(scene, (layer == 0 ? "hidden " : "pane ") + std::to_string(i), pane.take());
        }
        distance *= 1.95;
    }
    scene.lights.ambient = {0.9f, 0.9f, 0.9f};
    scene.background = {0.05f, 0.05f, 0.06f};
    setCamera(scene, {.eye = {0, 0, 0}, .target = {0, 0, -1}, .fov_y_deg = 45}, 0.01, 1000);
    return scene;
}

}  // namespace still::scenes
