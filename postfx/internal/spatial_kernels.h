#pragma once
// The two passes of SpatialEdges::geometry that touch every pixel, row by row. Both have a scalar
// twin, spatial_reference.cpp, that defines their results.

#include "postfx/spatial.h"

namespace still::spatial {

struct RowKernels {
    /// Edge bits of row `y`, see spatial_rules.h; `marks` has room for the row's padding.
    void (*markEdges)(const SpatialInput& input, int y, uint8_t* marks);
    /// Row `y`, neither the first nor the last, columns 1 … width − 2: where no edge is within the
    /// 3×3 window, writes the pixel's mean and clears `busy[x]`; else busy[x] becomes non-zero and
    /// `out` is unspecified. Also unspecified: the first and the last column. `busy` has room for
    /// the row's padding.
    void (*meanRow)(const SpatialInput& input, ImageView<const uint8_t> edges, int y,
                    const ColourTargets& out, uint8_t* busy);
};

RowKernels rowKernels(SimdTarget target);
RowKernels referenceKernels();

}  // namespace still::spatial
