#include "postfx/internal/kernels.h"
namespace still::taa {
TileKernels tileKernels(SimdTarget) { return {}; }
}
