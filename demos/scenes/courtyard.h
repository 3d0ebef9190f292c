#pragma once
// The courtyard's plan. Metres, +y up, +x east, +z south (towards the first view's camera).
//
//              north wing: 5 bays              back wall z = −12.6
//        ┌──────────────────────────────┐
//        │   o    o    o    o    o    o │      columns z = −9
//   west │ o ┌──────────────────────────┘ ┊
//   wing │   │                            ┊ fence x = 8.8      poles x = 13.5
//   6    │ o │          fountain          ┊
//   bays │   │                            ┊
//        │ o │                            ┊
//        └───┘  eye                       ┊
//
// The renderer casts no shadows, so the plan has them: surfaces out of the sun have a material
// darkened to the ambient share, and where sun comes in through the arches lies a lit polygon.

#include <array>

#include "demos/scenes/mesh_builder.h"
#include "engine/scene.h"

namespace still::scenes::courtyard {

constexpr double kBay = 3.2;         ///< distance of columns
constexpr double kFloorRise = 0.15;  ///< the arcades' floor above the court
constexpr double kImpost = 3.4;      ///< column height, where arches begin
constexpr double kArchRadius = 1.25;
constexpr double kWallHalf = 0.3;  ///< half thickness of the walls above the arches
constexpr double kEaves = 5.4;     ///< top of these walls
constexpr double kDepth = 3.6;     ///< from the columns to the back wall
constexpr double kWallTop = 7.4;
constexpr double kDadoHeight = 0.9, kDadoProud = 0.06;  ///< stone foot of the back walls
constexpr double kFenceX = 8.8;
constexpr double kFenceHeight = 2.6;
constexpr dvec3 kFountain{0.6, 0, -0.6};
constexpr int kLoopFrames = 240;
/// A band of plain stone crosses the court; the ball rolls on it, because a moving shadow needs a
/// floor without pattern.
constexpr double kPathFrom = 3.0, kPathTo = 4.5, kPathBorder = 0.07;

/// The way sunlight travels, not yet of unit length.
constexpr dvec3 kSun{-0.66, -0.60, -0.45};
constexpr dvec3 kSunColour{1.18, 1.02, 0.78};
constexpr dvec3 kAmbient{0.27, 0.31, 0.39};

/// A row of columns. Local axes: x along the row, z from the columns towards the court, y up from
/// the arcade's floor; column i stands at x = i · kBay.
struct Wing {
    const char* name = "";
    int bays = 0;
    dmat4 to_world{1.0};
    dvec3 sun{0.0};                       ///< kSun in local axes
    double floor_from = 0, floor_to = 0;  ///< x range of floor, ceiling and back wall
    double roof_from = 0, roof_to = 0;
    bool end_wall_left = false, end_wall_right = false;
};
std::array<Wing, 2> wings();

/// Material numbers.
struct Palette {
    uint32_t court_floor, court_floor_shaded, walk_lit, walk_shaded, path, path_shaded, path_border;
    uint32_t marble, stone, stone_shaded, brick, brick_shaded, ceiling, beam, clay, clay_under;
    uint32_t door, mesh_wire, metal, cable, pole_wood;
    uint32_t basin, water, bronze, knot, ball, pot, shrub, tree, grass, hill_near, hill_far;
    uint32_t lantern_frame, lantern_bulb, sky, spray;
};
Palette addPalette(Scene& scene);

void addColumns(Scene& scene, const Palette& palette);
void addWings(Scene& scene, const Palette& palette);
void addRoofs(Scene& scene, const Palette& palette);
void addGround(Scene& scene, const Palette& palette);
void addHorizon(Scene& scene, const Palette& palette);
void addFountain(Scene& scene, const Palette& palette);
void addFence(Scene& scene, const Palette& palette);
void addPowerLines(Scene& scene, const Palette& palette);
void addPlants(Scene& scene, const Palette& palette);
void addLantern(Scene& scene, const Palette& palette);

/// Where potted shrubs stand: on the court's floor, before every other column.
std::vector<dvec3> potPlaces();
/// Where the poles of the power line stand.
std::vector<dvec3> polePlaces();

}  // namespace still::scenes::courtyard
