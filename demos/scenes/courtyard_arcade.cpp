// Columns, arches, walls and roofs.

#include <glm/geometric.hpp>

#include "demos/scenes/courtyard.h"
#include "demos/scenes/noise.h"
#include "demos/scenes/scene_builder.h"
#include "demos/scenes/solids.h"
#include "engine/det_math.h"

namespace still::scenes::courtyard {
namespace {

constexpr double kBrickTile = 1.2;  ///< metres per texture tile
constexpr double kStoneTile = 1.2;
constexpr int kArchSteps = 24;
constexpr double kRingWidth = 0.26;  ///< of the stones around an arch
constexpr double kRingProud = 0.06;  ///< how far they stand out

/// Rounded moulding: part of a circle in the profile plane, angles in turns from outside upwards.
void appendArc(std::vector<ProfilePoint>& profile, const dvec2& centre, double radius, double from,
               double to, int steps) {
    for (int i = 0; i <= steps; ++i) {
        const double turns = from + (to - from) * i / steps;
        profile.push_back({centre.x + radius * det::cosTurns(turns),
                           centre.y + radius * det::sinTurns(turns), i == 0 || i == steps});
    }
}

std::vector<ProfilePoint> columnBaseProfile() {
    std::vector<ProfilePoint> profile;
    appendArc(profile, {0.30, 0.175}, 0.055, -0.25, 0.25, 7);
    profile.push_back({0.305, 0.245, true});
    appendArc(profile, {0.325, 0.275}, 0.03, -0.5 + 0.2, -0.5 - 0.2, 4);
    appendArc(profile, {0.285, 0.325}, 0.028, -0.25, 0.25, 5);
    profile.push_back({0.275, 0.353, true});
    profile.push_back({0.262, 0.375, true});
    return profile;
}

/// From the top of the shaft (y = 0) up to the abacus.
std::vector<ProfilePoint> capitalProfile() {
    std::vector<ProfilePoint> profile;
    profile.push_back({0.215, -0.01, true});
    appendArc(profile, {0.222, 0.025}, 0.022, -0.25, 0.25, 5);
    profile.push_back({0.222, 0.055, true});
    profile.push_back({0.228, 0.15, true});
    profile.push_back({0.243, 0.155, true});
    profile.push_back({0.243, 0.175, true});
    appendArc(profile, {0.235, 0.265}, 0.09, -0.2, 0.0, 6);
    profile.push_back({0.325, 0.285, true});
    profile.push_back({0.20, 0.286, true});
    return profile;
}

Mesh columnMesh(uint32_t material) {
    MeshBuilder out(material);
    out.box({-0.37, 0, -0.37}, {0.37, 0.12, 0.37}, 2.0);
    addLathe(out, dvec3{0.0}, columnBaseProfile(), {.segments = 32, .metres_per_v = 2});
    const double foot = 0.375, top = kImpost - 0.40;
    addFlutedShaft(out, {0, foot, 0}, {.height = top - foot});
    addLathe(out, {0, top, 0}, capitalProfile(), {.segments = 32, .metres_per_v = 2});
    out.box({-0.345, top + 0.285, -0.345}, {0.345, kImpost - 0.03, 0.345}, 2.0);
    out.box({-0.37, kImpost - 0.03, -0.37}, {0.37, kImpost + 0.001, 0.37}, 2.0);
    return out.take();
}

/// Point of an arch at step i of kArchSteps, from its right foot over the crown to the left.
dvec3 archPoint(double centre_x, double radius, int i, double z) {
    const double turns = 0.5 * i / kArchSteps;
    return {centre_x + radius * det::cosTurns(turns), kImpost + radius * det::sinTurns(turns), z};
}

dvec2 brickUv(const dvec3& p) {
    return dvec2{p.x, p.y} / kBrickTile;
}

/// One side of the wall above the arch; `z` < 0 is the side away from the court.
void addSpandrel(MeshBuilder& out, double centre_x, double z) {
    const dvec3 normal{0, 0, z};
    const double reach = kArchRadius + kRingWidth * 0.5, side = kBay / 2;
    const auto column = [&](const dvec3& low) {
        const dvec3 high{low.x, kEaves, z};
        const uint32_t first = out.vertex(low, normal, brickUv(low));
        out.vertex(high, normal, brickUv(high));
        return first;
    };
    std::vector<uint32_t> columns{column({centre_x + side, kImpost, z}),
                                  column({centre_x + reach, kImpost, z})};
    for (int i = 1; i <= kArchSteps; ++i) {
        columns.push_back(column(archPoint(centre_x, reach, i, z)));
    }
    columns.push_back(column({centre_x - side, kImpost, z}));
    for (size_t i = 0; i + 1 < columns.size(); ++i) {
        const uint32_t right = columns[i], left = columns[i + 1];
        const uint32_t a = z > 0 ? left : right, b = z > 0 ? right : left;
        out.triangle(a, b, b + 1);
        out.triangle(a, b + 1, a + 1);
    }
}

/// Strip between two arcs of an arch; the surface's outside is to the right of going from the first
/// arc to the second when walking over the arch from its right foot to its left.
struct Arc {
    double radius, z;
};
void addArchStrip(MeshBuilder& out, double centre_x, const Arc& from, const Arc& to, double v0,
                  double v1) {
    const uint32_t first = out.vertexCount();
    const dvec2 across{to.radius - from.radius, to.z - from.z};
    for (int k = 0; k < 2; ++k) {
        const Arc& arc = k == 0 ? from : to;
        for (int i = 0; i <= kArchSteps; ++i) {
            const double turns = 0.5 * i / kArchSteps;
            const dvec3 radial{det::cosTurns(turns), det::sinTurns(turns), 0};
            const dvec3 normal = radial * across.y + dvec3{0, 0, -across.x};
            const double along = 3.9 * i / kArchSteps / kStoneTile;
            out.vertex(archPoint(centre_x, arc.radius, i, arc.z), normal,
                       {along, k == 0 ? v0 : v1});
        }
    }
    out.gridTriangles(first, kArchSteps, 1);
}

/// The ring of stones: front, edge, soffit through the wall, edge and front of the inner side.
void addArchStones(MeshBuilder& out, double centre_x) {
    const double inner = kArchRadius, outer = inner + kRingWidth;
    const double wall = kWallHalf, proud = kWallHalf + kRingProud;
    const double ring = kRingWidth / kStoneTile;
    addArchStrip(out, centre_x, {outer, wall}, {outer, proud}, 0.0, 0.05);
    addArchStrip(out, centre_x, {outer, proud}, {inner, proud}, 0.0, ring);
    addArchStrip(out, centre_x, {inner, proud}, {inner, -proud}, ring, ring + 0.6);
    addArchStrip(out, centre_x, {inner, -proud}, {outer, -proud}, 0.0, ring);
    addArchStrip(out, centre_x, {outer, -proud}, {outer, -wall}, 0.0, 0.05);
    const double crown = kImpost + inner;
    out.box({centre_x - 0.12, crown - 0.05, -proud - 0.03},
            {centre_x + 0.12, crown + kRingWidth + 0.1, proud + 0.03}, kStoneTile);
}

Mesh facadeMesh(const Wing& wing, const Palette& palette) {
    MeshBuilder out(palette.brick);
    for (int bay = 0; bay < wing.bays; ++bay) {
        addSpandrel(out, (bay + 0.5) * kBay, kWallHalf);
    }
    for (int bay = 0; bay < wing.bays; ++bay) {
        addSpandrel(out, (bay + 0.5) * kBay, -kWallHalf);
    }
    // The shadow of the eaves.
    const double drop = 0.5 * wing.sun.y / wing.sun.z, low = kEaves + 0.38 - drop;
    const dvec3 foot{-kWallHalf, low, kWallHalf + 0.004};
    out.useMaterial(palette.brick_shaded);
    out.rectangle(foot, {wing.bays * kBay + 2 * kWallHalf, 0, 0}, {0, kEaves - low, 0}, kBrickTile,
                  brickUv(foot));
    return out.takeWithTangents();
}

Mesh archMesh(const Wing& wing, const Palette& palette) {
    MeshBuilder out(palette.stone);
    for (int bay = 0; bay < wing.bays; ++bay) {
        addArchStones(out, (bay + 0.5) * kBay);
    }
    return out.takeWithTangents();
}

/// Ledges along the top of the facade with a row of teeth between them.
Mesh corniceMesh(const Wing& wing, const Palette& palette) {
    MeshBuilder out(palette.stone);
    const double from = -kWallHalf, to = wing.bays * kBay + kWallHalf;
    const double face = kWallHalf;
    out.box({from, kEaves - 0.28, 0}, {to, kEaves - 0.20, face + 0.05}, kStoneTile);
    out.box({from, kEaves, -face}, {to, kEaves + 0.10, face + 0.08}, kStoneTile);
    out.box({from, kEaves + 0.10, -face}, {to, kEaves + 0.22, face + 0.10}, kStoneTile);
    out.box({from, kEaves + 0.22, -face}, {to, kEaves + 0.34, face + 0.32}, kStoneTile);
    out.box({from, kEaves + 0.34, -face}, {to, kEaves + 0.40, face + 0.38}, kStoneTile);
    for (double x = from + 0.08; x + 0.12 < to; x += 0.24) {
        out.box({x, kEaves + 0.11, face + 0.09}, {x + 0.12, kEaves + 0.22, face + 0.26},
                kStoneTile);
    }
    return out.takeWithTangents();
}

/// Triangle of wall under an end of the lean-to roof; `outward` is −1 or 1 along x.
void addGable(MeshBuilder& out, double x, double outward) {
    std::vector<dvec3> corners{
        {x, kEaves, kWallHalf}, {x, kEaves, -kDepth}, {x, kWallTop - 0.1, -kDepth}};
    if (outward < 0) {
        std::swap(corners[1], corners[2]);
    }
    std::vector<dvec2> uvs;
    for (const dvec3& p : corners) {
        uvs.push_back(dvec2{-outward * p.z, p.y} / kBrickTile);
    }
    out.polygon(corners, uvs);
}

Mesh backWallMesh(const Wing& wing, const Palette& palette) {
    MeshBuilder out(palette.brick_shaded);
    const double from = wing.floor_from, to = wing.floor_to, length = to - from;
    out.rectangle({from, 0, -kDepth}, {length, 0, 0}, {0, kEaves, 0}, kBrickTile);
    out.useMaterial(palette.brick);
    out.box({from - 0.4, -kFloorRise, -kDepth - 0.4}, {to + 0.4, kWallTop, -kDepth - 0.002},
            kBrickTile);
    if (wing.end_wall_left) {
        out.box({from - 0.4, -kFloorRise, -kDepth}, {from, kEaves, kWallHalf}, kBrickTile);
        addGable(out, from - 0.4, -1);
    }
    if (wing.end_wall_right) {
        out.box({to, -kFloorRise, -kDepth}, {to + 0.4, kEaves, kWallHalf}, kBrickTile);
        addGable(out, to + 0.4, 1);
    }
    out.useMaterial(palette.stone_shaded);
    const dvec3 dado{from, 0, -kDepth + kDadoProud}, up{0, kDadoHeight, 0};
    out.rectangle(dado, {length, 0, 0}, up, kStoneTile);
    out.rectangle(dado + up, {length, 0, 0}, {0, 0, -kDadoProud}, kStoneTile);
    out.useMaterial(palette.stone);
    out.box({from - 0.5, kWallTop, -kDepth - 0.5}, {to + 0.5, kWallTop + 0.12, -kDepth + 0.12},
            kStoneTile);
    return out.takeWithTangents();
}

/// Ceiling with beams, and doors with stone frames in the back wall.
Mesh interiorMesh(const Wing& wing, const Palette& palette) {
    MeshBuilder out(palette.ceiling);
    const double from = wing.floor_from, to = wing.floor_to, height = kEaves - 0.1;
    out.rectangle({from, height, -kDepth}, {to - from, 0, 0}, {0, 0, kDepth}, 2.5);
    out.useMaterial(palette.beam);
    for (int i = 0; i <= 2 * wing.bays; ++i) {
        const double x = i * kBay / 2;
        out.box({x - 0.11, height - 0.24, -kDepth}, {x + 0.11, height + 0.01, -kWallHalf}, 1.0);
    }
    for (int bay = 0; bay < wing.bays; bay += 2) {
        const double x = (bay + 0.5) * kBay, z = -kDepth;
        out.useMaterial(palette.stone_shaded);
        out.box({x - 0.80, 0, z}, {x - 0.60, 2.5, z + 0.14}, kStoneTile);
        out.box({x + 0.60, 0, z}, {x + 0.80, 2.5, z + 0.14}, kStoneTile);
        out.box({x - 0.90, 2.5, z}, {x + 0.90, 2.75, z + 0.18}, kStoneTile);
        out.useMaterial(palette.door);
        out.box({x - 0.60, 0, z}, {x + 0.60, 2.5, z + 0.08}, 1.2);
    }
    return out.takeWithTangents();
}

/// One half-round tile of `width`, lying along `down` with its foot at `foot`.
void addRoofTile(MeshBuilder& out, const dvec3& foot, const dvec3& down, double length,
                 uint32_t key) {
    constexpr int kSides = 5;
    const dvec3 across{1, 0, 0}, normal = glm::cross(down, across);
    const dvec2 shift{hashUnit(int(key), 0, 61), hashUnit(int(key), 1, 61)};
    const uint32_t first = out.vertexCount();
    for (int end = 0; end < 2; ++end) {
        const dvec3 centre = foot - down * (length * end) + normal * (end == 0 ? 0.035 : 0.0);
        const double radius = end == 0 ? 0.115 : 0.095;
        for (int i = 0; i <= kSides; ++i) {
            const double turns = 0.5 - 0.5 * i / kSides;
            const dvec3 outward = across * det::cosTurns(turns) + normal * det::sinTurns(turns);
            out.vertex(centre + outward * radius, outward,
                       shift + dvec2{0.2 * i / kSides, 0.35 * end});
        }
    }
    out.gridTriangles(first, kSides, 1);
}

Mesh roofMesh(const Wing& wing, const Palette& palette) {
    const dvec3 foot{0, kEaves + 0.38, kWallHalf + 0.52}, ridge{0, kWallTop - 0.05, -kDepth};
    const double slope_length = glm::length(ridge - foot), width = wing.roof_to - wing.roof_from;
    const dvec3 down = unit(foot - ridge);
    MeshBuilder out(palette.clay_under);
    const dvec3 corner = dvec3{wing.roof_from, 0, 0} + foot;
    out.rectangle(corner, {width, 0, 0}, ridge - foot, 1.0);
    out.rectangle(corner + ridge - foot, {width, 0, 0}, foot - ridge, 1.0);
    out.useMaterial(palette.clay);
    const int rows = 9, columns = int(width / 0.29);
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            const double x = wing.roof_from + (column + 0.5) * width / columns;
            const dvec3 at = dvec3{x, 0, 0} + foot - down * (row * slope_length / rows - 0.03);
            addRoofTile(out, at, down, slope_length / rows + 0.06, uint32_t(row * 512 + column));
        }
    }
    return out.take();
}

/// Turns a local mesh into a world-space one.
Mesh inWorld(Mesh mesh, const dmat4& to_world) {
    const glm::dmat3 turn(to_world);
    for (uint32_t i = 0; i < mesh.vertexCount(); ++i) {
        const dvec3 p = dvec3(to_world * glm::dvec4(mesh.x[i], mesh.y[i], mesh.z[i], 1.0));
        VertexAttributes& a = mesh.attributes[i];
        const dvec3 n = turn * dvec3{a.nx, a.ny, a.nz};
        mesh.x[i] = float(p.x);
        mesh.y[i] = float(p.y);
        mesh.z[i] = float(p.z);
        a = {float(n.x), float(n.y), float(n.z), a.u, a.v};
        if (!mesh.tangents.empty()) {
            VertexTangent& t = mesh.tangents[i];
            const dvec3 along = turn * dvec3{t.x, t.y, t.z};
            t = {float(along.x), float(along.y), float(along.z), t.handedness};
        }
    }
    return mesh;
}

}  // namespace

std::array<Wing, 2> wings() {
    dmat4 north{1.0};
    north[3] = {-8, kFloorRise, -9, 1};
    // A quarter turn: local x runs north (−z), local z runs east (+x).
    const dmat4 west{{0, 0, -1, 0}, {0, 1, 0, 0}, {1, 0, 0, 0}, {-8, kFloorRise, 10.2, 1}};
    return {{{.name = "north",
              .bays = 5,
              .to_world = north,
              .sun = kSun,
              .floor_from = -kDepth,
              .floor_to = 16.4,
              .roof_from = -kDepth,
              .roof_to = 16.9,
              .end_wall_right = true},
             {.name = "west",
              .bays = 6,
              .to_world = west,
              .sun = {-kSun.z, kSun.y, kSun.x},
              .floor_from = -0.4,
              .floor_to = 19.2 + kDepth,
              .roof_from = -0.9,
              .roof_to = 19.2 + kDepth,
              .end_wall_left = true}}};
}

void addColumns(Scene& scene, const Palette& palette) {
    const uint32_t mesh = addMesh(scene, "column", columnMesh(palette.marble));
    for (const Wing& wing : wings()) {
        // The wings share the corner column; the west wing leaves it to the north wing.
        const int count = wing.bays + (wing.end_wall_left ? 0 : 1);
        for (int i = 0; i < count; ++i) {
            SceneObject& column =
                addObject(scene, wing.name + std::string(" column ") + std::to_string(i), mesh);
            column.base[3] = wing.to_world * glm::dvec4(i * kBay, 0, 0, 1);
        }
    }
}

void addWings(Scene& scene, const Palette& palette) {
    for (const Wing& wing : wings()) {
        const std::string name = wing.name;
        const auto add = [&](const char* part, Mesh mesh) {
            addObject(scene, name + part, inWorld(std::move(mesh), wing.to_world));
        };
        add(" facade", facadeMesh(wing, palette));
        add(" arches", archMesh(wing, palette));
        add(" cornice", corniceMesh(wing, palette));
        add(" back wall", backWallMesh(wing, palette));
        add(" interior", interiorMesh(wing, palette));
    }
}

void addRoofs(Scene& scene, const Palette& palette) {
    for (const Wing& wing : wings()) {
        addObject(scene, std::string(wing.name) + " roof",
                  inWorld(roofMesh(wing, palette), wing.to_world));
    }
}

}  // namespace still::scenes::courtyard
