// Failures of shading that changes where nothing moves, and of surfaces that are only partly there.

#include "demos/scenes/atlas_scenes.h"
#include "demos/scenes/atlas_stage.h"
#include "demos/scenes/noise.h"
#include "demos/scenes/paint.h"
#include "demos/scenes/solids.h"
#include "engine/shapes.h"

namespace still::scenes::atlas {
namespace {

constexpr int kSwitch = 24;

/// A dim room with one lamp.
Scene room(const char* name) {
    Scene scene = makeStage(name);
    const Bond bond{.columns = 4, .rows = 8, .aspect = 2, .relief = 1.5, .seed = 141};
    MeshBuilder wall(
        addMaterial(scene, {.diffuse = {1, 1, 1},
                            .specular = {0.15f, 0.15f, 0.15f},
                            .shininess = 25,
                            .colour_texture = addTexture(scene, paintBond(bond, 128)),
                            .normal_texture = addTexture(scene, paintBondRelief(bond, 128))}));
    wall.rectangle({-14, -4, -3}, {28, 0, 0}, {0, 12, 0}, 3.4);
    wall.rectangle({-14, -4, 6}, {28, 0, 0}, {0, 0, -9}, 3.4);
    addObject(scene, "wall and floor", wall.takeWithTangents());
    for (int i = 0; i < 3; ++i) {
        MeshBuilder ball(addMaterial(scene, {.diffuse = {0.25f, 0.3f, 0.4f},
                                             .specular = {0.8f, 0.8f, 0.8f},
                                             .shininess = i == 0 ? 8.0f : 60.0f * float(i)}));
        ball.append(shapes::sphere(32, 16), placed({-4.0 + 4.0 * i, -2.4, 0.2}, dvec3{1.6}));
        addObject(scene, "sphere " + std::to_string(i), ball.take());
    }
    const int32_t link = addTexture(scene, paintChainLink(4, 0.14, 128));
    MeshBuilder fence(addMaterial(
        scene,
        {.diffuse = {0.75f, 0.77f, 0.8f}, .alpha_mode = AlphaMode::test, .alpha_texture = link}));
    fence.rectangle({-8, -0.2, -1.5}, {16, 0, 0}, {0, 2.4, 0}, 2.4);
    addObject(scene, "chain link", fence.take());
    MeshBuilder wires(addMaterial(scene, {.diffuse = {0.9f, 0.85f, 0.8f}}));
    for (int i = 0; i < 6; ++i) {
        addCable(wires, {-9, 2.2 + 0.3 * i, -1}, {9, 3.0 + 0.35 * i, -1}, 0.4,
                 (0.2 + 0.1 * i) * kPixel, 12, 5);
    }
    addObject(scene, "wires", wires.take());
    scene.lights = {};
    scene.lights.ambient = {0.10f, 0.10f, 0.13f};
    scene.lights.points = {{{-1.5f, 2.2f, 2.5f}, {14.0f, 10.0f, 5.0f}}};
    return scene;
}

void setLamp(Scene& scene, Track<double> intensity) {
    scene.lights.point_intensity = {std::move(intensity)};
}

Scene glass(const char* name, double speed) {
    Scene scene = makeStage(name);
    addWall(scene, -3, {14, 8}, 142);
    addBoxes(scene, 9, 9, 143);
    const std::array<float, 3> tints[] = {{0.2f, 0.45f, 0.85f}, {0.85f, 0.3f, 0.4f}};
    for (int i = 0; i < 2; ++i) {
        MeshBuilder pane(addMaterial(scene, {.diffuse = tints[i],
                                             .specular = {0.4f, 0.4f, 0.4f},
                                             .shininess = 60,
                                             .opacity = i == 0 ? 0.35f : 0.6f,
                                             .alpha_mode = AlphaMode::stochastic}));
        pane.rectangle({-3.5, -2.4, 0}, {7, 0, 0}, {0.8, 4.8, 0}, 1.0);
        SceneObject& object = addObject(scene, "pane " + std::to_string(i), pane.take());
        const dvec3 at{-1.8 + 3.6 * i, -0.6 + 1.2 * i, 1.2 + 0.4 * i};
        object.tracks.translation.keys = {{0, at}};
        if (speed != 0) {
            // What is nearer than z = 0 looks faster.
            const double scale = (kEyeDistance - at.z) / kEyeDistance;
            slide(object, at, dvec2{i == 0 ? speed : -speed, 0} * scale);
        }
    }
    return scene;
}

}  // namespace

Scene makeLightOn() {
    Scene scene = room("atlas-light-on");
    setLamp(scene, {{{0, 0}, {kSwitch - 1, 0}, {kSwitch, 1}}});
    return scene;
}

Scene makeLightOff() {
    Scene scene = room("atlas-light-off");
    setLamp(scene, {{{0, 1}, {kSwitch - 1, 1}, {kSwitch, 0}}});
    return scene;
}

Scene makeLightFlicker() {
    Scene scene = room("atlas-light-flicker");
    Track<double> intensity;
    setTrack<double>(intensity, [](int frame) { return hashRange(frame, 0, 144, 0.25, 1.25); });
    setLamp(scene, std::move(intensity));
    return scene;
}

Scene makeGlassStill() {
    return glass("atlas-glass-still", 0);
}
Scene makeGlassMove() {
    return glass("atlas-glass-move", 1.5);
}

}  // namespace still::scenes::atlas
