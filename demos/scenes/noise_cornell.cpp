#include "demos/scenes/scene_builder.h"
#include "demos/scenes/scenes.h"
#include "engine/shapes.h"

namespace still::scenes {
namespace {

/// A box of half extents `half` that stands at `at`, turned about the vertical.
Mesh standingBox(uint32_t material, const dvec3& at, const dvec3& half, double cosine,
                 double sine) {
    MeshBuilder out(material);
    dmat4 turned{1.0};
    turned[0] = glm::dvec4(cosine, 0, -sine, 0);
    turned[2] = glm::dvec4(sine, 0, cosine, 0);
    turned[3] = glm::dvec4(at.x, at.y + half.y, at.z, 1);
    out.append(shapes::box(float(half.x), float(half.y), float(half.z)), turned);
    return out.take();
}

}  // namespace

/// Goral et al., "Modeling the Interaction of Light Between Diffuse Surfaces", 1984, with the
/// measured boxes and colours of Cornell's later data, 1 unit = 278 mm. One bounce of light.
Scene makeCornell() {
    Scene scene;
    scene.name = "cornell";
    const uint32_t white = addMaterial(scene, {.diffuse = {0.725f, 0.71f, 0.68f}});
    MeshBuilder room(white);
    room.rectangle({-1, -1, 1}, {2, 0, 0}, {0, 0, -2}, 1);  // floor
    room.rectangle({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, 1);   // ceiling
    room.rectangle({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, 1);  // back
    room.useMaterial(addMaterial(scene, {.diffuse = {0.63f, 0.065f, 0.05f}}));
    room.rectangle({-1, -1, 1}, {0, 0, -2}, {0, 2, 0}, 1);  // left
    room.useMaterial(addMaterial(scene, {.diffuse = {0.14f, 0.45f, 0.091f}}));
    room.rectangle({1, -1, -1}, {0, 0, 2}, {0, 2, 0}, 1);  // right
    addObject(scene, "room", room.take());
    MeshBuilder lamp(addMaterial(scene, {.diffuse = {0, 0, 0}, .emission = {4.0f, 3.4f, 2.5f}}));
    lamp.rectangle({-0.235, 0.998, -0.19}, {0.47, 0, 0}, {0, 0, 0.38}, 1);
    addObject(scene, "lamp", lamp.take());
    // 15.5° and −17°.
    addObject(scene, "tall box",
              standingBox(white, {-0.335, -1, -0.29}, {0.3, 0.6, 0.3}, 0.9636, 0.2672));
    addObject(scene, "short box",
              standingBox(white, {0.328, -1, 0.375}, {0.3, 0.3, 0.3}, 0.9563, -0.2924));
    scene.lights.ambient = {0, 0, 0};
    scene.lights.ambient_light = AmbientLight::bounce;
    scene.lights.rectangles = {{.centre = {{{0, {0, 0.99, 0}}}},
                                .edge_u = {0.47, 0, 0},
                                .edge_v = {0, 0, 0.38},
                                .colour = {2.9f, 2.45f, 1.8f}}};
    setCamera(scene, {.eye = {0, 0, 3.85}, .target = {0, 0, 0}, .fov_y_deg = 39.3}, 0.1, 20);
    return scene;
}

}  // namespace still::scenes
