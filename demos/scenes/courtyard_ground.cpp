// Floors with the sun's patches and shadows on them, and the land outside.

#include <cmath>
#include <glm/geometric.hpp>

#include "demos/scenes/courtyard.h"
#include "demos/scenes/noise.h"
#include "demos/scenes/scene_builder.h"
#include "engine/det_math.h"

namespace still::scenes::courtyard {
namespace {

using Polygon = std::vector<dvec3>;

constexpr double kCheckerTile = 6.0, kSlabTile = 2.4;
constexpr double kMasonryTile = 1.2;
constexpr double kLift = 0.004;  ///< of patches over the floor they lie on

/// The part of a convex polygon where dot(normal, p) ≥ offset (Sutherland & Hodgman 1974).
Polygon clipped(const Polygon& polygon, const dvec3& normal, double offset) {
    Polygon out;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double da = glm::dot(normal, a) - offset, db = glm::dot(normal, b) - offset;
        if (da >= 0) {
            out.push_back(a);
        }
        if ((da >= 0) != (db >= 0)) {
            out.push_back(a + (b - a) * (da / (da - db)));
        }
    }
    return out;
}

/// The common part of two convex polygons in a plane z = const, both counter-clockwise seen from
/// +z.
Polygon intersection(Polygon polygon, const Polygon& mask) {
    for (size_t i = 0; i < mask.size(); ++i) {
        const dvec3 edge = mask[(i + 1) % mask.size()] - mask[i];
        const dvec3 inward{-edge.y, edge.x, 0};
        polygon = clipped(polygon, inward, glm::dot(inward, mask[i]));
    }
    return polygon;
}

/// Upwards-facing polygon at its own height.
void addFloorPolygon(MeshBuilder& out, Polygon polygon, double tile) {
    double area = 0;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        area += a.z * b.x - a.x * b.z;
    }
    if (area < 0) {
        polygon.assign(polygon.rbegin(), polygon.rend());
    }
    std::vector<dvec2> uvs;
    for (const dvec3& p : polygon) {
        uvs.push_back(dvec2{p.x, -p.z} / tile);
    }
    out.polygon(polygon, uvs);
}

Polygon floorRectangle(double x0, double x1, double z0, double z1, double y) {
    return {{x0, y, z1}, {x1, y, z1}, {x1, y, z0}, {x0, y, z0}};
}

/// The half round of an arch in the plane z, as seen from the court.
Polygon archOpening(double centre_x, double z) {
    constexpr int kSteps = 16;
    Polygon opening;
    for (int i = 0; i <= kSteps; ++i) {
        const double turns = 0.5 * i / kSteps;
        opening.push_back({centre_x + kArchRadius * det::cosTurns(turns),
                           kImpost + kArchRadius * det::sinTurns(turns), z});
    }
    return opening;
}

/// Where the sun passes bay `bay`: between the columns, and through the thickness of the arch
/// above. Polygons in the plane z = 0 of the wing.
std::vector<Polygon> sunGates(const Wing& wing, int bay) {
    const double centre = (bay + 0.5) * kBay;
    // Columns of radius 0.25 shade more than their width because the sun comes in at an angle.
    const double slant = wing.sun.x / wing.sun.z;
    const double half = kBay / 2 - 0.25 * std::sqrt(1 + slant * slant);
    const Polygon between{{centre - half, 0, 0},
                          {centre + half, 0, 0},
                          {centre + half, kImpost, 0},
                          {centre - half, kImpost, 0}};
    const auto pushed = [&](double z) {  // an opening at z, moved along the sun to z = 0
        Polygon opening = archOpening(centre, z);
        for (dvec3& p : opening) {
            p += wing.sun * (-p.z / wing.sun.z);
        }
        return opening;
    };
    return {between, intersection(pushed(kWallHalf), pushed(-kWallHalf))};
}

dvec3 toWorld(const Wing& wing, const dvec3& p) {
    return dvec3(wing.to_world * glm::dvec4(p, 1.0));
}

/// Sun on the floor behind one gate.
void addFloorPatch(MeshBuilder& out, const Wing& wing, const Polygon& gate) {
    Polygon patch;
    for (const dvec3& p : gate) {
        patch.push_back(p + wing.sun * (p.y / -wing.sun.y));
    }
    patch = clipped(patch, {0, 0, 1}, -kDepth + kDadoProud);
    patch = clipped(clipped(patch, {1, 0, 0}, wing.floor_from), {-1, 0, 0}, -wing.floor_to);
    for (dvec3& p : patch) {
        p = toWorld(wing, p + dvec3{0, kLift, 0});
    }
    addFloorPolygon(out, patch, kSlabTile);
}

/// Sun on the back wall behind one gate, on the band y0 … y1 that stands `proud` of the wall.
void addWallPatch(MeshBuilder& out, const Wing& wing, const Polygon& gate, double proud, double y0,
                  double y1) {
    const double z = -kDepth + proud;
    Polygon patch;
    for (const dvec3& p : gate) {
        patch.push_back(p + wing.sun * ((z - p.z) / wing.sun.z));
    }
    patch = clipped(clipped(patch, {0, 1, 0}, y0), {0, -1, 0}, -y1);
    patch = clipped(clipped(patch, {1, 0, 0}, wing.floor_from), {-1, 0, 0}, -wing.floor_to);
    std::vector<dvec2> uvs;
    for (dvec3& p : patch) {
        uvs.push_back(dvec2{p.x - wing.floor_from, p.y} / kMasonryTile);
        p = toWorld(wing, p + dvec3{0, 0, kLift});
    }
    out.polygon(patch, uvs);
}

/// Floor of an arcade with its step, and the sun on it.
void addWalk(Scene& scene, const Palette& palette, const Wing& wing) {
    MeshBuilder out(palette.walk_shaded);
    const auto strip = [&](double x0, double x1, double z0, double z1) {
        Polygon rectangle = floorRectangle(x0, x1, z0, z1, 0);
        for (dvec3& p : rectangle) {
            p = toWorld(wing, p);
        }
        addFloorPolygon(out, rectangle, kSlabTile);
    };
    const double step = 0.55;
    strip(wing.floor_from, wing.floor_to, -kDepth, 0);
    out.useMaterial(palette.walk_lit);
    strip(wing.floor_from, wing.floor_to, 0, step);
    MeshBuilder wall(palette.stone);
    std::vector<Polygon> gates;
    for (int bay = 0; bay < wing.bays; ++bay) {
        for (Polygon& gate : sunGates(wing, bay)) {
            gates.push_back(std::move(gate));
        }
    }
    for (const Polygon& gate : gates) {
        addFloorPatch(out, wing, gate);
        addWallPatch(wall, wing, gate, kDadoProud, 0.0, kDadoHeight);
    }
    const dvec3 left = toWorld(wing, {wing.floor_from, -kFloorRise, step});
    const dvec3 right = toWorld(wing, {wing.floor_to, -kFloorRise, step});
    wall.rectangle(left, right - left, {0, kFloorRise, 0}, kMasonryTile);
    wall.useMaterial(palette.brick);
    for (const Polygon& gate : gates) {
        addWallPatch(wall, wing, gate, 0.0, kDadoHeight, kEaves);
    }
    addObject(scene, std::string(wing.name) + " walk", out.take());
    addObject(scene, std::string(wing.name) + " sunlit wall", wall.takeWithTangents());
}

/// Shadow on the court of an upright cylinder: the hull of its foot's and its top's circles.
Polygon cylinderShadow(const dvec3& foot, double radius, double y0, double y1) {
    constexpr int kSteps = 32;
    const dvec3 per_metre = kSun / -kSun.y;
    const auto shifted = [&](double y) {
        return dvec3{foot.x + per_metre.x * y, kLift, foot.z + per_metre.z * y};
    };
    Polygon hull;
    for (int i = 0; i < kSteps; ++i) {
        const double turns = (i + 0.5) / kSteps;
        const dvec3 direction{det::cosTurns(turns), 0, -det::sinTurns(turns)};
        const bool far_side = glm::dot(direction, dvec3{kSun.x, 0, kSun.z}) > 0;
        hull.push_back(shifted(far_side ? y1 : y0) + direction * radius);
    }
    return hull;
}

/// Keeps a shadow on the court's floor.
Polygon onCourt(Polygon polygon) {
    polygon = clipped(polygon, {1, 0, 0}, -7.45);
    polygon = clipped(polygon, {0, 0, 1}, -8.45);
    return clipped(polygon, {-1, 0, 0}, -(kFenceX - 0.1));
}

/// Adds floor polygons of the court: checkered, or plain where the path crosses.
struct CourtPainter {
    const Palette& palette;
    MeshBuilder checkered, plain;

    explicit CourtPainter(const Palette& p) : palette(p) {}

    void add(const Polygon& polygon) {
        const dvec3 south{0, 0, 1}, north{0, 0, -1};
        addFloorPolygon(checkered, clipped(polygon, north, -kPathFrom), kCheckerTile);
        addFloorPolygon(checkered, clipped(polygon, south, kPathTo), kCheckerTile);
        const double from = kPathFrom + kPathBorder, to = kPathTo - kPathBorder;
        addFloorPolygon(plain, clipped(clipped(polygon, south, from), north, -to), 3.0);
    }
    void shadow(const dvec3& foot, double radius, double y0, double y1) {
        add(onCourt(cylinderShadow(foot, radius, y0, y1)));
    }
};

void addFountainShadows(CourtPainter& court) {
    court.shadow(kFountain, 2.45, 0, 0.16);
    court.shadow(kFountain, 1.72, 0.2, 0.98);
    court.shadow(kFountain, 0.24, 0.9, 2.1);
    court.shadow(kFountain, 1.0, 2.02, 2.16);
    court.shadow(kFountain, 0.17, 2.1, 2.6);
    court.shadow(kFountain, 0.34, 2.75, 3.1);
}

void addFenceShadows(CourtPainter& court) {
    const dvec3 per_metre = kSun / -kSun.y;
    const double x = kFenceX + kFenceHeight * per_metre.x, z = kFenceHeight * per_metre.z;
    court.add(onCourt(floorRectangle(x - 0.03, x + 0.03, -8.4 + z, 13.9 + z, kLift)));
    const double curb = kFenceX - 0.12 + 0.22 * per_metre.x;
    court.add(onCourt(floorRectangle(curb, kFenceX, -8.4, 14, kLift)));
    for (int i = 0; i <= 8; ++i) {
        court.shadow({kFenceX, 0, -8.4 + 2.74 * i}, 0.035, 0, kFenceHeight);
    }
}

void addCourt(Scene& scene, const Palette& palette) {
    CourtPainter court(palette);
    court.checkered.useMaterial(palette.court_floor);
    court.plain.useMaterial(palette.path);
    court.add(floorRectangle(-8, kFenceX, -9, 14, 0));
    court.checkered.useMaterial(palette.court_floor_shaded);
    court.plain.useMaterial(palette.path_border);
    for (const double z : {kPathFrom, kPathTo - kPathBorder}) {
        addFloorPolygon(court.plain, floorRectangle(-8, kFenceX, z, z + kPathBorder, 0), 3.0);
    }
    court.plain.useMaterial(palette.path_shaded);
    addFountainShadows(court);
    addFenceShadows(court);
    for (const dvec3& pot : potPlaces()) {
        court.shadow(pot, 0.30, 0, 0.55);
        court.shadow(pot, 0.38, 0.75, 1.2);
    }
    for (const dvec3& pole : polePlaces()) {
        court.shadow(pole, 0.13, 0, 9.0);
    }
    addObject(scene, "court floor", court.checkered.take());
    addObject(scene, "path", court.plain.take());
}

/// A ridge of hills around everything: heights from noise, lit like level ground so that its
/// shading is even and reads as distance.
Mesh hillsMesh(uint32_t material, double radius, double low, double high, uint32_t seed) {
    constexpr int kSteps = 192;
    MeshBuilder out(material);
    const uint32_t first = out.vertexCount();
    for (int row = 0; row < 2; ++row) {
        for (int i = 0; i <= kSteps; ++i) {
            const double t = double(i % kSteps) / kSteps;
            // Clockwise from above, so that the inside faces the court.
            const dvec3 direction{det::cosTurns(t), 0, det::sinTurns(t)};
            const double height = low + (high - low) * fractalNoise(t, 0.37, 10, 4, seed);
            out.vertex(direction * radius + dvec3{0, row == 0 ? -1.0 : height, 0},
                       dvec3{0, 1, 0} - direction * 0.4, {24.0 * i / kSteps, double(row)});
        }
    }
    out.gridTriangles(first, kSteps, 1);
    return out.take();
}

/// Half a sphere seen from inside, a little below the horizon at its foot.
Mesh skyMesh(uint32_t material) {
    constexpr int kAround = 48, kUp = 12;
    constexpr double kRadius = 600;
    const dvec3 normal = unit(glm::cross(kSun, dvec3{0, 1, 0}));
    MeshBuilder out(material);
    const uint32_t first = out.vertexCount();
    for (int j = 0; j <= kUp; ++j) {
        const double v = double(j) / kUp;
        const double flat = kRadius * det::cosTurns(v / 4), up = kRadius * det::sinTurns(v / 4);
        for (int i = 0; i <= kAround; ++i) {
            const double t = double(i % kAround) / kAround;
            out.vertex({flat * det::cosTurns(t), up - 12, flat * det::sinTurns(t)}, normal,
                       {double(i) / kAround, v * 0.998 + 0.001});
        }
    }
    out.gridTriangles(first, kAround, kUp);
    return out.take();
}

}  // namespace

void addGround(Scene& scene, const Palette& palette) {
    addCourt(scene, palette);
    for (const Wing& wing : wings()) {
        addWalk(scene, palette, wing);
    }
    MeshBuilder land(palette.grass);
    addFloorPolygon(land, floorRectangle(-300, 300, -300, 300, -0.06), 5.0);
    addObject(scene, "land", land.take());
    MeshBuilder south(palette.brick);
    south.box({-8.4, -0.1, 14}, {kFenceX + 0.2, 1.0, 14.3}, 1.2);
    south.useMaterial(palette.stone);
    south.box({-8.45, 1.0, 13.93}, {kFenceX + 0.25, 1.1, 14.37}, 1.2);
    addObject(scene, "south wall", south.takeWithTangents());
}

void addHorizon(Scene& scene, const Palette& palette) {
    addObject(scene, "hills", hillsMesh(palette.hill_near, 150, 1, 13, 71));
    addObject(scene, "mountains", hillsMesh(palette.hill_far, 290, 4, 44, 72));
    addObject(scene, "sky", skyMesh(palette.sky));
}

}  // namespace still::scenes::courtyard
