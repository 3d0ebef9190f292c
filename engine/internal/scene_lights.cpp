#include "engine/internal/scene_lights.h"

#include <glm/geometric.hpp>

#include "engine/internal/json_tracks.h"
#include "engine/internal/tracks.h"

namespace still {
namespace {

constexpr size_t kMaxLights = 1000;  ///< of each kind
constexpr double kSmallestSize = 1e-6;

std::array<float, 3> toFloat(const glm::dvec3& v) {
    return {float(v.x), float(v.y), float(v.z)};
}

Track<double> readIntensity(const JsonCursor& light) {
    const auto intensity = light.find("intensity");
    return intensity ? readNumberTrack(*intensity, 0, kMaxLight) : Track<double>{};
}

std::array<float, 3> colourOr(const JsonCursor& light, const std::array<float, 3>& fallback) {
    const auto colour = light.find("colour");
    return colour ? readColour(*colour) : fallback;
}

void readShadow(const JsonCursor& cursor, SceneLights& lights) {
    cursor.expectKeys({"type", "angle_deg"}, {"notes", "comment"});
    const JsonCursor type = cursor.require("type");
    const std::string name = type.text();
    if (name != "traced" && name != "map") {
        type.expected("\"traced\" or \"map\"");
    }
    lights.sun_shadow = name == "map" ? SunShadow::mapped : SunShadow::traced;
    if (const auto angle = cursor.find("angle_deg")) {
        lights.sun_angle_deg = angle->number(0, 90);
    }
}

void readOcclusion(const JsonCursor& cursor, SceneLights& lights) {
    cursor.expectKeys({"type", "distance"}, {"notes", "comment"});
    const JsonCursor type = cursor.require("type");
    const std::string name = type.text();
    if (name != "traced" && name != "screen") {
        type.expected("\"traced\" or \"screen\"");
    }
    lights.ambient_light =
        name == "screen" ? AmbientLight::screen_occlusion : AmbientLight::traced_occlusion;
    lights.occlusion_distance = cursor.require("distance").number(kSmallestSize, kMaxCoordinate);
}

void readAmbient(const JsonCursor& cursor, SceneLights& lights) {
    cursor.expectKeys({"colour", "intensity", "occlusion", "bounce"}, {"notes", "comment"});
    lights.ambient = colourOr(cursor, {1, 1, 1});
    lights.ambient_intensity = readIntensity(cursor);
    const auto occlusion = cursor.find("occlusion");
    if (occlusion) {
        readOcclusion(*occlusion, lights);
    }
    const auto bounce = cursor.find("bounce");
    if (bounce && bounce->boolean()) {
        if (occlusion) {
            bounce->refuse("expected either \"occlusion\" or \"bounce\", which has its own");
        }
        lights.ambient_light = AmbientLight::bounce;
    }
}

void readSun(const JsonCursor& cursor, SceneLights& lights) {
    cursor.expectKeys({"direction", "colour", "intensity", "shadow"}, {"notes", "comment"});
    lights.sun.direction = toFloat(readDirection(cursor.require("direction")));
    lights.sun.colour = colourOr(cursor, {1, 1, 1});
    lights.sun_intensity = readIntensity(cursor);
    if (const auto shadow = cursor.find("shadow")) {
        readShadow(*shadow, lights);
    }
}

void readPoints(const JsonCursor& cursor, SceneLights& lights) {
    for (const JsonCursor& at : cursor.items(0, kMaxLights)) {
        at.expectKeys({"position", "colour", "intensity"}, {"name", "notes", "comment"});
        PointLight point;
        point.position = toFloat(readPoint(at.require("position")));
        point.colour = colourOr(at, {1, 1, 1});
        lights.points.push_back(point);
        lights.point_intensity.push_back(readIntensity(at));
    }
}

void readSpheres(const JsonCursor& cursor, SceneLights& lights) {
    for (const JsonCursor& at : cursor.items(0, kMaxLights)) {
        at.expectKeys({"position", "radius", "colour", "intensity"}, {"name", "notes", "comment"});
        lights.spheres.push_back(
            {.position = readPointTrack(at.require("position")),
             .radius = at.require("radius").number(kSmallestSize, kMaxCoordinate),
             .colour = colourOr(at, {1, 1, 1}),
             .intensity = readIntensity(at)});
    }
}

SceneRectangle readRectangle(const JsonCursor& cursor) {
    const JsonCursor edge_u = cursor.require("edge_u"), edge_v = cursor.require("edge_v");
    SceneRectangle light{.centre = readPointTrack(cursor.require("centre")),
                         .edge_u = readPoint(edge_u),
                         .edge_v = readPoint(edge_v),
                         .colour = colourOr(cursor, {1, 1, 1}),
                         .intensity = readIntensity(cursor)};
    const double u = lengthOf(light.edge_u), v = lengthOf(light.edge_v);
    for (const auto& [length, edge] : {std::pair{u, &edge_u}, std::pair{v, &edge_v}}) {
        if (!(length >= kSmallestSize)) {
            edge->refuse("expected an edge with a length");
        }
    }
    const double product = glm::dot(light.edge_u, light.edge_v);
    if (!(product <= 1e-6 * (u * v) && product >= -1e-6 * (u * v))) {
        edge_v.refuse("expected an edge perpendicular to edge_u");
    }
    return light;
}

void readRectangles(const JsonCursor& cursor, SceneLights& lights) {
    for (const JsonCursor& at : cursor.items(0, kMaxLights)) {
        at.expectKeys({"centre", "edge_u", "edge_v", "colour", "intensity"},
                      {"name", "notes", "comment"});
        lights.rectangles.push_back(readRectangle(at));
    }
}

}  // namespace

SceneLights defaultLights() {
    SceneLights lights;
    lights.ambient = {0.25f, 0.25f, 0.25f};
    lights.sun.direction = toFloat(unit({-0.4, -1, -0.6}));
    lights.sun.colour = {0.75f, 0.75f, 0.75f};
    return lights;
}

SceneLights readLights(const JsonCursor& cursor) {
    cursor.expectKeys({"ambient", "directional", "points", "spheres", "rectangles"},
                      {"notes", "comment"});
    SceneLights lights;
    lights.ambient = {0, 0, 0};
    if (const auto ambient = cursor.find("ambient")) {
        readAmbient(*ambient, lights);
    }
    if (const auto sun = cursor.find("directional")) {
        readSun(*sun, lights);
    }
    if (const auto points = cursor.find("points")) {
        readPoints(*points, lights);
    }
    if (const auto spheres = cursor.find("spheres")) {
        readSpheres(*spheres, lights);
    }
    if (const auto rectangles = cursor.find("rectangles")) {
        readRectangles(*rectangles, lights);
    }
    return lights;
}

SceneLights readSingleLight(const JsonCursor& cursor) {
    cursor.expectKeys({"type", "direction", "colour", "intensity"}, {"notes", "comment"});
    if (const auto type = cursor.find("type"); type && type->text() != "directional") {
        type->expected("\"directional\"");
    }
    SceneLights lights = defaultLights();
    lights.sun.direction = toFloat(readDirection(cursor.require("direction")));
    lights.sun.colour = colourOr(cursor, lights.sun.colour);
    lights.sun_intensity = readIntensity(cursor);
    return lights;
}

}  // namespace still
