#include "demos/scenes/atlas_stage.h"

#include <algorithm>

#include "demos/scenes/noise.h"
#include "demos/scenes/paint.h"
#include "engine/det_math.h"

namespace still::scenes::atlas {

double slowPanSpeed(int frame) {
    return 0.1 + 0.4 * std::clamp((frame - 24) / 15.0, 0.0, 1.0);
}

double slowPanWay(int frame) {
    double way = 0;
    for (int i = 1; i <= frame; ++i) {
        way += slowPanSpeed(i);
    }
    return way;
}

Scene makeStage(const char* name) {
    Scene scene;
    scene.name = name;
    setDaylight(scene);
    scene.background = {0.3f, 0.45f, 0.7f};
    setCamera(scene, {.eye = {0, 0, kEyeDistance}, .target = {0, 0, 0}, .fov_y_deg = kFovY_deg},
              0.1, 200);
    return scene;
}

void setFlatLight(Scene& scene) {
    scene.lights = {};
    scene.lights.ambient = {1, 1, 1};
}

void truck(Scene& scene, const std::function<dvec2(int frame)>& pixels) {
    const dvec3 eye = scene.camera.eye.keys.front().value;
    const dvec3 target = scene.camera.target.keys.front().value;
    const auto shift = [&](int frame) { return dvec3(pixels(frame) * kPixel, 0); };
    setTrack<dvec3>(scene.camera.eye, [&](int frame) { return eye + shift(frame); });
    setTrack<dvec3>(scene.camera.target, [&](int frame) { return target + shift(frame); });
}

void truck(Scene& scene, const dvec2& speed) {
    truck(scene, [&](int frame) { return speed * double(frame - kFrames / 2); });
}

void turn(Scene& scene, const std::function<double(int frame)>& pixels) {
    constexpr double kTurnsPerPixel = 1 / (kPixelsPerUnit * 6.283185307179586);
    const dvec3 eye = scene.camera.eye.keys.front().value;
    setTrack<dvec3>(scene.camera.target, [&](int frame) {
        const double turns = pixels(frame) * kTurnsPerPixel;
        return eye + dvec3{det::sinTurns(turns), 0, -det::cosTurns(turns)} * kEyeDistance;
    });
}

void slide(SceneObject& object, const dvec3& middle, const dvec2& speed) {
    const dvec3 way = dvec3(speed * (kPixel * kFrames / 2), 0);
    object.tracks.translation.keys = {{0, middle - way}, {kFrames, middle + way}};
}

void addWall(Scene& scene, double z, const dvec2& half, uint32_t seed) {
    const Bond bond{.columns = 4, .rows = 8, .aspect = 2, .variation = 0.3, .seed = seed};
    MeshBuilder wall(addMaterial(
        scene, {.diffuse = {1, 1, 1}, .colour_texture = addTexture(scene, paintBond(bond, 128))}));
    wall.rectangle({-half.x, -half.y, z}, {2 * half.x, 0, 0}, {0, 2 * half.y, 0}, 3.4);
    addObject(scene, "wall", wall.take());
}

void addBoxes(Scene& scene, double half, int count, uint32_t seed) {
    const int32_t checks = addTexture(scene, paintChecker({.cells = 4, .seed = seed}, 128));
    const std::array<float, 3> tints[] = {{1, 1, 1}, {1, 0.55f, 0.4f}, {0.5f, 0.75f, 1}};
    MeshBuilder out;
    for (int colour = 0; colour < 3; ++colour) {
        out.useMaterial(addMaterial(scene, {.diffuse = tints[colour], .colour_texture = checks}));
        for (int i = colour; i < count; i += 3) {
            const double size = hashRange(i, 1, seed, 0.3, 0.9);
            const double rise = hashRange(i, 2, seed, 1.5, 6.0);
            const dvec3 foot{-half + 2 * half * (i + 0.5) / count, -5,
                             hashRange(i, 0, seed, -2.5, 1.0)};
            const dvec3 up{0, i % 4 == 1 ? 10 - rise : 0.0, 0};  // some hang
            out.box(foot + up - dvec3{size, 0, 0.4}, foot + up + dvec3{size, rise, 0.4}, 2.0);
        }
    }
    addObject(scene, "boxes", out.take());
}

}  // namespace still::scenes::atlas
