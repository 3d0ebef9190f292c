// Failures inside surfaces: patterns finer than pixels, and what depends on depth.

#include "demos/scenes/atlas_scenes.h"
#include "demos/scenes/atlas_stage.h"
#include "demos/scenes/noise.h"
#include "demos/scenes/paint.h"
#include "demos/scenes/scenes.h"
#include "engine/det_math.h"
#include "engine/texture.h"

namespace still::scenes::atlas {
namespace {

uint8_t toByte(double value) {
    return uint8_t(value + 0.5);
}

Rgba8 grey(double value) {
    return {toByte(value), toByte(value), toByte(value), 255};
}

/// Rings whose frequency grows with the radius: one cycle per pixel at 160 pixels, the left and
/// right border of the picture. 64 texels per unit are 3.2 per pixel, so that the texture itself
/// is sampled well and only the pixels alias.
Texture zonePlateTexture() {
    constexpr int kWidth = 1280, kHeight = 720;
    constexpr double kTexelsPerPixel = 64 * kPixel, kCyclesPerPixel2 = 1.0 / 320;
    Image<Rgba8> image(kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const double dx = (x + 0.5 - kWidth / 2) / kTexelsPerPixel;
            const double dy = (y + 0.5 - kHeight / 2) / kTexelsPerPixel;
            image.at(x, y) =
                grey(127.5 + 100 * det::cosTurns((dx * dx + dy * dy) * kCyclesPerPixel2));
        }
    }
    return withoutMips(makeColourTexture(image.view(), Wrap::clamp));
}

Scene zonePlate(const char* name) {
    Scene scene = makeStage(name);
    setFlatLight(scene);
    MeshBuilder plate(addMaterial(
        scene, {.diffuse = {1, 1, 1}, .colour_texture = addTexture(scene, zonePlateTexture())}));
    const dvec3 corners[] = {{-10, -5.625, 0}, {10, -5.625, 0}, {10, 5.625, 0}, {-10, 5.625, 0}};
    const dvec2 uvs[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    plate.polygon(corners, uvs);
    addObject(scene, "zone plate", plate.take());
    return scene;
}

/// Two by two checks with edges of one texel.
Texture sharpChecks(const glm::dvec3& light, const glm::dvec3& dark) {
    constexpr int kSize = 64;
    Image<Rgba8> image(kSize, kSize);
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            const glm::dvec3& c = (x < kSize / 2) == (y < kSize / 2) ? light : dark;
            image.at(x, y) = {toByte(c.x), toByte(c.y), toByte(c.z), 255};
        }
    }
    return withoutMips(makeColourTexture(image.view(), Wrap::repeat));
}

/// Checks of one unit, two units below and above the eye, which looks level.
Scene checker(const char* name) {
    Scene scene = makeStage(name);
    setFlatLight(scene);
    scene.camera.far = 2000;
    const int32_t cold = addTexture(scene, sharpChecks({235, 240, 245}, {20, 22, 26}));
    const int32_t warm = addTexture(scene, sharpChecks({230, 190, 120}, {110, 40, 30}));
    MeshBuilder floor(addMaterial(scene, {.diffuse = {1, 1, 1}, .colour_texture = cold}));
    floor.rectangle({-600.3, -2, 600.2}, {1200, 0, 0}, {0, 0, -1200}, 2.0);
    addObject(scene, "floor", floor.take());
    MeshBuilder ceiling(addMaterial(scene, {.diffuse = {1, 1, 1}, .colour_texture = warm}));
    ceiling.rectangle({-600.1, 2, -600.4}, {1200, 0, 0}, {0, 0, 1200}, 2.0);
    addObject(scene, "ceiling", ceiling.take());
    return scene;
}

/// A normal of its own for every texel.
Texture roughNormals(double slope, uint32_t seed) {
    constexpr int kSize = 128;
    Image<Rgba8> image(kSize, kSize);
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            const auto random = [&](uint32_t k) {
                return slope * (hashUnit(x, y, seed + k) + hashUnit(x, y, seed + 2 + k) - 1);
            };
            const dvec3 normal = (unit({random(0), random(1), 1}) + 1.0) * 127.5;
            image.at(x, y) = {toByte(normal.x), toByte(normal.y), toByte(normal.z), 255};
        }
    }
    return withoutMips(makeNormalTexture(image.view(), Wrap::repeat));
}

/// A slope that mirrors the sun into the eye, at 2 … 5 normals per pixel.
Scene sparkle(const char* name) {
    Scene scene = makeStage(name);
    const dvec3 sun = unit({0.1, -1, -0.1});
    scene.lights.ambient = {0.12f, 0.13f, 0.16f};
    scene.lights.sun.direction = {float(sun.x), float(sun.y), float(sun.z)};
    scene.lights.sun.colour = {1.0f, 0.95f, 0.85f};
    MeshBuilder slope(
        addMaterial(scene, {.diffuse = {0.10f, 0.16f, 0.30f},
                            .specular = {3, 3, 3},
                            .shininess = 600,
                            .normal_texture = addTexture(scene, roughNormals(0.35, 111))}));
    slope.rectangle({-16, -6, 4}, {32, 0, 0}, {0, 14, -14}, 2.5);
    addObject(scene, "slope", slope.takeWithTangents());
    return scene;
}

/// Opacity grows from left to right; 8 × 8 ordered dither, one texel = one pixel when seen from
/// the front at z = 0.
AlphaTexture ditherTexture() {
    constexpr int kSize = 128;
    Image<Rgba8> image(kSize, kSize);
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            int rank = 0;  // bit-interleaved x ^ y and y, Bayer's order
            for (int bit = 0; bit < 3; ++bit) {
                const int bx = x >> bit & 1, by = y >> bit & 1;
                rank |= (bx ^ by) << (5 - 2 * bit) | by << (4 - 2 * bit);
            }
            const bool opaque = (x + 0.5) / kSize > (rank + 0.5) / 64;
            image.at(x, y) = {255, 255, 255, uint8_t(opaque ? 255 : 0)};
        }
    }
    return withoutMips(makeAlphaTexture(image.view(), Wrap::repeat, true));
}

Scene dither(const char* name) {
    Scene scene = makeStage(name);
    addWall(scene, -3, {14, 8}, 112);
    addBoxes(scene, 9, 9, 113);
    const int32_t alpha = addTexture(scene, ditherTexture());
    MeshBuilder panes(addMaterial(
        scene,
        {.diffuse = {0.25f, 0.5f, 0.8f}, .alpha_mode = AlphaMode::test, .alpha_texture = alpha}));
    panes.rectangle({-7, -3.2, 1.4}, {6.4, 0.6, 0}, {-0.6, 6.4, 0}, 6.4);
    panes.rectangle({0.8, -3.2, 1.4}, {6.0, 0, -1.6}, {0, 6.4, 0}, 6.4);
    addObject(scene, "dithered panes", panes.take());
    return scene;
}

/// Coarse bricks with deep joints, in the corner of a room.
Scene parallax(const char* name) {
    Scene scene = makeStage(name);
    const Bond bond{.columns = 4,
                    .rows = 8,
                    .joint = 0.3,
                    .aspect = 2,
                    .block = {190, 120, 84},
                    .mortar = {70, 66, 62},
                    .variation = 0.3,
                    .relief = 1.0,
                    .seed = 115};
    MeshBuilder bricks(
        addMaterial(scene, {.diffuse = {1, 1, 1},
                            .colour_texture = addTexture(scene, paintBond(bond, 256)),
                            .normal_texture = addTexture(scene, paintBondRelief(bond, 256)),
                            .height_texture = addTexture(scene, paintBondHeight(bond, 256)),
                            .height_scale = 0.05f}));
    bricks.rectangle({-4, -2.4, 8}, {24, 0, 0}, {0, 0, -16}, 4.0);
    bricks.rectangle({-4, -2.4, 8}, {0, 0, -16}, {0, 12, 0}, 4.0);
    bricks.rectangle({-4, -2.4, -8}, {24, 0, 0}, {0, 12, 0}, 4.0);
    addObject(scene, "bricks", bricks.takeWithTangents());
    return scene;
}

}  // namespace

Scene makeZonePlateStill() {
    return zonePlate("atlas-zone-plate-still");
}
Scene makeZonePlateSlow() {
    Scene scene = zonePlate("atlas-zone-plate-slow");
    truck(scene, [](int frame) { return dvec2{slowPanWay(frame), 0}; });
    return scene;
}
Scene makeZonePlateHalf() {
    Scene scene = zonePlate("atlas-zone-plate-half");
    truck(scene, dvec2{0.5, 0});
    return scene;
}

Scene makeCheckerStill() {
    return checker("atlas-checker-still");
}
Scene makeCheckerSlow() {
    Scene scene = checker("atlas-checker-slow");
    turn(scene, slowPanWay);
    return scene;
}
Scene makeCheckerHalf() {
    Scene scene = checker("atlas-checker-half");
    turn(scene, [](int frame) { return 0.5 * frame; });
    return scene;
}

Scene makeSparkleStill() {
    return sparkle("atlas-sparkle-still");
}
Scene makeSparklePan() {
    Scene scene = sparkle("atlas-sparkle-pan");
    truck(scene, dvec2{0.7, 0});
    return scene;
}

Scene makeParallaxStill() {
    return parallax("atlas-parallax-still");
}
Scene makeParallaxPan() {
    Scene scene = parallax("atlas-parallax-pan");
    truck(scene, dvec2{1.2, 0.3});
    return scene;
}

Scene makeDepthPan() {
    Scene scene = makeDepth();
    scene.name = "atlas-depth-pan";
    // Behind everything, so that the panes uncover something.
    const Bond bond{.columns = 4, .rows = 8, .aspect = 2, .seed = 114};
    MeshBuilder wall(addMaterial(
        scene, {.diffuse = {1, 1, 1}, .colour_texture = addTexture(scene, paintBond(bond, 128))}));
    wall.rectangle({-900, -500, -950}, {1800, 0, 0}, {0, 1000, 0}, 250);
    addObject(scene, "backdrop", wall.take());
    // The scene's own field of view is 45°: 217 pixels per unit of offset / distance. The nearest
    // pane is 0.02 away.
    constexpr double kSpeed = 1e-4;
    scene.camera.eye.keys = {{0, {-kSpeed * kFrames / 2, 0, 0}},
                             {kFrames, {kSpeed * kFrames / 2, 0, 0}}};
    scene.camera.target.keys = {{0, {-kSpeed * kFrames / 2, 0, -1}},
                                {kFrames, {kSpeed * kFrames / 2, 0, -1}}};
    return scene;
}

Scene makeDitherStill() {
    return dither("atlas-dither-still");
}
Scene makeDitherPan() {
    Scene scene = dither("atlas-dither-pan");
    truck(scene, dvec2{0.7, 0});
    return scene;
}

}  // namespace still::scenes::atlas
