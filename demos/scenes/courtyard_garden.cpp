// What stands in the court and around it: fountain, fence, power lines, plants, lantern.

#include <glm/geometric.hpp>

#include "demos/scenes/courtyard.h"
#include "demos/scenes/noise.h"
#include "demos/scenes/scene_builder.h"
#include "demos/scenes/solids.h"
#include "engine/det_math.h"
#include "engine/shapes.h"

namespace still::scenes::courtyard {
namespace {

/// An upright bar with closed ends.
void addPost(MeshBuilder& out, const dvec3& foot, double radius, double height, int segments) {
    out.append(shapes::cylinder(segments),
               placed(foot + dvec3{0, height / 2, 0}, {radius, height / 2, radius}));
}

/// Steps and the large basin.
std::vector<ProfilePoint> basinProfile() {
    return {{2.45, 0.0, true},   {2.45, 0.14, false}, {2.43, 0.16, true},  {2.10, 0.16, true},
            {2.10, 0.30, false}, {2.08, 0.32, true},  {1.62, 0.32, true},  {1.60, 0.40, false},
            {1.56, 0.50, false}, {1.57, 0.66, false}, {1.64, 0.78, false}, {1.72, 0.84, false},
            {1.74, 0.90, false}, {1.72, 0.96, false}, {1.66, 0.98, true},  {1.56, 0.98, false},
            {1.52, 0.96, true},  {1.48, 0.50, true},  {0.3, 0.50, true}};
}

/// Foot, baluster and the upper bowl.
std::vector<ProfilePoint> stemProfile() {
    return {{0.42, 0.50, true},  {0.42, 0.66, true},  {0.36, 0.70, false}, {0.26, 0.78, false},
            {0.20, 0.92, false}, {0.19, 1.05, false}, {0.23, 1.20, false}, {0.28, 1.34, false},
            {0.27, 1.46, false}, {0.19, 1.58, false}, {0.15, 1.68, false}, {0.16, 1.74, true},
            {0.22, 1.76, false}, {0.24, 1.79, false}, {0.22, 1.82, true},  {0.34, 1.85, false},
            {0.62, 1.92, false}, {0.86, 2.01, false}, {0.98, 2.09, false}, {1.00, 2.13, false},
            {0.97, 2.16, false}, {0.92, 2.15, true},  {0.80, 2.07, false}, {0.45, 1.99, true},
            {0.16, 1.98, true},  {0.15, 2.28, false}, {0.20, 2.36, false}, {0.21, 2.40, true},
            {0.02, 2.42, true}};
}

Mesh waterMesh(const Palette& palette) {
    MeshBuilder out(palette.water);
    const auto disc = [&](double y, double inner, double outer, int segments) {
        const ProfilePoint profile[] = {{outer, y, true}, {inner, y, true}};
        const uint32_t first = out.vertexCount();
        addLathe(out, kFountain, profile, {.segments = segments});
        return first;
    };
    disc(0.86, 0.15, 1.50, 64);
    disc(2.10, 0.10, 0.86, 48);
    Mesh mesh = out.take();
    for (uint32_t i = 0; i < mesh.vertexCount(); ++i) {
        mesh.attributes[i].u = mesh.x[i] * 0.8f;
        mesh.attributes[i].v = -mesh.z[i] * 0.8f;
        mesh.tangents.push_back({1, 0, 0, 1});
    }
    return mesh;
}

/// Thin streams from the upper bowl's rim into the basin.
Mesh jetsMesh(const Palette& palette) {
    constexpr int kJets = 12, kSteps = 12;
    MeshBuilder out(palette.spray);
    for (int jet = 0; jet < kJets; ++jet) {
        const double turns = (jet + 0.5) / kJets;
        const dvec3 direction{det::cosTurns(turns), 0, -det::sinTurns(turns)};
        std::vector<dvec3> path;
        for (int i = 0; i <= kSteps; ++i) {
            const double t = double(i) / kSteps;
            path.push_back(kFountain + direction * (0.95 + 0.34 * t) +
                           dvec3{0, 2.15 + 0.16 * t - 1.46 * t * t, 0});
        }
        addTube(out, path, 0.011, 5);
    }
    return out.take();
}

Mesh statueMesh(const Palette& palette) {
    const dvec3 centre = kFountain + dvec3{0, 2.92, 0};
    MeshBuilder out(palette.bronze);
    out.append(shapes::sphere(56, 28), placed(centre, dvec3{0.34}));
    const Mesh ring = shapes::torus(0.035f, 80, 10);
    dmat4 upright{{0.54, 0, 0, 0}, {0, 0, 0.54, 0}, {0, -0.54, 0, 0}, glm::dvec4(centre, 1)};
    dmat4 tilted{
        {0.432, 0.324, 0, 0}, {-0.324, 0.432, 0, 0}, {0, 0, 0.54, 0}, glm::dvec4(centre, 1)};
    out.append(ring, upright);
    out.append(ring, tilted);
    return out.take();
}

Mesh potMesh(const Palette& palette) {
    MeshBuilder out(palette.pot);
    const ProfilePoint profile[] = {{0.20, 0.0, true},  {0.27, 0.36, false}, {0.285, 0.42, true},
                                    {0.32, 0.43, true}, {0.33, 0.52, false}, {0.31, 0.55, true},
                                    {0.28, 0.55, true}, {0.27, 0.46, true},  {0.02, 0.47, true}};
    addLathe(out, dvec3{0.0}, profile, {.segments = 28, .u_repeat = 2});
    out.useMaterial(palette.shrub);
    addFoliage(out, {.centre = {0, 0.95, 0},
                     .radii = {0.42, 0.44, 0.42},
                     .cards = 150,
                     .card_size = 0.24,
                     .seed = 5});
    return out.take();
}

Mesh treeMesh(const Palette& palette, const dvec3& radii, double trunk, int cards, double size,
              uint32_t seed) {
    MeshBuilder out(palette.pole_wood);
    const dvec3 path[] = {{0, -0.1, 0}, {0.06, trunk * 0.5, 0.03}, {0, trunk + radii.y, 0}};
    addTube(out, path, 0.13, 10);
    out.useMaterial(palette.tree);
    addFoliage(out, {.centre = {0, trunk + radii.y, 0},
                     .radii = radii,
                     .cards = cards,
                     .card_size = size,
                     .seed = seed});
    return out.take();
}

Mesh bushMesh(const Palette& palette) {
    MeshBuilder out(palette.shrub);
    addFoliage(out, {.centre = {0, 0.45, 0},
                     .radii = {0.9, 0.6, 0.9},
                     .cards = 130,
                     .card_size = 0.38,
                     .seed = 53});
    return out.take();
}

/// Height of the cross-arm's wires on their insulators.
constexpr double kWireHeight = 8.62;
constexpr double kWireOffsets[] = {-0.85, -0.3, 0.85};

Mesh polesMesh(const Palette& palette) {
    MeshBuilder out(palette.pole_wood);
    for (const dvec3& foot : polePlaces()) {
        const dvec3 path[] = {foot, foot + dvec3{0, 9.0, 0}};
        addTube(out, path, 0.13, 12);
        out.box(foot + dvec3{-1.05, 8.35, -0.06}, foot + dvec3{1.05, 8.47, 0.06}, 1.0);
    }
    out.useMaterial(palette.basin);
    for (const dvec3& foot : polePlaces()) {
        for (const double offset : kWireOffsets) {
            addPost(out, foot + dvec3{offset, 8.47, 0}, 0.035, 0.15, 8);
        }
    }
    return out.take();
}

}  // namespace

std::vector<dvec3> potPlaces() {
    return {{-6.9, 0, -7.9}, {-1.6, 0, -8.0}, {4.8, 0, -8.0}, {8.0, 0, -7.7},
            {-7.0, 0, -5.8}, {-7.0, 0, 0.6},  {-7.0, 0, 7.0}};
}

std::vector<dvec3> polePlaces() {
    return {{13.5, 0, -54}, {13.5, 0, -36}, {13.5, 0, -18}, {13.5, 0, 0}, {13.5, 0, 18}};
}

void addFountain(Scene& scene, const Palette& palette) {
    MeshBuilder basin(palette.basin);
    addLathe(basin, kFountain, basinProfile(), {.segments = 96, .u_repeat = 8});
    addLathe(basin, kFountain, stemProfile(), {.segments = 64, .u_repeat = 2});
    addObject(scene, "fountain", basin.take());
    addObject(scene, "water", waterMesh(palette));
    addObject(scene, "water jets", jetsMesh(palette));
    addObject(scene, "statue", statueMesh(palette));
}

void addFence(Scene& scene, const Palette& palette) {
    const double from = 13.9, length = 22.3, foot = 0.22;
    MeshBuilder link(palette.mesh_wire);
    // One tile of the texture is 4 meshes of 9 cm across.
    link.rectangle({kFenceX, foot, from}, {0, 0, -length}, {0, kFenceHeight - foot - 0.03, 0},
                   0.36);
    addObject(scene, "fence wire", link.take());
    MeshBuilder posts(palette.metal);
    for (int i = 0; i <= 8; ++i) {
        addPost(posts, {kFenceX + 0.045, 0, -8.4 + 2.74 * i}, 0.035, kFenceHeight + 0.08, 12);
    }
    const dvec3 rail[] = {{kFenceX + 0.045, kFenceHeight, from},
                          {kFenceX + 0.045, kFenceHeight, from - length}};
    addTube(posts, rail, 0.024, 10);
    addObject(scene, "fence posts", posts.take());
    MeshBuilder curb(palette.stone);
    curb.box({kFenceX - 0.12, -0.1, from - length}, {kFenceX + 0.22, 0.22, from}, 1.2);
    addObject(scene, "fence curb", curb.takeWithTangents());
}

void addPowerLines(Scene& scene, const Palette& palette) {
    addObject(scene, "poles", polesMesh(palette));
    MeshBuilder wires(palette.cable);
    const std::vector<dvec3> poles = polePlaces();
    for (size_t i = 0; i + 1 < poles.size(); ++i) {
        for (const double offset : kWireOffsets) {
            const dvec3 lift{offset, kWireHeight, 0};
            addCable(wires, poles[i] + lift, poles[i + 1] + lift, 0.55, 0.009, 24, 4);
        }
        const dvec3 low{0.13, 6.9, 0};
        addCable(wires, poles[i] + low, poles[i + 1] + low, 0.7, 0.014, 24, 5);
    }
    addObject(scene, "power lines", wires.take());
    // Service lines over the court to the ridges of both wings.
    MeshBuilder drops(palette.cable);
    const dvec3 pole = poles[3];
    addCable(drops, pole + dvec3{-0.85, 8.62, 0}, {-11.7, 8.3, -5.0}, 0.9, 0.008, 48, 4);
    addCable(drops, pole + dvec3{-0.30, 8.62, 0}, {-11.7, 8.0, -5.4}, 0.95, 0.008, 48, 4);
    addCable(drops, poles[2] + dvec3{-0.85, 8.62, 0}, {2.0, 7.9, -12.8}, 0.35, 0.008, 24, 4);
    addObject(scene, "service lines", drops.take());
}

void addPlants(Scene& scene, const Palette& palette) {
    const uint32_t pot = addMesh(scene, "potted shrub", potMesh(palette));
    int number = 0;
    for (const dvec3& place : potPlaces()) {
        addObject(scene, "potted shrub " + std::to_string(number++), pot).base[3] =
            glm::dvec4(place, 1.0);
    }
    const uint32_t cypress =
        addMesh(scene, "cypress", treeMesh(palette, {0.95, 4.4, 0.95}, 0.8, 760, 0.52, 51));
    const uint32_t oak =
        addMesh(scene, "tree", treeMesh(palette, {2.5, 2.0, 2.5}, 2.0, 700, 0.72, 52));
    const auto plant = [&](const std::string& name, uint32_t mesh, const dvec3& at, double size) {
        addObject(scene, name, mesh).base = placed(at, dvec3{size});
    };
    plant("cypress 0", cypress, {-6.2, 0, -17.5}, 1.15);
    plant("cypress 1", cypress, {-3.9, 0, -18.5}, 1.3);
    plant("cypress 2", cypress, {11.3, 0, -15.0}, 0.85);
    plant("cypress 3", cypress, {-16.0, 0, -8.0}, 1.2);
    plant("tree 0", oak, {19.0, 0, -11.0}, 1.1);
    plant("tree 1", oak, {17.0, 0, -30.0}, 1.3);
    plant("tree 2", oak, {26.0, 0, 1.0}, 1.2);
    const uint32_t bush = addMesh(scene, "bush", bushMesh(palette));
    for (int i = 0; i < 9; ++i) {
        const double z = -19 + 3.6 * i + hashRange(i, 0, 95, -0.9, 0.9);
        plant("bush " + std::to_string(i), bush, {10.6 + hashRange(i, 1, 95, 0, 0.9), 0, z},
              hashRange(i, 2, 95, 0.7, 1.25));
    }
}

void addLantern(Scene& scene, const Palette& palette) {
    const dvec3 bulb{0.0, 3.35, -10.9};
    MeshBuilder frame(palette.lantern_frame);
    const dvec3 chain[] = {bulb + dvec3{0, 0.26, 0}, {bulb.x, kEaves, bulb.z}};
    addTube(frame, chain, 0.012, 6);
    for (int i = 0; i < 4; ++i) {
        const double x = i % 2 == 0 ? -0.14 : 0.14, z = i / 2 == 0 ? -0.14 : 0.14;
        frame.box(bulb + dvec3{x - 0.012, -0.2, z - 0.012}, bulb + dvec3{x + 0.012, 0.2, z + 0.012},
                  1);
    }
    frame.box(bulb + dvec3{-0.17, 0.2, -0.17}, bulb + dvec3{0.17, 0.24, 0.17}, 1);
    frame.box(bulb + dvec3{-0.17, -0.24, -0.17}, bulb + dvec3{0.17, -0.2, 0.17}, 1);
    addObject(scene, "lantern", frame.take());
    MeshBuilder glow(palette.lantern_bulb);
    glow.append(shapes::sphere(24, 12), placed(bulb, dvec3{0.10}));
    addObject(scene, "lantern bulb", glow.take());
    scene.lights.points.push_back(
        {{float(bulb.x), float(bulb.y), float(bulb.z)}, {3.4f, 2.1f, 0.9f}});
}

}  // namespace still::scenes::courtyard
