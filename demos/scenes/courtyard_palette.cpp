#include <algorithm>
#include <glm/geometric.hpp>

#include "demos/scenes/courtyard.h"
#include "demos/scenes/paint.h"
#include "demos/scenes/scene_builder.h"

namespace still::scenes::courtyard {
namespace {

constexpr int kSmall = 256, kMedium = 512, kLarge = 1024;

std::array<float, 3> toFloats(const dvec3& v) {
    return {float(v.x), float(v.y), float(v.z)};
}

/// What is left of the light on a surface with this normal when the sun does not reach it, as a
/// factor per channel; `open` is how much of the sky it still sees.
dvec3 shade(const dvec3& normal, double open) {
    const double facing = std::max(0.0, -glm::dot(unit(kSun), normal));
    return kAmbient * open / (kAmbient + kSunColour * facing);
}

/// Adds materials one by one, with their textures.
struct Painter {
    Scene& scene;

    uint32_t plain(const dvec3& diffuse, const dvec3& specular = dvec3{0.0}, float shininess = 10) {
        return addMaterial(
            scene,
            {.diffuse = toFloats(diffuse), .specular = toFloats(specular), .shininess = shininess});
    }
    uint32_t textured(int32_t colour, const dvec3& tint = dvec3{1.0}, int32_t normal = kNoTexture) {
        return addMaterial(
            scene, {.diffuse = toFloats(tint), .colour_texture = colour, .normal_texture = normal});
    }
    uint32_t polished(int32_t colour, const dvec3& specular, float shininess) {
        return addMaterial(scene, {.diffuse = {1, 1, 1},
                                   .specular = toFloats(specular),
                                   .shininess = shininess,
                                   .colour_texture = colour});
    }
    uint32_t cutOut(int32_t alpha, int32_t colour, const dvec3& tint) {
        return addMaterial(scene, {.diffuse = toFloats(tint),
                                   .alpha_mode = AlphaMode::test,
                                   .colour_texture = colour,
                                   .alpha_texture = alpha});
    }
    int32_t mottle(const dvec3& a, const dvec3& b, int cells, uint32_t seed) {
        return addTexture(scene,
                          paintMottle({.a = a, .b = b, .cells = cells, .seed = seed}, kSmall));
    }
};

const Bond kBrick{.block = {164, 92, 66}, .mortar = {190, 178, 158}, .relief = 1.0, .seed = 21};
const Bond kAshlar{.columns = 2,
                   .rows = 4,
                   .joint = 0.035,
                   .aspect = 2,
                   .block = {208, 192, 162},
                   .mortar = {150, 138, 118},
                   .variation = 0.09,
                   .relief = 0.6,
                   .seed = 33};

void addFloors(Painter& add, Palette& p) {
    const dvec3 up{0, 1, 0};
    const int32_t checker = addTexture(add.scene, paintChecker({.seed = 3}, kLarge));
    p.court_floor = add.polished(checker, {0.10, 0.10, 0.10}, 60);
    p.court_floor_shaded = add.textured(checker, shade(up, 0.95));
    const int32_t limestone = add.mottle({212, 194, 162}, {202, 183, 150}, 4, 9);
    p.path = add.textured(limestone);
    p.path_border = add.plain({0.13, 0.105, 0.095});
    p.path_shaded = add.textured(limestone, shade(up, 0.95));
    const int32_t slabs = addTexture(add.scene, paintBond({.columns = 3,
                                                           .rows = 4,
                                                           .joint = 0.03,
                                                           .aspect = 1.33,
                                                           .block = {206, 184, 150},
                                                           .mortar = {138, 122, 102},
                                                           .variation = 0.12,
                                                           .seed = 8},
                                                          kMedium));
    p.walk_lit = add.textured(slabs);
    p.walk_shaded = add.textured(slabs, shade(up, 0.75));
}

void addMasonry(Painter& add, Palette& p) {
    const dvec3 out{0, 0, 1};
    const int32_t brick = addTexture(add.scene, paintBond(kBrick, kMedium));
    const int32_t brick_relief = addTexture(add.scene, paintBondRelief(kBrick, kMedium));
    p.brick = add.textured(brick, dvec3{1.0}, brick_relief);
    p.brick_shaded = add.textured(brick, shade(out, 0.85), brick_relief);
    const int32_t ashlar = addTexture(add.scene, paintBond(kAshlar, kMedium));
    const int32_t ashlar_relief = addTexture(add.scene, paintBondRelief(kAshlar, kMedium));
    p.stone = add.textured(ashlar, dvec3{1.0}, ashlar_relief);
    p.stone_shaded = add.textured(ashlar, shade(out, 0.8), ashlar_relief);
    p.marble =
        add.polished(add.mottle({226, 215, 194}, {206, 192, 168}, 4, 5), {0.08, 0.08, 0.07}, 30);
    p.ceiling = add.textured(add.mottle({216, 196, 160}, {186, 164, 130}, 3, 6), dvec3{0.62});
    p.clay = add.textured(add.mottle({196, 108, 70}, {158, 78, 50}, 5, 7));
    p.clay_under = add.plain({0.16, 0.07, 0.045});
}

void addMetalAndWood(Painter& add, Palette& p) {
    const int32_t boards = addTexture(add.scene, paintBoards(6, {112, 72, 44}, 11, kSmall));
    p.door = add.textured(boards, dvec3{0.55});
    p.beam = add.textured(boards, dvec3{0.5, 0.42, 0.36});
    p.pole_wood = add.textured(addTexture(add.scene, paintBoards(9, {128, 106, 84}, 12, kSmall)));
    p.metal = add.plain({0.34, 0.36, 0.38}, {0.35, 0.35, 0.35}, 40);
    p.cable = add.plain({0.025, 0.026, 0.03});
    const int32_t link = addTexture(add.scene, paintChainLink(4, 0.115, kSmall));
    p.mesh_wire = add.cutOut(link, kNoTexture, {0.40, 0.42, 0.43});
    p.bronze = add.plain({0.36, 0.21, 0.07}, {0.95, 0.70, 0.32}, 90);
    p.lantern_frame = add.plain({0.03, 0.028, 0.025}, {0.2, 0.2, 0.2}, 30);
    p.lantern_bulb = addMaterial(add.scene, {.diffuse = {0, 0, 0}, .emission = {4.0f, 2.7f, 1.2f}});
}

void addFountainAndToys(Painter& add, Palette& p) {
    p.basin =
        add.polished(add.mottle({214, 206, 194}, {188, 178, 164}, 5, 15), {0.12, 0.12, 0.12}, 50);
    p.water = addMaterial(add.scene,
                          {.diffuse = {0.05f, 0.17f, 0.19f},
                           .specular = {0.9f, 0.85f, 0.75f},
                           .shininess = 160,
                           .normal_texture = addTexture(add.scene, paintRipples(0.5, 16, kSmall))});
    p.spray = add.plain({0.62, 0.70, 0.74}, {0.5, 0.5, 0.5}, 60);
    p.knot = add.plain({0.50, 0.035, 0.03}, {0.75, 0.70, 0.66}, 120);
    const int32_t stripes =
        addTexture(add.scene, paintStripes(8, {236, 232, 220}, {36, 96, 168}, kSmall));
    p.ball = add.polished(stripes, {0.30, 0.30, 0.30}, 60);
    p.pot = add.textured(add.mottle({186, 104, 70}, {150, 80, 54}, 4, 18));
}

void addNature(Painter& add, Palette& p) {
    const int32_t shapes = addTexture(add.scene, paintLeafShapes(41, kSmall));
    const int32_t bright =
        addTexture(add.scene, paintLeafColours({136, 166, 70}, {72, 112, 44}, 41, kSmall));
    const int32_t dark =
        addTexture(add.scene, paintLeafColours({92, 120, 62}, {48, 78, 42}, 41, kSmall));
    p.shrub = add.cutOut(shapes, bright, dvec3{1.0});
    p.tree = add.cutOut(shapes, dark, dvec3{1.0});
    p.grass = add.textured(add.mottle({128, 140, 74}, {164, 158, 98}, 6, 19));
    p.hill_near = add.textured(add.mottle({112, 132, 92}, {86, 110, 80}, 8, 20));
    p.hill_far = add.plain({0.30, 0.41, 0.50});
    // The dome's normals are at right angles to the sun, so the texture shows as it is painted.
    p.sky = add.textured(addTexture(add.scene, paintSky(77, 1536, 384)), dvec3{1.0} / kAmbient);
}

}  // namespace

Palette addPalette(Scene& scene) {
    Painter add{scene};
    Palette palette{};
    addFloors(add, palette);
    addMasonry(add, palette);
    addMetalAndWood(add, palette);
    addFountainAndToys(add, palette);
    addNature(add, palette);
    return palette;
}

}  // namespace still::scenes::courtyard
