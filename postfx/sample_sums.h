#pragma once
// Many samples a pixel, averaged in full precision.

#include <cstdint>

#include "postfx/colour_targets.h"
#include "postfx/taa.h"
#include "rasterizer/image.h"
#include "rasterizer/workers.h"

namespace still {

/// Per-channel sums of up to 65536 samples: 65536 · 65535 fits 32 bits.
class ColourSums {
  public:
    void resize(int width, int height);
    /// `first`: the sums begin with this sample.
    void add(const ColourPlanes& sample, bool first, Workers& workers);
    /// Rounded half up.
    void average(uint32_t count, const ColourTargets& out, Workers& workers) const;

  private:
    Image<uint32_t> red_, green_, blue_;
};

}  // namespace still
