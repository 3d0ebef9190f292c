#pragma once
// What the frame loop and the G-buffer tell about a frame, in the forms in which kernels look it
// up; and which tiles need what because of it. For native frames and smaller ones alike.

#include <cstdint>
#include <span>
#include <vector>

#include "postfx/internal/memory.h"
#include "postfx/internal/ring.h"
#include "postfx/taa.h"
#include "rasterizer/gbuffer.h"
#include "rasterizer/workers.h"

namespace still::taa {

/// Light, a material or a texture changed since the frame before.
bool changesShading(const TaaFrame& frame);

bool allStill(const GBuffer& gbuffer);

Current currentOf(const GBuffer& gbuffer);

/// How long ago each surface's shading changed, and which surfaces turn.
class SurfaceChanges {
  public:
    /// Memory for all that may be noted.
    void reserve();
    /// Nothing is known of what was before.
    void forget(int ring) { since_ = ring; }
    /// Once per frame that is kept. `now`: shading changed, as changesShading() says.
    void note(const TaaFrame& frame, bool now, int ring);
    /// Job::change_age.
    const uint32_t* ages(int ring) const { return since_ < ring ? ages_.data() : nullptr; }
    /// Job::turning.
    const uint32_t* turning() const { return turning_.empty() ? nullptr : turning_.data(); }

  private:
    void countAges(const TaaFrame& frame, bool now, int ring);
    void noteTurning(std::span<const uint64_t> surfaces);

    std::vector<uint32_t> ages_;  ///< empty until something changes
    std::vector<uint32_t> turning_;
    int since_ = 0;  ///< kept frames since any surface changed; counts to the ring's length
};

/// Which tiles of an image as large as `age` have pixels that were lit otherwise within the last
/// `past` frames; whether any has. Without `age` none has.
bool noteLightAge(std::span<TileMemory> tiles, ImageView<const uint8_t> age, int past,
                  Workers& workers);

/// Notes what each tile needs; whether any needs the ring, whose length is `ring`. Where nothing
/// happens, the ring is of use only until it is full and the sums are shown: later frames would say
/// the same. `first`: nothing of the past is known; `repeats`: TaaFrame::repeats.
bool planTiles(std::span<TileMemory> tiles, std::span<const TileFacts> facts, bool first,
               bool shading_changed, int repeats, int ring);

/// Notes where this frame's samples lie, in the tiles that are kept; the others' lie where they
/// lay.
void noteJitter(SlotPlanes& slot, const TaaFrame& frame, std::span<const TileMemory> tiles);

/// All tiles' sums are of the present view, and complete.
bool allFinished(std::span<const TileMemory> tiles);
/// … and this frame changed nothing.
bool allConverged(std::span<const TileMemory> tiles);

/// A frame in which nothing is done.
void restTiles(std::span<TileMemory> tiles);

}  // namespace still::taa
