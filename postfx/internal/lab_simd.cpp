#include "postfx/internal/lab_kernels.h"

namespace still::lab {

TileKernel tileKernel(SimdTarget, const TaaPolicy&) {
    return resolveTileReference;
}

}  // namespace still::lab
