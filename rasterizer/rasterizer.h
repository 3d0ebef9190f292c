#pragma once
// Draw list in, G-buffer out: vertices → clip → setup → bins → tile { coverage → visibility → shade
// }.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "rasterizer/draw_list.h"
#include "rasterizer/gbuffer.h"
#include "rasterizer/limits.h"
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
    /// A clock in any unit that grows, called by all workers; null: RasterCounters::ticks stay 0.
    uint64_t (*ticks)() = nullptr;
};

/// Ticks of RasterSettings::ticks that the workers spent, summed over them.
struct StageTicks {
    uint64_t transform = 0, bin = 0;
    uint64_t visibility = 0;  ///< collecting a tile's triangles, coverage and depth
    uint64_t shade = 0;       ///< with shading setup and all planes' writes

    void operator+=(const StageTicks& o) {
        transform += o.transform;
        bin += o.bin;
        visibility += o.visibility;
        shade += o.shade;
    }
};

/// Of one frame: those of the lists after transformAndBin(), the others after rasterize().
struct RasterCounters {
    uint64_t triangles = 0;       ///< submitted
    uint64_t clipped = 0;         ///< went through the clipper
    uint64_t binned = 0;          ///< survived culling
    uint64_t tile_refs = 0;       ///< tiles × triangles
    uint64_t tiles = 0;           ///< rasterized
    uint64_t tiles_empty = 0;     ///< of them, reached by no triangle's bin
    uint64_t blocks_hidden = 0;   ///< 8 × 8 blocks × triangles behind what is there; SIMD only
    uint64_t blocks_outside = 0;  ///< the same, beyond an edge of the triangle; SIMD only
    uint64_t pixels_shaded = 0;   ///< with a surface; deferred shading only
    StageTicks ticks;

    void operator+=(const RasterCounters& o) {
        triangles += o.triangles;
        clipped += o.clipped;
        binned += o.binned;
        tile_refs += o.tile_refs;
        tiles += o.tiles;
        tiles_empty += o.tiles_empty;
        blocks_hidden += o.blocks_hidden;
        blocks_outside += o.blocks_outside;
        pixels_shaded += o.pixels_shaded;
        ticks += o.ticks;
    }
};

/// What the kernels do for a surface. A tile runs the smallest shading kernel that covers all of
/// its surfaces, and looks alpha up only where one needs it.
struct SurfaceWork {
    bool textured = false, normal_mapped = false, parallax = false;
    bool positioned = false;  ///< highlights or point lights: lit by where it is
    bool alpha_tested = false, stochastic = false;
    int kernel = 0;  ///< 0 = plain colours, 1 = textures, 2 = all but height maps, 3 = all
};

/// Keeps its buffers from frame to frame. Not copyable, one frame at a time. What was moved from
/// may only be destroyed or assigned to; so with all classes here and in the layers above.
class Rasterizer {
  public:
    Rasterizer();
    ~Rasterizer();
    Rasterizer(Rasterizer&&) noexcept;
    Rasterizer& operator=(Rasterizer&&) noexcept;

    /// Makes all memory at once that frames within the limits need; they allocate nothing then.
    /// Call it first, or not at all: memory grows by itself.
    void reserve(const RasterLimits& limits);

    /// The facts of the view's tiles, before anything is drawn. Preconditions as below.
    /// transformAndBin(workers) goes on from here.
    std::span<const TileFacts> setUp(const DrawList& list, const FrameView& view,
                                     const RasterSettings& settings);
    void transformAndBin(Workers& workers);

    /// Both in one. Vertex stage, clipping, setup and binning. `list` and `view` must stay valid
    /// until rasterize() has returned. Preconditions are those of DrawList and FrameView
    /// (asserted).
    void transformAndBin(const DrawList& list, const FrameView& view,
                         const RasterSettings& settings, Workers& workers);

    /// Tiles: coverage, visibility, shading. Resizes `out` and writes every pixel of every plane
    /// in settings.planes, in those tiles that are `wanted` (not 0; empty: all); elsewhere the
    /// planes stay. Facts are this frame's everywhere.
    void rasterize(GBuffer& out, Workers& workers, std::span<const uint8_t> wanted = {});

    const RasterCounters& counters() const;

    /// After setUp(): surface s is element s − 1.
    std::vector<SurfaceWork> surfaceWork() const;

    /// Writes for each pixel how many triangles hold its sample, hidden ones and holes of alpha
    /// tests included, in the frame that was binned last; at most 65535. `out` has that frame's
    /// size.
    void overdraw(ImageView<uint16_t> out, Workers& workers) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace still
