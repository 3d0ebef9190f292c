#pragma once
// G-buffers full of noise for comparing kernels: surfaces in patches, motions of all kinds, depths
// that nearly agree.

#include <cstdint>

#include "rasterizer/gbuffer.h"

namespace random_frames {

/// Small, seeded, the same everywhere.
class Random {
  public:
    explicit Random(uint64_t seed) : state_(seed * 2654435769u + 88172645463325252u) {}
    /// 0 … bound − 1
    int below(int bound);
    bool chance(int percent) { return below(100) < percent; }

  private:
    uint64_t state_;
};

struct Options {
    int width = 64, height = 64;
    bool with_normals = true;
    bool camera_moved = true;
    int patch = 9;  ///< side of a patch of equal surface and motion
};

void fill(const Options& options, Random& random, still::GBuffer& out);

}  // namespace random_frames
