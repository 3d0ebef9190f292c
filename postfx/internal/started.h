#pragma once
// Things that begin to move leave their samples behind in the sums of pixels they no longer touch.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "postfx/internal/ring.h"
#include "rasterizer/gbuffer.h"
#include "rasterizer/workers.h"

namespace still::taa {

/// Surfaces that are seen moving now and were not in the frame before.
class StartedSurfaces {
  public:
    /// Memory for all that may be noted.
    void reserve() { ages_.reserve(size_t(kSurfaceMask) + 1); }
    /// Once per frame, in order. After `first` nothing has started. When the camera starts, so does
    /// everything.
    void note(const GBuffer& gbuffer, bool first, Workers& workers);
    /// Instead, in a frame in which nothing moves.
    void noteRest() {
        now_ = {};
        any_ = camera_ = camera_started_ = false;
    }
    /// Once per frame that is kept, after note(). `ring`: frames after which starts are forgotten.
    void countAges(bool first, int ring);
    /// Kept frames since each surface started, 255 at most; null when that was long ago for all.
    const uint32_t* ages() const { return since_ < ring_ ? ages_.data() : nullptr; }

    bool any() const { return any_; }
    bool contains(int surface) const {
        return ((started_[size_t(surface) / 32] >> (size_t(surface) % 32)) & 1) != 0;
    }

  private:
    using Bits = std::array<uint32_t, (size_t(kSurfaceMask) + 1) / 32>;
    Bits now_{}, before_{}, started_{};
    bool any_ = false;
    bool camera_ = false, camera_started_ = false;
    std::vector<uint32_t> ages_;
    int since_ = 0, ring_ = 0;
};

/// Takes their sums from the tile's pixels whose 3×3 window showed a started surface in the last
/// frame, whose ids are `last`.
void forgetStarted(const StartedSurfaces& started, ImageView<const int16_t> last,
                   const TileRect& tile, ImageView<uint8_t> count) noexcept;

}  // namespace still::taa
