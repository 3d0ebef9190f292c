#pragma once
// How much memory the rasterizer takes for frames of bounded size, so that a caller without a heap
// can give it all at once: see arena.h and demos/embedded.

#include <cstddef>
#include <cstdint>

#include "rasterizer/arena.h"
#include "rasterizer/gbuffer.h"

namespace still {

/// Triangles are worked on in chunks of up to this many consecutive ones of a mesh part: a
/// constant, so that the cut does not depend on the threads. No byte of a picture depends on it.
#if STILL_BOARD
constexpr uint32_t kChunkTriangles = 128;  // a chunk's scratch memory is 36 bytes a triangle
#else
constexpr uint32_t kChunkTriangles = 1024;
#endif

/// The most that frames will need. A frame beyond it is still right, but takes more memory then.
struct RasterLimits {
    int width = 0, height = 0;
    int threads = 1;
    // Of all instances together; a mesh that is drawn twice counts twice.
    size_t instances = 0;
    size_t surfaces = 0;  ///< parts
    size_t vertices = 0;
    size_t chunks = 0;  ///< of each part, its triangles / kChunkTriangles, rounded up
    /// Of a chunk: for each of its triangles, as many as it touches tiles.
    size_t chunk_records = 0;
    /// Of a chunk: triangles higher or wider than 64 pixels, or that the near plane or the guard
    /// band cuts, and these as often as there are pieces of them (at most 6).
    size_t chunk_wide = 0;
    size_t tile_triangles = 0;  ///< that touch one tile
};

namespace internal {

// Sizes of what is allocated; rasterizer.cpp asserts that they are no less than the real ones.
constexpr size_t kPointer = sizeof(void*);
constexpr size_t kRasterizerBytes = 66 * kPointer + 656;
constexpr size_t kSurfaceBytes = 12 * kPointer + 24;
constexpr size_t kInstanceBytes = 288;
constexpr size_t kVertexJobBytes = 4 * kPointer + 96;
constexpr size_t kVertexBytes = 16, kVertexChunkBytes = 12, kVertexChunkVertices = 2048;
constexpr size_t kChunkInputBytes = 2 * kPointer + 16;
constexpr size_t kChunkBytes = 12 * kPointer + 24, kChunkRectBytes = 8;
constexpr size_t kRecordBytes = 32, kWideBytes = 60, kClipBytes = 36;
constexpr size_t kEntryBytes = 8, kWideBoxBytes = 16;
constexpr size_t kBinScratchBytes = (kChunkTriangles + 16) * 36 + 12 * kPointer + 256;
constexpr size_t kTileScratchBytes =
    2 * sizeof(float) * (kTileSize * kTileSize + kTileSize + 8) + 12 * kPointer + 224;
constexpr size_t kTileRunBytes = 2 * kPointer, kShadeBytes = 256, kSpareRecords = 16;

constexpr size_t tileCount(int width, int height) {
    const auto along = [](int pixels) { return size_t((pixels + kTileSize - 1) / kTileSize); };
    return along(width) * along(height);
}

}  // namespace internal

/// Bytes of an Arena that a GBuffer takes at most.
constexpr size_t gbufferBytes(int width, int height, PlaneSet planes) {
    const size_t small = planeArenaBytes<uint16_t>(width, height);
    const size_t large = planeArenaBytes<uint32_t>(width, height);
    return 4 * small + large + (planes.normal ? large : 0) + (planes.albedo ? 3 * small : 0) +
           (planes.motion ? large + small : 0) +
           2 * arenaBytes(internal::tileCount(width, height) * sizeof(TileFacts));
}

/// Bytes of an Arena that a Rasterizer takes at most: itself, and what reserve() makes.
constexpr size_t rasterizerBytes(const RasterLimits& l) {
    using namespace internal;
    const size_t tiles = tileCount(l.width, l.height);
    const size_t frame =
        arenaBytes((l.surfaces + 1) * kSurfaceBytes) + arenaBytes(l.instances * kInstanceBytes) +
        arenaBytes(l.instances * kVertexJobBytes) + arenaBytes(l.instances * sizeof(size_t)) +
        arenaBytes(tiles * sizeof(TileFacts)) + arenaBytes(l.vertices * kVertexBytes) +
        arenaBytes((l.instances + l.vertices / kVertexChunkVertices) * kVertexChunkBytes) +
        arenaBytes(l.chunks * kChunkInputBytes) + arenaBytes(l.chunks * kChunkBytes) +
        arenaBytes(l.chunks * kChunkRectBytes);
    const size_t chunk = arenaBytes((tiles + 1) * sizeof(uint32_t)) +
                         arenaBytes(l.chunk_records * kRecordBytes, kRecordBytes) +
                         arenaBytes(l.chunk_wide * kWideBytes) +
                         arenaBytes(l.chunk_wide * kClipBytes);
    const size_t worker =
        2 * arenaBytes(kPointer) + arenaBytes(kBinScratchBytes, 64) +
        arenaBytes(l.chunk_records * kEntryBytes) +
        arenaBytes(l.chunk_records * kRecordBytes, kRecordBytes) +
        arenaBytes(l.chunk_wide * kWideBoxBytes) + arenaBytes(l.chunk_wide * sizeof(uint32_t)) +
        arenaBytes(kTileScratchBytes, 64) + arenaBytes((l.chunks + 1) * kTileRunBytes) +
        arenaBytes((l.tile_triangles + kSpareRecords) * kRecordBytes, kRecordBytes) +
        arenaBytes((l.tile_triangles + 1) * kShadeBytes, 64) + 2 * arenaBytes(l.tile_triangles + 1);
    return arenaBytes(kRasterizerBytes) + frame + l.chunks * chunk + size_t(l.threads) * worker;
}

}  // namespace still
