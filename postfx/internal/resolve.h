#pragma once
// Kernels that resolve one tile. The scalar functions define the result; the SIMD ones equal them
// bit for bit and call resolvePixel() for pixels that do not fit their lanes.

#include "postfx/internal/history.h"
#include "rasterizer/simd.h"

namespace still::taa {

/// What a kernel reports about a tile it has written.
struct TileResult {
    bool finished = false;  ///< every pixel has job.sample_cap samples
    bool changed = false;   ///< some pixel took a new sample
};

/// Resolves the pixel by the rules of TileWork::general and writes its history. Returns whether the
/// pixel is finished and unchanged.
bool resolvePixel(const ResolveJob& job, int x, int y) noexcept;

/// `work` is not idle.
TileResult resolveTileReference(const ResolveJob& job, const TileRect& tile,
                                TileWork work) noexcept;

using TileKernel = TileResult (*)(const ResolveJob&, const TileRect&, TileWork) noexcept;

/// The kernel for a target that availableSimdTargets() lists.
TileKernel tileKernel(SimdTarget target);

}  // namespace still::taa
