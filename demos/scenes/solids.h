#pragma once
// Turned, swept and scattered shapes that engine/shapes.h has no need of.

#include <span>

#include "demos/scenes/mesh_builder.h"

namespace still::scenes {

/// A point of a turned profile. Where `sharp`, the surface has an edge.
struct ProfilePoint {
    double radius = 0, y = 0;
    bool sharp = false;
};

struct LatheOptions {
    int segments = 48;        ///< around
    double u_repeat = 1;      ///< how often the texture fits around
    double metres_per_v = 1;  ///< along the profile
};
/// Turns the profile around the vertical through `centre`. Seen in the half plane to the right of
/// the axis, the outside is to the right of the profile's direction.
void addLathe(MeshBuilder& out, const dvec3& centre, std::span<const ProfilePoint> profile,
              const LatheOptions& options);

/// Column shaft with flutes between y = 0 and `height`, tapering from `bottom` to `top` radius with
/// a slight swelling; the flutes run out before both ends.
struct FlutedShaft {
    double height = 3, bottom = 0.26, top = 0.22;
    int flutes = 20, flute_segments = 5, levels = 8;
};
void addFlutedShaft(MeshBuilder& out, const dvec3& base, const FlutedShaft& shaft);

/// Round bar along straight pieces; rings are at right angles to the path, ends are open.
void addTube(MeshBuilder& out, std::span<const dvec3> path, double radius, int sides);

/// A cable between two points that hangs through by `sag` in the middle (parabola).
void addCable(MeshBuilder& out, const dvec3& from, const dvec3& to, double sag, double radius,
              int segments, int sides);

/// (p, q) torus knot around the y axis: ring radius 1, winding radius `winding`.
struct TorusKnot {
    int p = 2, q = 3;
    double winding = 0.42, tube = 0.16;
    int segments = 192, sides = 16;
};
void addTorusKnot(MeshBuilder& out, const TorusKnot& knot);

/// Cards of foliage scattered in an ellipsoid; each shows one quarter of a 2 × 2 leaf atlas.
/// Normals point away from the centre, so that the whole crown is shaded as one body.
struct Foliage {
    dvec3 centre{0.0}, radii{1.0};
    int cards = 200;
    double card_size = 0.3;
    uint32_t seed = 1;
};
void addFoliage(MeshBuilder& out, const Foliage& foliage);

}  // namespace still::scenes
