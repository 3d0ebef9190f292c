#pragma once
// Meshes made by code: the built-in shapes of scene files and the bricks of the built-in scenes.
// Every mesh has one part with material 0, unit normals and texture coordinates.

#include <string>
#include <vector>

#include "engine/result.h"
#include "rasterizer/draw_list.h"

namespace still::shapes {

/// Axis-aligned box with half extents (x, y, z) around the origin; each face has u, v in 0 … 1.
Mesh box(float x, float y, float z);
/// Horizontal rectangle at y = 0, half extents (x, z), cut into nx × nz quads; u, v in 0 … `tiles`.
Mesh plane(float x, float z, int nx, int nz, float tiles);
/// Latitude-longitude sphere of radius 1; `segments` around ≥ 3, `rings` from pole to pole ≥ 2.
Mesh sphere(int segments, int rings);
/// Upright cylinder of radius 1 from y = −1 to 1 with caps.
Mesh cylinder(int segments);
/// Torus around the y axis, radii 1 and `tube`.
Mesh torus(float tube, int segments, int sides);

/// The shape a scene file names: "box", "plane", "sphere", "cylinder", "torus"; box, plane, sphere
/// and cylinder reach from −1 to 1, the torus has radii 1 and 0.35.
Result<Mesh> named(const std::string& name);
std::vector<std::string> names();

}  // namespace still::shapes
