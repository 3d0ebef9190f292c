#include "demos/scenes/scene_builder.h"
#include "demos/scenes/scenes.h"

namespace still::scenes {

Scene makeTriangle() {
    Scene scene;
    scene.name = "triangle";
    MeshBuilder out(addMaterial(scene, {.diffuse = {0.7f, 0.25f, 0.1f}}));
    const dvec3 corners[] = {{-1.1, -0.8, 0}, {1.2, -0.5, 0}, {-0.2, 0.95, 0}};
    const dvec2 uvs[] = {{0, 0}, {1, 0}, {0.5, 1}};
    out.polygon(corners, uvs);
    addObject(scene, "triangle", out.take());
    scene.lights.ambient = {1, 1, 1};
    scene.background = {0.02f, 0.03f, 0.05f};
    setCamera(scene, {.eye = {0, 0, 3}, .target = {0, 0, 0}}, 0.1, 100);
    return scene;
}

}  // namespace still::scenes
