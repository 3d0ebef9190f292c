#pragma once
// A chequered ring that turns over a chequered floor, 160 × 120, with TAA: everything between the
// arena and the pixels, the same on the board and on the desktop.

#include <algorithm>

#include "postfx/laboratory.h"
#include "postfx/limits.h"
#include "rasterizer/limits.h"
#include "rasterizer/rasterizer.h"

namespace spin {

constexpr int kWidth = 160, kHeight = 120;
/// One turn; a frame is a pure function of its number, modulo the first few that TAA remembers.
constexpr int kTurnFrames = 64;

/// Salvi's: the preset `variance`, as a constant because the arena's size follows from it.
constexpr still::TaaPolicy kPolicy{
    .method = still::Method::recursive,
    .jitter = still::JitterPattern::halton16,
    .alpha_q15 = 3277,
    .dilation = still::Dilation::nearest_depth,
    .history = still::HistoryFilter::catmull_rom16,
    .rectification = still::Rectification::variance_clip,
    .space = still::ColourSpace::ycocg,
    .sigma_fx8 = 256,
};

constexpr int kRingSides = 32, kTubeSides = 8;
constexpr size_t kRingTriangles = 2 * kRingSides * kTubeSides;
constexpr size_t kRingVertices = (kRingSides + 1) * (kTubeSides + 1);
constexpr size_t kFloorTriangles = 2, kFloorVertices = 4;
constexpr uint32_t kTextureSize = 16;

constexpr size_t chunksOf(size_t triangles) {
    return (triangles + still::kChunkTriangles - 1) / still::kChunkTriangles;
}

#if STILL_BOARD
constexpr int kMaxThreads = 1;
#else
constexpr int kMaxThreads = 4;
#endif

/// What a turn needs at most, measured: the arena is sealed, so that more would stop the program.
constexpr still::RasterLimits kLimits{
    .width = kWidth,
    .height = kHeight,
    .threads = kMaxThreads,
    .instances = 2,
    .surfaces = 2,
    .vertices = kRingVertices + kFloorVertices,
    .chunks = chunksOf(kRingTriangles) + chunksOf(kFloorTriangles),
    .chunk_records = std::min<size_t>(still::kChunkTriangles, kRingTriangles) * 3 / 2,
    .chunk_wide = 4,
    .tile_triangles = 240,
};
constexpr still::PlaneSet kPlanes{.motion = true};

/// Meshes, texture, materials, tables.
constexpr size_t sceneBytes() {
    const auto mesh = [](size_t vertices, size_t triangles) {
        return 3 * still::arenaBytes(vertices * sizeof(float)) +
               still::arenaBytes(vertices * sizeof(still::VertexAttributes)) +
               still::arenaBytes(triangles * 3 * sizeof(uint32_t)) +
               still::arenaBytes(sizeof(still::MeshPart));
    };
    return mesh(kRingVertices, kRingTriangles) + mesh(kFloorVertices, kFloorTriangles) + 4096;
}

constexpr size_t kArenaBytes = still::rasterizerBytes(kLimits) +
                               still::gbufferBytes(kWidth, kHeight, kPlanes) +
                               still::laboratoryBytes(kWidth, kHeight, kPolicy) + sceneBytes();

/// 64-bit hashes (FNV-1a) of a frame.
struct FrameHashes {
    uint64_t gbuffer = 0;  ///< colour, depth, id, motion and previous depth
    uint64_t image = 0;    ///< after TAA, linear light
};

/// Makes all memory that it will ever need.
class Spinner {
  public:
    Spinner(still::SimdTarget simd, still::Workers& workers);

    /// In order, from 0.
    FrameHashes render(int frame);
    still::ColourPlanes image() const { return taa_.colour(); }

  private:
    still::FrameView viewOf(int frame) const;
    void place(int frame);

    still::Workers& workers_;
    still::RasterSettings settings_;
    still::Mesh meshes_[2];
    still::Texture texture_;
    still::Material materials_[2];
    still::Instance instances_[2];
    still::DrawList list_;
    double turn_[kTurnFrames][2];  ///< cosine and sine of each frame's angle
    still::Rasterizer rasterizer_;
    still::GBuffer gbuffer_;
    still::Laboratory taa_;
};

}  // namespace spin
