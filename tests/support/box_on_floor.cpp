#include "tests/support/box_on_floor.h"

#include "engine/shapes.h"

using namespace still;

Scene boxOnFloor(int first, int last) {
    Scene scene;
    scene.meshes = {shapes::plane(8, 8, 4, 4, 1), shapes::box(0.5f, 0.5f, 0.5f)};
    scene.mesh_names = {"floor", "box"};
    scene.materials.resize(2);
    scene.materials[1].diffuse = {0.9f, 0.2f, 0.1f};
    scene.meshes[1].parts[0].material = 1;
    scene.objects.resize(2);
    scene.objects[1].mesh = 1;
    scene.objects[1].tracks.translation.keys = {{first - 1.0, {-1, 0.5, 0}},
                                                {double(last), {1, 0.5, 0}}};
    scene.camera.eye.keys = {{0, {1, 3, 5}}};
    scene.camera.target.keys = {{0, {0, 0.5, 0}}};
    scene.lights.sun = {{0.0f, -0.6f, -0.8f}, {0.7f, 0.7f, 0.7f}};
    scene.background = {0.1f, 0.2f, 0.4f};
    return scene;
}
