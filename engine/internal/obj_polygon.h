#pragma once
// Polygons of OBJ faces → triangles.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace still {

/// Appends the triangles of a polygon with `corners.size()` ≥ 3 corners to `triangles`, as numbers
/// of corners, with the polygon's winding; always corners − 2 of them. Concave polygons without
/// self-intersection are covered exactly once (when they are flat); others get some triangulation.
/// Depends on the coordinates only, not on anything before.
void triangulatePolygon(std::span<const std::array<float, 3>> corners,
                        std::vector<std::array<uint32_t, 3>>& triangles);

}  // namespace still
