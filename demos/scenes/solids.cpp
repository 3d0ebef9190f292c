#include "demos/scenes/solids.h"

#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>

#include "demos/scenes/noise.h"
#include "engine/det_math.h"

namespace still::scenes {
namespace {

/// Direction i of n around the vertical, counter-clockwise from +x seen from above.
dvec3 around(double turns) {
    return {det::cosTurns(turns), 0, -det::sinTurns(turns)};
}

/// Outward normal (radius, y) of the profile's segment from a to b.
dvec2 segmentNormal(const ProfilePoint& a, const ProfilePoint& b) {
    const double dr = b.radius - a.radius, dy = b.y - a.y;
    const double length = std::sqrt(dr * dr + dy * dy);
    assert(length > 0);
    return {dy / length, -dr / length};
}

/// One ring of the lathe.
void addRing(MeshBuilder& out, const dvec3& centre, const ProfilePoint& point, const dvec2& normal,
             double v, const LatheOptions& options) {
    for (int i = 0; i <= options.segments; ++i) {
        const dvec3 direction = around(double(i % options.segments) / options.segments);
        const dvec3 position = centre + direction * point.radius + dvec3{0, point.y, 0};
        out.vertex(position, direction * normal.x + dvec3{0, normal.y, 0},
                   {options.u_repeat * i / options.segments, v});
    }
}

/// How deep the flutes are at a height, as a share of their full depth.
double fluteDepth(double y, double height) {
    const double ease = 0.12;
    return smoothStep(0.05, 0.05 + ease, y) * smoothStep(0.05, 0.05 + ease, height - y);
}

/// Radius of the shaft without flutes: a straight taper that swells a little in the lower half.
double shaftRadius(const FlutedShaft& shaft, double t) {
    return shaft.bottom + (shaft.top - shaft.bottom) * t + 0.03 * shaft.bottom * 4 * t * (1 - t);
}

/// Vertices on one level of one flute: a fillet (2 vertices) or the hollow between two fillets.
struct FluteArc {
    double from = 0, to = 0;  ///< turns
    bool hollow = false;
};
void addFluteLevel(MeshBuilder& out, const dvec3& base, const FlutedShaft& shaft,
                   const FluteArc& arc, int level) {
    const double t = double(level) / shaft.levels, y = t * shaft.height;
    const double radius = shaftRadius(shaft, t);
    const double width = radius * 6.283185307179586 * (arc.to - arc.from);
    const double depth = arc.hollow ? 0.36 * width * fluteDepth(y, shaft.height) : 0.0;
    const int segments = arc.hollow ? shaft.flute_segments : 1;
    for (int i = 0; i <= segments; ++i) {
        const double s = double(i) / segments;
        const double turns = arc.from + (arc.to - arc.from) * s;
        const dvec3 outward = around(turns), sideways = around(turns + 0.25);
        const double dip = depth * 4 * s * (1 - s), slope = depth * 4 * (1 - 2 * s) / width;
        out.vertex(base + outward * (radius - dip) + dvec3{0, y, 0}, outward + sideways * slope,
                   {turns * 1.6, y});
    }
}

/// Two directions at right angles to `along`.
struct Frame {
    dvec3 side, up;
};
Frame frameAcross(const dvec3& along) {
    const dvec3 helper = std::abs(along.y) < 0.9 ? dvec3{0, 1, 0} : dvec3{1, 0, 0};
    const dvec3 side = unit(glm::cross(along, helper));
    return {side, glm::cross(side, along)};
}

/// Ring of a tube; `sides` + 1 vertices, ordered so that the next ring lies above this one.
void addTubeRing(MeshBuilder& out, const dvec3& centre, const Frame& frame, double radius,
                 int sides, double v) {
    for (int i = 0; i <= sides; ++i) {
        const double turns = double(i % sides) / sides;
        const dvec3 outward = frame.side * det::cosTurns(turns) + frame.up * -det::sinTurns(turns);
        out.vertex(centre + outward * radius, outward, {double(i) / sides, v});
    }
}

}  // namespace

void addLathe(MeshBuilder& out, const dvec3& centre, std::span<const ProfilePoint> profile,
              const LatheOptions& options) {
    double along = 0;
    for (size_t k = 0; k + 1 < profile.size(); ++k) {
        const ProfilePoint &a = profile[k], &b = profile[k + 1];
        const dvec2 here = segmentNormal(a, b);
        const dvec2 before = k == 0 || a.sharp ? here : here + segmentNormal(profile[k - 1], a);
        const dvec2 after =
            k + 2 == profile.size() || b.sharp ? here : here + segmentNormal(b, profile[k + 2]);
        const double dr = b.radius - a.radius, dy = b.y - a.y;
        const double next = along + std::sqrt(dr * dr + dy * dy) / options.metres_per_v;
        // Each band has its own two rings; doubled vertices cost less than the book-keeping.
        const size_t first = out.vertexCount();
        addRing(out, centre, a, before, along, options);
        addRing(out, centre, b, after, next, options);
        out.gridTriangles(uint32_t(first), options.segments, 1);
        along = next;
    }
}

void addFlutedShaft(MeshBuilder& out, const dvec3& base, const FlutedShaft& shaft) {
    const double fillet = 0.2;  // share of the circumference that stays round
    for (int f = 0; f < 2 * shaft.flutes; ++f) {
        const bool hollow = f % 2 == 1;
        const double start = double(f / 2) / shaft.flutes;
        const double edge = start + fillet / shaft.flutes;
        const double end = double(f / 2 + 1) / shaft.flutes;
        const FluteArc arc{hollow ? edge : start, hollow ? end : edge, hollow};
        const uint32_t first = out.vertexCount();
        for (int level = 0; level <= shaft.levels; ++level) {
            addFluteLevel(out, base, shaft, arc, level);
        }
        out.gridTriangles(first, hollow ? shaft.flute_segments : 1, shaft.levels);
    }
}

void addTube(MeshBuilder& out, std::span<const dvec3> path, double radius, int sides) {
    assert(path.size() >= 2);
    const uint32_t first = out.vertexCount();
    const size_t last = path.size() - 1;
    double along = 0;
    for (size_t i = 0; i <= last; ++i) {
        const dvec3 direction = unit(path[i < last ? i + 1 : last] - path[i > 0 ? i - 1 : 0]);
        along += i > 0 ? glm::length(path[i] - path[i - 1]) : 0.0;
        addTubeRing(out, path[i], frameAcross(direction), radius, sides, along);
    }
    out.gridTriangles(first, sides, int(last));
}

void addCable(MeshBuilder& out, const dvec3& from, const dvec3& to, double sag, double radius,
              int segments, int sides) {
    std::vector<dvec3> path;
    for (int i = 0; i <= segments; ++i) {
        const double t = double(i) / segments;
        path.push_back(from + (to - from) * t - dvec3{0, sag * 4 * t * (1 - t), 0});
    }
    addTube(out, path, radius, sides);
}

void addTorusKnot(MeshBuilder& out, const TorusKnot& knot) {
    const uint32_t first = out.vertexCount();
    for (int i = 0; i <= knot.segments; ++i) {
        const double t = double(i % knot.segments) / knot.segments;
        const dvec3 outward = around(knot.p * t), sideways = around(knot.p * t + 0.25);
        const double c = det::cosTurns(knot.q * t), s = det::sinTurns(knot.q * t);
        const double ring = 1 + knot.winding * c;
        // The torus normal is at right angles to the curve, so frames close without a twist.
        const dvec3 normal = outward * c + dvec3{0, s, 0};
        const dvec3 along = unit(sideways * (knot.p * ring) +
                                 (outward * -s + dvec3{0, c, 0}) * (knot.q * knot.winding));
        const dvec3 centre = outward * ring + dvec3{0, knot.winding * s, 0};
        addTubeRing(out, centre, {normal, glm::cross(normal, along)}, knot.tube, knot.sides,
                    12.0 * i / knot.segments);
    }
    out.gridTriangles(first, knot.sides, knot.segments);
}

void addFoliage(MeshBuilder& out, const Foliage& foliage) {
    for (int i = 0; i < foliage.cards; ++i) {
        const auto random = [&](int k) { return hashRange(i, k, foliage.seed, -1, 1); };
        const double height = random(0), turns = random(1);
        const double flat = std::sqrt(1 - height * height);
        const dvec3 direction = around(turns) * flat + dvec3{0, height, 0};
        const double depth = 1 - 0.45 * hashUnit(i, 2, foliage.seed);
        const dvec3 centre = foliage.centre + direction * foliage.radii * depth;
        const dvec3 facing = unit(direction + dvec3{random(3), random(4), random(5)} * 0.9);
        const Frame frame = frameAcross(facing);
        const double size = foliage.card_size * hashRange(i, 6, foliage.seed, 0.7, 1.3);
        const double spin = hashUnit(i, 7, foliage.seed);
        const dvec3 right =
            (frame.side * det::cosTurns(spin) + frame.up * det::sinTurns(spin)) * size;
        const dvec3 up = glm::cross(facing, right);
        const uint32_t cell = hashBits(i, 8, foliage.seed);
        const dvec2 uv{(cell & 1) * 0.5, (cell >> 1 & 1) * 0.5};
        const dvec3 normal = unit(direction / foliage.radii) + dvec3{0, 0.2, 0} + facing * 0.3;
        const uint32_t first = out.vertexCount();
        for (int corner = 0; corner < 4; ++corner) {
            const double s = corner % 2, t = corner / 2;
            out.vertex(centre + right * (s - 0.5) + up * (t - 0.5), normal,
                       uv + dvec2{s * 0.5, t * 0.5});
        }
        out.gridTriangles(first, 1, 1);
    }
}

}  // namespace still::scenes
