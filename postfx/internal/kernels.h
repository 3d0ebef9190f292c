#pragma once
// The kernels that resolve tiles. The scalar functions define the result; the SIMD ones equal them
// bit for bit.

#include "postfx/internal/accumulate.h"
#include "postfx/internal/gather.h"
#include "postfx/internal/owner.h"
#include "rasterizer/simd.h"

namespace still::taa {

struct TileKernels {
    void (*record)(const Job&, const TileRect&) noexcept = recordTileReference;
    SumsResult (*accumulate)(const Job&, const TileRect&, Stillness,
                             bool restart) noexcept = accumulateTileReference;
    void (*gather)(const Job&, const TileRect&, bool sums_valid) noexcept = gatherTileReference;
};

/// The kernels for a target that availableSimdTargets() lists.
TileKernels tileKernels(SimdTarget target);

}  // namespace still::taa
