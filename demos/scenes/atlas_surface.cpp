// Failures of surfaces whose picture changes while they stand still: no motion vector tells of it.

#include <algorithm>
#include <cmath>

#include "demos/scenes/atlas_scenes.h"
#include "demos/scenes/atlas_stage.h"
#include "demos/scenes/noise.h"
#include "demos/scenes/paint.h"
#include "engine/det_math.h"
#include "engine/texture.h"

namespace still::scenes::atlas {
namespace {

uint8_t toByte(double value) {
    return uint8_t(std::clamp(value, 0.0, 255.0) + 0.5);
}

/// pixel(u, v) → sRGB colour, at texel centres; v = 0 at the bottom.
template <class Pixel>
Texture painted(int width, int height, Wrap wrap, Pixel&& pixel) {
    Image<Rgba8> image(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const dvec3 c = pixel((x + 0.5) / width, 1 - (y + 0.5) / height);
            image.at(x, y) = {toByte(c.x), toByte(c.y), toByte(c.z), 255};
        }
    }
    return makeColourTexture(image.view(), wrap);
}

uint32_t addTextured(Scene& scene, int32_t texture, const std::array<float, 3>& tint = {1, 1, 1}) {
    return addMaterial(scene, {.diffuse = tint, .colour_texture = texture});
}

/// The material's texture moves by `speed` pixels at z = 0 per frame on a surface where one repeat
/// is `units` wide; no offset at frame 32.
MaterialTracks scrolling(uint32_t material, const dvec2& speed, double units) {
    const dvec2 way = speed * (kPixel / units * kFrames / 2);
    // What shows at u + offset moves against the offset.
    return {.material = material, .offset = {{{0, way}, {kFrames, -way}}}, .swaps = {}};
}

/// Screen content at time t in [0, 1), a loop: a disc on its way around, bars that slide.
dvec3 programme(double u, double v, double t) {
    const double x = 1.78 * (u - 0.5), y = v - 0.5;
    const double dx = x - 0.45 * det::cosTurns(t), dy = y - 0.25 * det::sinTurns(t);
    if (dx * dx + dy * dy < 0.03) {
        return {250, 240, 120};
    }
    const double bars = 8 * u + 2 * t + 2 * y;
    const double shade = bars - std::floor(bars) < 0.5 ? 1.0 : 0.55;
    return dvec3{40 + 160 * v, 90, 200 - 140 * u} * shade;
}

constexpr int kPages = 16;

/// Materials of a loop of pages; `cells` > 0 shows it in that many flat cells across.
std::vector<uint32_t> addPages(Scene& scene, int cells) {
    std::vector<uint32_t> pages;
    for (int i = 0; i < kPages; ++i) {
        const auto pixel = [&](double u, double v) {
            const double n = cells, m = cells * 9 / 16;
            const double cu = cells == 0 ? u : (std::floor(u * n) + 0.5) / n;
            const double cv = cells == 0 ? v : (std::floor(v * m) + 0.5) / m;
            return programme(cu, cv, double(i) / kPages);
        };
        pages.push_back(
            addTextured(scene, addTexture(scene, painted(256, 144, Wrap::clamp, pixel))));
    }
    return pages;
}

/// Leafs through the pages, one every `frames` frames.
MaterialTracks flipBook(const std::vector<uint32_t>& pages, int frames) {
    MaterialTracks tracks{.material = pages[0], .offset = {}, .swaps = {}};
    for (int i = 1; i * frames <= kFrames; ++i) {
        tracks.swaps.push_back({i * frames, pages[size_t(i) % pages.size()]});
    }
    return tracks;
}

/// A picture in a frame: `right` and `up` span it, the whole texture fits once.
void addScreen(Scene& scene, const std::string& name, uint32_t material, const dvec3& corner,
               const dvec3& right, const dvec3& up) {
    MeshBuilder out(material);
    const dvec3 corners[] = {corner, corner + right, corner + right + up, corner + up};
    const dvec2 uvs[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    out.polygon(corners, uvs);
    addObject(scene, name, out.take());
    MeshBuilder rim(addMaterial(scene, {.diffuse = {0.05f, 0.05f, 0.06f}}));
    const dvec3 back{0, 0, -0.05};
    const dvec3 low = corner - (right + up) * 0.02 + back;
    rim.rectangle(low, right * 1.04, up * 1.04, 1);
    addObject(scene, name + " frame", rim.take());
}

/// Light that falls through leaves: 1 in the sun, less in soft-edged round shadows. Repeats.
Texture dapples(uint32_t seed) {
    constexpr int kBlobs = 14;
    return painted(256, 256, Wrap::repeat, [&](double u, double v) {
        double light = 1;
        for (int i = 0; i < kBlobs; ++i) {
            const double du = u - hashUnit(i, 0, seed), dv = v - hashUnit(i, 1, seed);
            const double x = du - std::floor(du + 0.5), y = dv - std::floor(dv + 0.5);
            const double radius = hashRange(i, 2, seed, 0.03, 0.11);
            light *= 0.25 + 0.75 * smoothStep(radius - 0.012, radius, std::sqrt(x * x + y * y));
        }
        return dvec3{255.0} * std::max(light, 0.2);
    });
}

}  // namespace

Scene makeMaterialSwap() {
    constexpr int kSwap = 24;
    Scene scene = makeStage("atlas-material-swap");
    addWall(scene, -3, {14, 8}, 150);
    addBoxes(scene, 9, 10, 151);
    const uint32_t wall = scene.meshes[0].parts[0].material;
    const uint32_t boxes = scene.meshes[1].parts[0].material;
    const int32_t boards = addTexture(scene, paintBoards(6, {150, 160, 140}, 152, 128));
    const uint32_t other_wall = addTextured(scene, boards);
    const uint32_t other_boxes =
        addMaterial(scene, {.diffuse = {0.1f, 0.5f, 0.2f}, .specular = {1, 1, 1}, .shininess = 40});
    scene.material_tracks = {{.material = wall, .offset = {}, .swaps = {{kSwap, other_wall}}},
                             {.material = boxes, .offset = {}, .swaps = {{kSwap, other_boxes}}}};
    return scene;
}

Scene makeTextureScroll() {
    constexpr double kRepeat = 3.2;
    Scene scene = makeStage("atlas-texture-scroll");
    addWall(scene, -1, {14, 8}, 153);
    const int32_t slabs = addTexture(scene, paintChecker({.cells = 4, .seed = 154}, 128));
    const int32_t cloth =
        addTexture(scene, paintLeafColours({230, 200, 90}, {30, 60, 120}, 155, 128));
    const uint32_t right = addTextured(scene, slabs), up = addTextured(scene, cloth);
    MeshBuilder belts(right);
    belts.rectangle({-6.5, 0.4, 0}, {13, 0, 0}, {0, 3.2, 0}, kRepeat);
    belts.useMaterial(up);
    belts.rectangle({-6.5, -3.6, 0}, {13, 0, 0}, {0, 3.2, 0}, kRepeat);
    addObject(scene, "belts", belts.take());
    scene.material_tracks = {scrolling(right, {1.5, 0}, kRepeat),
                             scrolling(up, {0.4, 0.7}, kRepeat)};
    return scene;
}

Scene makeScreen() {
    Scene scene = makeStage("atlas-screen");
    addWall(scene, -2, {14, 8}, 156);
    const std::vector<uint32_t> pages = addPages(scene, 0);
    addScreen(scene, "screen", pages[0], {-5, -3, 1}, {9.6, 0.3, -2.5}, {-0.3, 5.6, 0});
    scene.material_tracks = {flipBook(pages, 2)};
    return scene;
}

Scene makeMovingShadow() {
    constexpr double kRepeat = 16;
    Scene scene = makeStage("atlas-moving-shadow");
    const int32_t light = addTexture(scene, dapples(157));
    const std::array<float, 3> tints[] = {
        {0.95f, 0.85f, 0.65f}, {0.45f, 0.35f, 0.28f}, {0.7f, 0.45f, 0.3f}};
    MeshBuilder slabs;
    for (int k = 0; k < 3; ++k) {
        const uint32_t material = addTextured(scene, light, tints[k]);
        slabs.useMaterial(material);
        for (int j = 0; j < 14; ++j) {
            for (int i = 0; i < 30; ++i) {
                if (int(hashBits(i, j, 158) % 3) == k) {  // one shadow lies across all slabs
                    const dvec3 at{-15.0 + i, -7.0 + j, 3.5 - 0.5 * j};
                    slabs.rectangle(at, {1, 0, 0}, {0, 1, -0.5}, kRepeat,
                                    dvec2{at.x, at.y * 1.118033988749895} / kRepeat);
                }
            }
        }
        scene.material_tracks.push_back(scrolling(material, {1.2, 0.3}, kRepeat));
    }
    addObject(scene, "ground", slabs.take());
    return scene;
}

Scene makeNoise() {
    Scene scene = makeStage("atlas-noise");
    addWall(scene, -2, {14, 8}, 159);
    constexpr int kSize = 128;
    const auto snow = [](double u, double v) {
        const double random = hashUnit(int(u * kSize), int(v * kSize), 160);
        return dvec3{30 + 210 * random};
    };
    const uint32_t material = addTextured(
        scene, addTexture(scene, withoutMips(painted(kSize, kSize, Wrap::repeat, snow))));
    MeshBuilder out(material);
    out.rectangle({-5, -3, 0}, {10, 0, 0}, {0, 6, 0}, kSize * 1.5 * kPixel);  // a texel: 1.5 pixels
    addObject(scene, "snow", out.take());
    MaterialTracks tracks{.material = material, .offset = {}, .swaps = {}};
    setTrack<dvec2>(tracks.offset, [](int frame) {
        return dvec2{hashUnit(frame, 0, 161), hashUnit(frame, 1, 161)};
    });
    scene.material_tracks = {tracks};
    return scene;
}

Scene makeLowResolution() {
    Scene scene = makeStage("atlas-low-resolution");
    addWall(scene, -2, {14, 8}, 162);
    const std::vector<uint32_t> pages = addPages(scene, 32);
    addScreen(scene, "coarse screen", pages[0], {-5.2, -3, 0}, {10.4, 0.5, 0}, {-0.3, 5.8, 0});
    scene.material_tracks = {flipBook(pages, 4)};
    truck(scene, dvec2{0.6, 0});
    return scene;
}

}  // namespace still::scenes::atlas
