#pragma once
// Names the first difference between two G-buffers in pipeline order.

#include <string>

#include "rasterizer/gbuffer.h"

namespace still::test {

/// Empty when all planes that both have are equal, else one line that names plane, tile, pixel and
/// both values, in the order depth, id, normal, motion, depth_before, albedo, red, green, blue.
std::string firstDifference(const GBuffer& a, const GBuffer& b);

}  // namespace still::test
