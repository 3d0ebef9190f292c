#include "demos/scenes/courtyard.h"

#include <cmath>

#include "demos/scenes/scene_builder.h"
#include "demos/scenes/scenes.h"
#include "demos/scenes/solids.h"
#include "engine/det_math.h"
#include "engine/shapes.h"

namespace still::scenes {
namespace {

using namespace courtyard;

/// A knot that flies once around the fountain while it turns twice about its own slanted axis.
void addFlyingKnot(Scene& scene, const Palette& palette) {
    MeshBuilder out(palette.knot);
    addTorusKnot(out, {});
    SceneObject& knot = addObject(scene, "flying knot", out.take());
    knot.tracks.scale.keys = {{0, dvec3{0.52}}};
    constexpr int kKeys = 60;
    for (int i = 0; i <= kKeys; ++i) {
        const double t = double(i) / kKeys, turns = t + 0.87;
        const dvec3 offset{3.5 * det::cosTurns(turns), 2.15 + 0.35 * det::sinTurns(2 * t),
                           -3.5 * det::sinTurns(turns)};
        knot.tracks.translation.keys.push_back({t * kLoopFrames, kFountain + offset});
    }
    knot.tracks.rotation_axis = unit({0.3, 1.0, 0.2});
    knot.tracks.rotation_deg.keys = {{0, 0}, {kLoopFrames, 720}};
}

/// The ball's shadow on the path, for a ball above the origin: an ellipse, long along the sun.
Mesh ballShadow(const Palette& palette, double radius) {
    constexpr int kSteps = 40;
    const dvec3 per_metre = kSun / -kSun.y;
    const dvec3 flat{kSun.x, 0, kSun.z};
    const double length = std::sqrt(flat.x * flat.x + flat.z * flat.z);
    const dvec3 along = flat / length, across{along.z, 0, -along.x};
    const double stretch = std::sqrt(1 + length * length / (kSun.y * kSun.y));
    const dvec3 centre{per_metre.x * radius, 0.005, per_metre.z * radius};
    std::vector<dvec3> corners;
    std::vector<dvec2> uvs;
    for (int i = 0; i < kSteps; ++i) {
        const double turns = double(i) / kSteps;
        corners.push_back(centre + along * (radius * stretch * det::cosTurns(turns)) +
                          across * (radius * det::sinTurns(turns)));
        uvs.push_back(dvec2{corners.back().x, -corners.back().z} / 3.0);
    }
    MeshBuilder out(palette.path_shaded);
    out.polygon(corners, uvs);
    return out.take();
}

/// A ball that rolls across the court without slipping and comes back.
void addRollingBall(Scene& scene, const Palette& palette) {
    constexpr double kRadius = 0.36, kWay = 4.8, kDegreesPerMetre = 57.29577951308232 / kRadius;
    MeshBuilder out(palette.ball);
    out.append(shapes::sphere(40, 20), dmat4{1.0});
    addObject(scene, "rolling ball", out.take());
    const dvec3 start{-4.6, kRadius, 3.9};
    SceneObject& shadow = addObject(scene, "ball shadow", ballShadow(palette, kRadius));
    SceneObject& ball = scene.objects[scene.objects.size() - 2];
    // The stripes' pole lies along the axis of rolling.
    ball.base = dmat4{{kRadius, 0, 0, 0}, {0, 0, kRadius, 0}, {0, -kRadius, 0, 0}, {0, 0, 0, 1}};
    ball.tracks.rotation_axis = {0, 0, -1};
    for (int i = 0; i <= 40; ++i) {
        const double way = kWay * (0.5 - 0.5 * det::cosTurns(i / 40.0));
        const double frame = i * (kLoopFrames / 40.0);
        ball.tracks.translation.keys.push_back({frame, start + dvec3{way, 0, 0}});
        shadow.tracks.translation.keys.push_back({frame, dvec3{start.x + way, 0, start.z}});
        ball.tracks.rotation_deg.keys.push_back({frame, way * kDegreesPerMetre});
    }
}

void setLight(Scene& scene) {
    const dvec3 sun = unit(kSun);
    scene.lights.ambient = {float(kAmbient.x), float(kAmbient.y), float(kAmbient.z)};
    scene.lights.sun.direction = {float(sun.x), float(sun.y), float(sun.z)};
    scene.lights.sun.colour = {float(kSunColour.x), float(kSunColour.y), float(kSunColour.z)};
    scene.background = {0.30f, 0.52f, 0.86f};
}

CameraPose pose(const dvec3& eye, const dvec3& target, double fov_y_deg) {
    return {.eye = eye, .target = target, .up = {0, 1, 0}, .fov_y_deg = fov_y_deg};
}

}  // namespace

Scene makeCourtyard() {
    Scene scene;
    scene.name = "courtyard";
    const Palette palette = addPalette(scene);
    addHorizon(scene, palette);
    addGround(scene, palette);
    addColumns(scene, palette);
    addWings(scene, palette);
    addRoofs(scene, palette);
    addFountain(scene, palette);
    addFlyingKnot(scene, palette);
    addRollingBall(scene, palette);
    addFence(scene, palette);
    addPowerLines(scene, palette);
    addPlants(scene, palette);
    addLantern(scene, palette);
    setLight(scene);
    const CameraPose entrance = pose({-2.0, 1.75, 11.5}, {0.8, 2.62, -2.0}, 55);
    setCamera(scene, entrance, 0.05, 800);
    scene.views = {{"entrance", entrance},
                   {"fence", pose({6.2, 1.6, 6.5}, {9.6, 1.7, 0.5}, 50)},
                   {"wires", pose({2.0, 1.7, 8.0}, {9.5, 7.0, -10.0}, 50)},
                   {"top", pose({13.0, 17.0, 19.0}, {-1.0, 0.5, -2.0}, 45)},
                   {"grazing", pose({-3.0, 0.35, 12.5}, {1.5, 0.55, -4.0}, 50)}};
    return scene;
}

}  // namespace still::scenes
