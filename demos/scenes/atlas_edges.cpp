// Failures at edges: of objects, of thin geometry, of cut-outs, of light against dark.

#include "demos/scenes/atlas_scenes.h"
#include "demos/scenes/atlas_stage.h"
#include "demos/scenes/noise.h"
#include "demos/scenes/paint.h"
#include "demos/scenes/solids.h"
#include "engine/det_math.h"

namespace still::scenes::atlas {
namespace {

const dvec2 kWallHalf{14, 8};

/// Swings once in 32 frames; the greatest speed is 2π/32 of `amplitude` per frame.
constexpr int kSwayFrames = 32;
constexpr double kSwayRadiansPerFrame = 6.283185307179586 / kSwayFrames;

constexpr int kHangingWires = 10, kSpannedWires = 5;
constexpr double kWireLength = 8;

/// Width of wire i of n in units: 0.15 … 0.9 pixels.
double wireWidth(int i, int n) {
    return (0.15 + 0.75 * i / (n - 1)) * kPixel;
}

void addHangingWires(Scene& scene, uint32_t material, bool sway) {
    constexpr double kPeak = 1.5 * kPixel;  // speed of the lower ends
    constexpr double kAmplitude_deg =
        kPeak / kSwayRadiansPerFrame / kWireLength * 57.29577951308232;
    for (int i = 0; i < kHangingWires; ++i) {
        MeshBuilder out(material);
        const dvec3 path[] = {{0, 0, 0}, {0.25 + 0.12 * i, -kWireLength, 0}};
        addTube(out, path, wireWidth(i, kHangingWires) / 2, 6);
        SceneObject& wire = addObject(scene, "hanging wire " + std::to_string(i), out.take());
        wire.tracks.translation.keys = {{0, {-7.5 + 1.45 * i, 4.2, 0}}};
        wire.tracks.rotation_axis = {0, 0, 1};
        if (sway) {
            setTrack<double>(wire.tracks.rotation_deg, [&](int frame) {
                return kAmplitude_deg * det::sinTurns(double(frame) / kSwayFrames + 0.13 * i);
            });
        }
    }
}

void addSpannedWires(Scene& scene, uint32_t material, bool sway) {
    constexpr double kAmplitude = kPixel / kSwayRadiansPerFrame;  // 1 pixel per frame
    for (int i = 0; i < kSpannedWires; ++i) {
        MeshBuilder out(material);
        addCable(out, {-9, 0, 0.2}, {9, 0.6 + 0.3 * i, 0.2}, 0.5 + 0.2 * i,
                 wireWidth(i, kSpannedWires) / 2, 16, 6);
        SceneObject& wire = addObject(scene, "spanned wire " + std::to_string(i), out.take());
        const dvec3 at{0, -2.8 + 1.4 * i, 0};
        wire.tracks.translation.keys = {{0, at}};
        if (sway) {
            setTrack<dvec3>(wire.tracks.translation, [&](int frame) {
                const double phase = double(frame) / kSwayFrames + 0.21 * i;
                return at + dvec3{0, kAmplitude * det::sinTurns(phase), 0};
            });
        }
    }
}

Scene wires(const char* name, bool sway) {
    Scene scene = makeStage(name);
    addWall(scene, -2, kWallHalf, 101);
    const uint32_t dark = addMaterial(scene, {.diffuse = {0.02f, 0.02f, 0.03f}});
    const uint32_t light = addMaterial(scene, {.diffuse = {0.9f, 0.9f, 0.85f}});
    addHangingWires(scene, dark, sway);
    addSpannedWires(scene, light, sway);
    return scene;
}

Scene fence(const char* name) {
    Scene scene = makeStage(name);
    addWall(scene, -3, kWallHalf, 102);
    const int32_t link = addTexture(scene, paintChainLink(4, 0.14, 128));
    MeshBuilder wire(addMaterial(
        scene,
        {.diffuse = {0.75f, 0.77f, 0.8f}, .alpha_mode = AlphaMode::test, .alpha_texture = link}));
    // One mesh of the fence is 12 pixels wide at z = 0; it recedes to the right.
    wire.rectangle({-11, -3.6, 1.1}, {26, 0, -2.6}, {0, 7.2, 0}, 2.4);
    addObject(scene, "chain link", wire.take());
    MeshBuilder posts(addMaterial(scene, {.diffuse = {0.3f, 0.32f, 0.33f}}));
    for (int i = 0; i < 6; ++i) {
        const dvec3 foot{-10.0 + 4.4 * i, -4.5, 1.0 - 0.44 * i};
        const dvec3 path[] = {foot, foot + dvec3{0, 8.3, 0}};
        addTube(posts, path, 0.1, 12);
    }
    addObject(scene, "posts", posts.take());
    return scene;
}

/// Crowns of cards; `degrees` per frame about the vertical.
Scene leaves(const char* name, double degrees) {
    Scene scene = makeStage(name);
    addWall(scene, -3.5, kWallHalf, 103);
    const uint32_t seed = 104;
    const Material material{.diffuse = {1, 1, 1},
                            .alpha_mode = AlphaMode::test,
                            .colour_texture = addTexture(
                                scene, paintLeafColours({150, 180, 70}, {60, 100, 40}, seed, 128)),
                            .alpha_texture = addTexture(scene, paintLeafShapes(seed, 128))};
    MeshBuilder crown(addMaterial(scene, material));
    addFoliage(crown, {.radii = {2.15, 2.6, 2.15}, .cards = 130, .card_size = 1.1, .seed = seed});
    const uint32_t mesh = addMesh(scene, "crown", crown.take());
    for (int i = 0; i < 3; ++i) {
        SceneObject& bush = addObject(scene, "crown " + std::to_string(i), mesh);
        bush.tracks.translation.keys = {{0, {-5.0 + 5.0 * i, 0.4 - 0.5 * i, 0}}};
        if (degrees != 0) {
            bush.tracks.rotation_deg.keys = {{0, 0}, {kFrames, degrees * kFrames}};
        }
    }
    return scene;
}

Scene hdr(const char* name, const dvec2& speed) {
    Scene scene = makeStage(name);
    scene.lights.ambient = {0.05f, 0.05f, 0.06f};
    scene.lights.sun.colour = {0.1f, 0.1f, 0.1f};
    addWall(scene, -1.5, kWallHalf, 105);
    MeshBuilder bars(addMaterial(scene, {.diffuse = {0, 0, 0}, .emission = {16, 16, 16}}));
    for (int i = 0; i < 6; ++i) {  // slanted bars, 0.5 … 10 pixels wide
        const double width = (0.5 + 1.9 * i) * kPixel, x = -5.5 + 2.2 * i;
        bars.rectangle({x - 0.4, -3.6, 0}, {width, 0, 0}, {0.8, 7.2, 0}, 1);
    }
    bars.rectangle({-7, 0.2, 0}, {14, 0.9, 0}, {0, 0.1, 0}, 1);
    addObject(scene, "bright bars", bars.take());
    MeshBuilder shades(addMaterial(scene, {.diffuse = {0.02f, 0.02f, 0.02f}}));
    for (int i = 0; i < 4; ++i) {  // dark laths before the bars
        shades.rectangle({-8, -2.9 + 1.7 * i, 0.5}, {16, -0.5, 0}, {0, 0.12, 0}, 1);
    }
    addObject(scene, "dark laths", shades.take());
    if (speed != dvec2{0.0}) {
        slide(scene.objects[1], dvec3{0.0}, speed);
    }
    return scene;
}

/// Every vertex has a colour and a normal of its own.
Mesh sliverMesh(uint32_t material) {
    constexpr int kCells = 224;  // 2 · 224² = 100,352 triangles
    constexpr double kSize = 100 * kPixel / kCells;
    MeshBuilder out(material);
    for (int j = 0; j <= kCells; ++j) {
        for (int i = 0; i <= kCells; ++i) {
            const auto random = [&](uint32_t k) { return hashRange(i, j, 106 + k, -1, 1); };
            const dvec3 at{(i - kCells / 2) * kSize, (j - kCells / 2) * kSize, 0.1 * random(0)};
            out.vertex(at, {random(1), random(2), 1.0}, {random(3), random(4)});
        }
    }
    out.gridTriangles(0, kCells, kCells);
    return out.take();
}

Scene slivers(const char* name, double degrees) {
    Scene scene = makeStage(name);
    addWall(scene, -2, kWallHalf, 107);
    const Mottle mottle{.a = {250, 60, 30}, .b = {20, 90, 220}, .cells = 16, .seed = 108};
    const int32_t colours = addTexture(scene, withoutMips(paintMottle(mottle, 64)));
    const uint32_t material = addMaterial(scene, {.diffuse = {1, 1, 1}, .colour_texture = colours});
    SceneObject& square = addObject(scene, "slivers", sliverMesh(material));
    if (degrees != 0) {
        square.tracks.rotation_axis = {0, 0, 1};
        square.tracks.rotation_deg.keys = {{0, 0}, {kFrames, degrees * kFrames}};
    }
    return scene;
}

}  // namespace

Scene makeDisocclusion() {
    Scene scene = makeStage("atlas-disocclusion");
    addWall(scene, -1, kWallHalf, 100);
    const int32_t checks = addTexture(scene, paintChecker({.cells = 4, .seed = 109}, 64));
    MeshBuilder box(addMaterial(scene, {.diffuse = {0.9f, 0.3f, 0.2f}, .colour_texture = checks}));
    box.box({-1.2, -1.4, -0.3}, {1.2, 1.6, 0.0}, 1.6);
    slide(addObject(scene, "fast box", box.take()), {0, 1.2, 0}, {12, 0});
    MeshBuilder post(addMaterial(scene, {.diffuse = {0.15f, 0.35f, 0.8f}}));
    post.box({-0.15, -4, -0.3}, {0.15, 1, 0.0}, 1.0);
    slide(addObject(scene, "post", post.take()), {0, -1, 0}, {-8, 0});
    return scene;
}

Scene makeWiresStill() {
    return wires("atlas-wires-still", false);
}
Scene makeWiresSway() {
    return wires("atlas-wires-sway", true);
}
Scene makeWiresPan() {
    Scene scene = wires("atlas-wires-pan", false);
    truck(scene, dvec2{1.7, 0});
    return scene;
}

Scene makeFenceStill() {
    return fence("atlas-fence-still");
}
Scene makeFencePan() {
    Scene scene = fence("atlas-fence-pan");
    truck(scene, dvec2{2.3, 0});
    return scene;
}

Scene makeLeavesStill() {
    return leaves("atlas-leaves-still", 0);
}
Scene makeLeavesTurn() {
    return leaves("atlas-leaves-turn", 2);
}

Scene makeHdrStill() {
    return hdr("atlas-hdr-still", {0, 0});
}
Scene makeHdrMove() {
    return hdr("atlas-hdr-move", {1.3, 0.4});
}

Scene makeSliversStill() {
    return slivers("atlas-slivers-still", 0);
}
Scene makeSliversTurn() {
    return slivers("atlas-slivers-turn", 0.5);
}

}  // namespace still::scenes::atlas
