#include "postfx/internal/resolve.h"
namespace still::taa {
TileKernel tileKernel(SimdTarget) {
    return resolveTileReference;
}
}  // namespace still::taa
