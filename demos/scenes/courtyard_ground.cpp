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
    const double half = kBay / 2 - 0.37;
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

/// Sun on the floor behind one gate, and what reaches the foot of the back wall.
void addSunPatch(MeshBuilder& floor, MeshBuilder& wall, const Wing& wing, const Polygon& gate) {
    const double wall_z = -kDepth + 0.06;
    Polygon on_floor, on_wall;
    for (const dvec3& p : gate) {
        on_floor.push_back(p + wing.sun * (p.y / -wing.sun.y));
        on_wall.push_back(p + wing.sun * ((wall_z - p.z) / wing.sun.z));
    }
    Polygon patch = clipped(on_floor, {0, 0, 1}, wall_z);
    for (dvec3& p : patch) {
        p = toWorld(wing, p + dvec3{0, kLift, 0});
    }
    addFloorPolygon(floor, patch, kSlabTile);
    Polygon lit = clipped(clipped(on_wall, {0, 1, 0}, 0.0), {0, -1, 0}, -0.9);
    std::vector<dvec2> uvs;
    for (dvec3& p : lit) {
        uvs.push_back(dvec2{p.x - wing.floor_from, p.y} / 1.2);
        p = toWorld(wing, p + dvec3{0, 0, kLift});
    }
    wall.polygon(lit, uvs);
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
    for (int bay = 0; bay < wing.bays; ++bay) {
        for (const Polygon& gate : sunGates(wing, bay)) {
            addSunPatch(out, wall, wing, gate);
        }
    }
    const dvec3 left = toWorld(wing, {wing.floor_from, -kFloorRise, step});
    const dvec3 right = toWorld(wing, {wing.floor_to, -kFloorRise, step});
    wall.rectangle(left, right - left, {0, kFloorRise, 0}, 1.2);
    addObject(scene, std::string(wing.name) + " walk", out.take());
    addObject(scene, std::string(wing.name) + " step", wall.takeWithTangents());
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

void addCourt(Scene& scene, const Palette& palette) {
    MeshBuilder out(palette.court_floor);
    addFloorPolygon(out, floorRectangle(-8, kFenceX, -9, 14, 0), kCheckerTile);
    out.useMaterial(palette.court_floor_shaded);
    const auto shadow = [&](const dvec3& foot, double radius, double y0, double y1) {
        addFloorPolygon(out, onCourt(cylinderShadow(foot, radius, y0, y1)), kCheckerTile);
    };
    shadow(kFountain, 2.45, 0, 0.16);
    shadow(kFountain, 1.72, 0.2, 0.98);
    shadow(kFountain, 0.24, 0.9, 2.1);
    shadow(kFountain, 1.0, 2.02, 2.1);
    shadow(kFountain, 0.5, 2.5, 3.3);
    for (const dvec3& pot : potPlaces()) {
        shadow(pot, 0.30, 0, 0.55);
        shadow(pot, 0.40, 0.75, 1.25);
    }
    for (const dvec3& pole : polePlaces()) {
        shadow(pole, 0.13, 0, 9.0);
    }
    const double reach = kFenceHeight * kSun.x / -kSun.y;
    const double drift = kFenceHeight * kSun.z / -kSun.y;
    const double x = kFenceX + reach;
    addFloorPolygon(out,
                    onCourt(floorRectangle(x - 0.03, x + 0.03, -8.4 + drift, 13.5 + drift, kLift)),
                    kCheckerTile);
    addFloorPolygon(out, onCourt(floorRectangle(kFenceX - 0.36, kFenceX, -8.4, 14, kLift)),
                    kCheckerTile);
    for (int i = 0; i <= 8; ++i) {
        shadow({kFenceX, 0, -8.4 + 2.74 * i}, 0.035, 0, kFenceHeight);
    }
    addObject(scene, "court floor", out.take());
}

/// A ridge of hills around everything: heights from noise, lit like level ground so that its
/// shading is even and reads as distance.
Mesh hillsMesh(uint32_t material, double radius, double low, double high, uint32_t seed) {
    constexpr int kSteps = 128;
    MeshBuilder out(material);
    const uint32_t first = out.vertexCount();
    for (int row = 0; row < 2; ++row) {
        for (int i = 0; i <= kSteps; ++i) {
            const double t = double(i % kSteps) / kSteps;
            // Clockwise from above, so that the inside faces the court.
            const dvec3 direction{det::cosTurns(t), 0, det::sinTurns(t)};
            const double height = low + (high - low) * fractalNoise(t, 0.37, 10, 4, seed);
            out.vertex(direction * radius + dvec3{0, row == 0 ? -1.0 : height, 0},
                       dvec3{0, 1, 0} - direction * 0.4, {t, double(row)});
        }
    }
    out.gridTriangles(first, kSteps, 1);
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
    addObject(scene, "hills", hillsMesh(palette.hill_near, 150, 2, 15, 71));
    addObject(scene, "mountains", hillsMesh(palette.hill_far, 290, 8, 52, 72));
}

}  // namespace still::scenes::courtyard
