// The contents of the built-in scenes for measuring. All have the same camera, whose picture at
// z = 0 is kHalfWidth × kHalfHeight around the origin at 16:9, and one textured Lambert material
// per object, so that renderers differ by nothing but their speed.

#include "demos/scenes/bench_content.h"

#include <cmath>
#include <functional>

#include "demos/scenes/bench_scenes.h"
#include "demos/scenes/noise.h"
#include "demos/scenes/paint.h"
#include "demos/scenes/scene_builder.h"
#include "engine/det_math.h"
#include "engine/shapes.h"

namespace still::scenes {
namespace {

constexpr double kDistance = 10, kFovDeg = 50;
const double kHalfHeight = kDistance * det::tanDegrees(kFovDeg / 2);
const double kHalfWidth = kHalfHeight * 16 / 9;
constexpr int kTextureSize = 512;
/// World size that moves by kPanPx on a picture of 1080 rows.
const double kStep = kPanPx * 2 * kHalfHeight / 1080;

Scene makeBase(const char* name) {
    Scene scene;
    scene.name = name;
    setDaylight(scene);
    scene.background = {0.1f, 0.12f, 0.15f};
    setCamera(scene, {.eye = {0, 0, kDistance}, .target = {0, 0, 0}, .fov_y_deg = kFovDeg}, 0.5,
              100);
    return scene;
}

uint32_t addTextured(Scene& scene, Texture texture) {
    return addMaterial(
        scene, {.diffuse = {1, 1, 1}, .colour_texture = addTexture(scene, std::move(texture))});
}

/// Slides along `way` and back, over and over.
void slide(SceneObject& object, const dvec3& from, const dvec3& way) {
    object.tracks.translation.keys.clear();
    for (int i = 0; i * kPanTurn <= kBenchFrames; ++i) {
        object.tracks.translation.keys.push_back(
            {double(i * kPanTurn), i % 2 == 0 ? from : from + way});
    }
}

/// A rectangle around the origin, cut into columns × rows quads, with relief.
struct Field {
    double half_width, half_height;
    int columns, rows;
    double relief;  ///< world units
    uint32_t seed;
};

Mesh makeField(const Field& f, uint32_t material) {
    constexpr int kCells = 64;
    const auto height = [&](double x, double y) {
        return f.relief * (valueNoise(x * 2, y * 2, kCells, kCells, f.seed) - 0.5);
    };
    MeshBuilder out(material);
    const uint32_t first = out.vertexCount();
    for (int row = 0; row <= f.rows; ++row) {
        for (int column = 0; column <= f.columns; ++column) {
            const double x = f.half_width * (2.0 * column / f.columns - 1);
            const double y = f.half_height * (2.0 * row / f.rows - 1);
            constexpr double kEpsilon = 1e-3;
            const dvec3 normal{height(x - kEpsilon, y) - height(x + kEpsilon, y),
                               height(x, y - kEpsilon) - height(x, y + kEpsilon), 2 * kEpsilon};
            out.vertex({x, y, height(x, y)}, unit(normal), dvec2{x, y} / 2.0);
        }
    }
    out.gridTriangles(first, f.columns, f.rows);
    return out.take();
}

/// Four layers that cover the picture, the nearest with number 0.
Scene makeFill(const char* name, bool front_to_back) {
    Scene scene = makeBase(name);
    const uint32_t materials[] = {
        addTextured(scene, paintBond({.seed = 301}, kTextureSize)),
        addTextured(scene, paintChecker({.seed = 302}, kTextureSize)),
        addTextured(scene, paintMottle({.seed = 303}, kTextureSize)),
        addTextured(scene, paintBoards(7, {150, 110, 70}, 304, kTextureSize))};
    for (int i = 0; i < 4; ++i) {
        const int layer = front_to_back ? i : 3 - i;
        const double scale = 1.3 * (kDistance + layer) / kDistance;  // also while it moves
        const double w = kHalfWidth * scale, h = kHalfHeight * scale;
        MeshBuilder out(materials[layer]);
        out.rectangle({-w, -h, 0}, {2 * w, 0, 0}, {0, 2 * h, 0}, 3.0);
        SceneObject& object = addObject(scene, "layer " + std::to_string(layer), out.take());
        object.tracks.translation.keys = {{0, {0, 0, -double(layer)}}};
        if (layer == 0) {
            slide(object, {0, 0, 0}, dvec3{kStep, 0.2 * kStep, 0} * double(kPanTurn));
        }
    }
    return scene;
}

}  // namespace

Scene makeBenchTiny() {
    constexpr int kColumns = 4, kRows = 2, kQuads = 250;
    Scene scene = makeBase("bench-tiny");
    const uint32_t materials[] = {addTextured(scene, paintMottle({.seed = 311}, kTextureSize)),
                                  addTextured(scene, paintBond({.seed = 312}, kTextureSize))};
    const double w = kHalfWidth / kColumns, h = kHalfHeight / kRows;
    for (int i = 0; i < kColumns * kRows; ++i) {
        const Field field{w, h, kQuads, kQuads, 0.25, 320 + uint32_t(i)};
        SceneObject& object = addObject(scene, "field " + std::to_string(i),
                                        makeField(field, materials[size_t(i % 2)]));
        const dvec3 centre{w * (2 * (i % kColumns) + 1 - kColumns),
                           h * (2 * (i / kColumns) + 1 - kRows), 0};
        object.tracks.translation.keys = {{0, centre}};
        if (i == 1 || i == 6) {
            slide(object, centre, dvec3{kStep, 0, 0} * double(kPanTurn));
        }
    }
    return scene;
}

Scene makeBenchMid() {
    Scene scene = makeBase("bench-mid");
    const uint32_t ground = addTextured(scene, paintBond({.seed = 331}, kTextureSize));
    const uint32_t materials[] = {
        addTextured(scene, paintChecker({.seed = 332}, kTextureSize)),
        addTextured(scene, paintStripes(12, {200, 90, 60}, {230, 220, 200}, kTextureSize)),
        addTextured(scene, paintMottle({.seed = 333}, kTextureSize))};
    const double back = 1.2;  // the ground lies behind the origin and fills the picture
    const double scale = (kDistance + back) / kDistance;
    SceneObject& field =
        addObject(scene, "ground",
                  makeField({kHalfWidth * scale, kHalfHeight * scale, 160, 90, 0.4, 340}, ground));
    field.tracks.translation.keys = {{0, {0, 0, -back}}};
    constexpr int kBodies = 14, kColumns = 5;
    for (int i = 0; i < kBodies; ++i) {
        MeshBuilder out(materials[i % 3]);
        out.append(i % 2 == 0 ? shapes::sphere(60, 26) : shapes::torus(0.42f, 60, 25), dmat4{1.0});
        SceneObject& body = addObject(scene, "body " + std::to_string(i), out.take());
        const dvec3 at{
            kHalfWidth * (0.36 * (i % kColumns) - 0.72 + hashRange(i, 0, 341, -0.06, 0.06)),
            kHalfHeight * (0.6 * (i / kColumns) - 0.6 + hashRange(i, 1, 341, -0.1, 0.1)),
            hashRange(i, 2, 341, 0.2, 1.2)};
        body.tracks.scale.keys = {{0, dvec3{0.775}}};
        body.tracks.rotation_axis = unit({1.0, hashRange(i, 3, 341, -1, 1), 0.3});
        body.tracks.rotation_deg.keys = {{0, hashRange(i, 4, 341, 0, 360)}};
        body.tracks.translation.keys = {{0, at}};
        if (i % 4 == 0) {
            slide(body, at, dvec3{kStep, 0.3 * kStep, 0} * double(kPanTurn));
        } else if (i % 4 == 1) {
            body.tracks.rotation_deg.keys.push_back({kBenchFrames, 2.0 * kBenchFrames});
        }
    }
    return scene;
}

Scene makeBenchFillFront() {
    return makeFill("bench-fill-front", true);
}

Scene makeBenchFillBack() {
    return makeFill("bench-fill-back", false);
}

}  // namespace still::scenes
