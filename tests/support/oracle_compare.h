#pragma once
// What the fast rasterizer drew against the oracle, for surfaces that are opaque.

#include <string>

#include "rasterizer/gbuffer.h"
#include "tests/support/oracle_rasterizer.h"

namespace still::test {

/// Empty when every pixel shows the surface that the oracle sees there, but for what is not
/// determined: next to edges that clipping has made, and between depths that are equal but for
/// rounding. Else the first one that does not. All materials are opaque.
std::string differenceToOracle(const DrawList& list, const FrameView& view, const GBuffer& fast);

}  // namespace still::test
