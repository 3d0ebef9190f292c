#pragma once
// Draw list in, G-buffer out: vertices → clip → setup → bins → tile { coverage → visibility → shade
// }.

#include <cstdint>
#include <memory>

#include "rasterizer/draw_list.h"
#include "rasterizer/gbuffer.h"
#include "rasterizer/simd.h"
#include "rasterizer/workers.h"

namespace still {

enum class Shading {
    deferred,  ///< visibility first, then each visible pixel is shaded once
    forward,   ///< each fragment is shaded as it passes the depth test: same bytes, an oracle
};

struct RasterSettings {
    SimdTarget simd = bestSimdTarget();
    Shading shading = Shading::deferred;
    PlaneSet planes;
    /// Added to the level of detail of every texture, in 1/256 level; the level stays within the
    /// chain. −4096 … 4096, negative is sharper.
    int mip_bias_fx8 = 0;
    /// The motion plane follows the camera alone, as if nothing else moved (depth and inverse
    /// view-projection are all that some methods have). Moved bits of ids are the same.
    bool camera_motion_only = false;
};

struct RasterCounters {
    uint64_t triangles = 0;  ///< submitted
    uint64_t clipped = 0;    ///< went through the clipper
    uint64_t binned = 0;     ///< survived culling
    uint64_t tile_refs = 0;  ///< tiles × triangles
    uint64_t tiles = 0;      ///< rasterized
};

/// Keeps its buffers from frame to frame. Not copyable, one frame at a time.
class Rasterizer {
  public:
    Rasterizer();
    ~Rasterizer();
    Rasterizer(const Rasterizer&) = delete;
    Rasterizer& operator=(const Rasterizer&) = delete;

    /// Vertex stage, clipping, setup and binning. `list` and `view` must stay valid until
    /// rasterize() has returned. Preconditions are those of DrawList and FrameView (asserted).
    void transformAndBin(const DrawList& list, const FrameView& view,
                         const RasterSettings& settings, Workers& workers);

    /// Tiles: coverage, visibility, shading. Resizes `out` and writes every pixel of every plane
    /// in settings.planes.
    void rasterize(GBuffer& out, Workers& workers);

    const RasterCounters& counters() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace still
