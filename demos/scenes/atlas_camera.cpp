// Failures of everything that moves as a whole: turning objects and all the ways of the camera.

#include <glm/geometric.hpp>

#include "demos/scenes/atlas_scenes.h"
#include "demos/scenes/atlas_stage.h"
#include "demos/scenes/paint.h"
#include "demos/scenes/scenes.h"
#include "demos/scenes/solids.h"
#include "engine/det_math.h"
#include "engine/shapes.h"

namespace still::scenes::atlas {
namespace {

/// Bricks and boxes, with depth between them.
Scene gallery(const char* name, double half, int boxes, uint32_t seed) {
    Scene scene = makeStage(name);
    addWall(scene, -3, {half * 1.4 + 4, 16}, seed);
    addBoxes(scene, half, boxes, seed + 1);
    return scene;
}

void addPickets(Scene& scene, double half) {
    MeshBuilder out(addMaterial(scene, {.diffuse = {0.85f, 0.85f, 0.8f}}));
    for (int i = 0; 0.45 * i < 2 * half; ++i) {
        const dvec3 foot{-half + 0.45 * i, -7, 0.6};
        const dvec3 path[] = {foot, foot + dvec3{0.1, 14, 0}};
        addTube(out, path, 0.035, 5);
    }
    addObject(scene, "pickets", out.take());
}

/// A rim and spokes of 0.5 … 1.2 pixels at z = 0, around the z axis.
Mesh wheelMesh(uint32_t material) {
    constexpr double kRadius = 2.2;
    constexpr int kSpokes = 36;
    MeshBuilder out(material);
    std::vector<dvec3> rim;
    for (int i = 0; i <= 72; ++i) {
        const double turns = i % 72 / 72.0;
        rim.push_back(dvec3{det::cosTurns(turns), det::sinTurns(turns), 0} * kRadius);
    }
    addTube(out, rim, 0.06, 6);
    for (int i = 0; i < kSpokes; ++i) {
        const double turns = double(i) / kSpokes, width = (0.5 + 0.7 * (i % 4) / 3) * kPixel;
        const dvec3 outward{det::cosTurns(turns), det::sinTurns(turns), 0};
        const dvec3 spoke[] = {outward * 0.3, outward * kRadius};
        addTube(out, spoke, width / 2, 5);
    }
    return out.take();
}

/// Fixed camera at the courtyard's entrance; frames as in its own loop.
constexpr dvec3 kCourtyardEye{-2.0, 1.75, 11.5}, kCourtyardTarget{0.8, 2.62, -2.0};

/// `v` turned about the vertical.
dvec3 turned(const dvec3& v, double turns) {
    const double c = det::cosTurns(turns), s = det::sinTurns(turns);
    return {v.x * c + v.z * s, v.y, v.z * c - v.x * s};
}

Scene courtyard(const char* name) {
    Scene scene = makeCourtyard();
    scene.name = name;
    return scene;
}

}  // namespace

Scene makeRotate() {
    Scene scene = makeStage("atlas-rotate");
    addWall(scene, -3.5, {14, 8}, 120);
    const int32_t checks = addTexture(scene, paintChecker({.cells = 4, .seed = 121}, 128));
    MeshBuilder cube(addMaterial(scene, {.diffuse = {1, 0.9f, 0.7f}, .colour_texture = checks}));
    cube.append(shapes::box(1.25f, 1.25f, 1.25f), dmat4{1.0});
    SceneObject& turning = addObject(scene, "cube", cube.take());
    turning.tracks.translation.keys = {{0, {-5.2, 0.2, 0}}};
    turning.tracks.rotation_axis = unit({1, 2, 0.5});
    turning.tracks.rotation_deg.keys = {{0, 10}, {kFrames, 10 + 3.0 * kFrames}};
    const uint32_t steel = addMaterial(scene, {.diffuse = {0.8f, 0.82f, 0.85f}});
    SceneObject& wheel = addObject(scene, "wheel", wheelMesh(steel));
    wheel.tracks.translation.keys = {{0, {-0.6, -1.2, 0}}};
    wheel.tracks.rotation_axis = {0, 0, 1};
    wheel.tracks.rotation_deg.keys = {{0, 0}, {kFrames, 3.0 * kFrames}};
    MeshBuilder knot(addMaterial(
        scene, {.diffuse = {0.55f, 0.3f, 0.06f}, .specular = {2, 1.8f, 1.4f}, .shininess = 300}));
    addTorusKnot(knot, {.segments = 128, .sides = 12});
    SceneObject& shiny = addObject(scene, "knot", knot.take());
    shiny.tracks.translation.keys = {{0, {4.9, 0, 0}}};
    shiny.tracks.scale.keys = {{0, dvec3{1.7}}};
    shiny.tracks.rotation_axis = unit({1, 0.4, 0.3});
    shiny.tracks.rotation_deg.keys = {{0, 60}, {kFrames, 60 + 3.0 * kFrames}};
    return scene;
}

Scene makeRoll() {
    Scene scene = gallery("atlas-roll", 14, 18, 122);
    addPickets(scene, 14);
    setTrack<dvec3>(scene.camera.up, [](int frame) {
        const double turns = frame / 360.0;
        return dvec3{det::sinTurns(turns), det::cosTurns(turns), 0};
    });
    return scene;
}

Scene makeZoom() {
    Scene scene = gallery("atlas-zoom", 11, 14, 124);
    addPickets(scene, 11);
    scene.camera.fov_y_deg.keys = {{0, kFovY_deg}, {kFrames, 20}};
    return scene;
}

Scene makeFastPan() {
    Scene scene = gallery("atlas-fast-pan", 112, 170, 126);
    truck(scene, dvec2{60, 0});
    return scene;
}

Scene makeScreenEdges() {
    Scene scene = gallery("atlas-screen-edges", 14, 18, 128);
    addPickets(scene, 14);
    truck(scene, dvec2{2.6, 1.7});
    return scene;
}

Scene makeCut() {
    constexpr int kCut = 24;
    Scene scene = gallery("atlas-cut", 18, 24, 130);
    addPickets(scene, 16);
    scene.cuts = {kCut};
    truck(scene, [](int frame) {
        return frame < kCut ? dvec2{frame - 120.0, 0} : dvec2{frame + 90.0, 24};
    });
    return scene;
}

Scene makeResize() {
    Scene scene = gallery("atlas-resize", 11, 14, 132);
    addPickets(scene, 11);
    return scene;
}

Scene makeLong() {
    Scene scene = makeFenceStill();
    scene.name = "atlas-long";
    MeshBuilder out(addMaterial(scene, {.diffuse = {0.02f, 0.02f, 0.03f}}));
    for (int i = 0; i < 8; ++i) {
        addCable(out, {-8, -4.0 + i, 2}, {8, -3.0 + 1.1 * i, 2}, 0.3, 0.004 + 0.002 * i, 12, 6);
    }
    addObject(scene, "wires", out.take());
    MeshBuilder pane(addMaterial(
        scene,
        {.diffuse = {0.25f, 0.45f, 0.75f}, .opacity = 0.4f, .alpha_mode = AlphaMode::stochastic}));
    pane.rectangle({-4, -2, 2.2}, {5, 0, -0.5}, {0, 3.5, 0}, 1.0);
    addObject(scene, "pane", pane.take());
    return scene;
}

Scene makeCourtyardStill() {
    return courtyard("atlas-courtyard-still");
}

Scene makeCourtyardPan() {
    Scene scene = courtyard("atlas-courtyard-pan");
    // 90 / tan(55° / 2) pixels per unit of offset / distance, along the level part of the view.
    constexpr double kSpeed = 4.0 / 3, kScale = 172.88838;
    const dvec3 ahead = kCourtyardTarget - kCourtyardEye;
    const double level = glm::length(dvec2{ahead.x, ahead.z}) / glm::length(ahead);
    const double per_frame = kSpeed / (kScale * level * 6.283185307179586);
    setTrack<dvec3>(scene.camera.target, [&](int frame) {
        return kCourtyardEye + turned(ahead, per_frame * (kFrames / 2 - frame));
    });
    return scene;
}

Scene makeCourtyardOrbit() {
    Scene scene = courtyard("atlas-courtyard-orbit");
    const dvec3 back = kCourtyardEye - kCourtyardTarget;
    setTrack<dvec3>(scene.camera.eye,
                    [&](int frame) { return kCourtyardTarget + turned(back, 0.4 / 360 * frame); });
    return scene;
}

}  // namespace still::scenes::atlas
