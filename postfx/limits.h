#pragma once
// How much memory postfx takes, as rasterizer/limits.h says it of the rasterizer.

#include <cstddef>
#include <cstdint>

#include "postfx/policy.h"
#include "rasterizer/arena.h"
#include "rasterizer/gbuffer.h"
#include "rasterizer/limits.h"

namespace still {

namespace lab {

/// Columns and rows around the picture in the colour planes of history that repeat its border, so
/// that filters need no test.
constexpr int kMargin = 2;
#if STILL_BOARD
constexpr int kLeftColumns = kMargin;
constexpr int kRightColumns = kMargin + 1;
/// The image takes the memory of the past when no pixel reads it any more.
constexpr bool kShowsOverPast = true;
#else
/// Columns that history planes have left and right of the picture: whole vectors are written past
/// the right border, and must not reach the next row.
constexpr int kLeftColumns = 16;
constexpr int kRightColumns = 80;
constexpr bool kShowsOverPast = false;
#endif

// Planes of history that a policy needs beyond colour.
constexpr bool needsMemory(const TaaPolicy& p) {
    return p.blend == Blend::mean || p.blend == Blend::confidence;
}
constexpr bool needsDepth(const TaaPolicy& p) {
    return p.depth_reject_q15 > 0;
}
constexpr bool needsNormal(const TaaPolicy& p) {
    return p.normal_reject_q15 > 0;
}
constexpr bool needsMotion(const TaaPolicy& p) {
    return p.velocity_reject_fx8 > 0;
}

/// No less than a Laboratory::State, asserted.
constexpr size_t kStateBytes = 38 * sizeof(void*) + 512;

}  // namespace lab

namespace taa {

// What is allocated and not seen from here; taa.cpp asserts it.
constexpr size_t kStateBytes = 120 * sizeof(void*) + 12800;
constexpr size_t kSlotBytes = 34 * sizeof(void*) + 88;
constexpr size_t kTileJitterBytes = 4, kTileMemoryBytes = 12;
constexpr size_t kSlotPlanes = 10;

}  // namespace taa

/// Bytes of an Arena that a Taa takes at most: itself, and what reserve() makes for `ring` slots.
/// 384 KB of it are tables of all surface numbers.
constexpr size_t taaBytes(int width, int height, int ring) {
    using namespace taa;
    const size_t tiles = internal::tileCount(width, height);
    const size_t byte_plane = planeArenaBytes<uint8_t>(width, height);
    const size_t plane = planeArenaBytes<uint16_t>(width, height);
    const size_t slot = kSlotPlanes * plane + arenaBytes(tiles * kTileJitterBytes);
    const size_t sums = 3 * plane + 3 * byte_plane + byte_plane;
    const size_t shown = 3 * plane + byte_plane, hint = plane, marks = byte_plane;
    return arenaBytes(kStateBytes) + arenaBytes(size_t(ring) * kSlotBytes) + size_t(ring) * slot +
           sums + shown + hint + marks + arenaBytes(tiles * kTileMemoryBytes) +
           2 * arenaBytes(tiles) + 3 * arenaBytes((size_t(kSurfaceMask) + 1) * sizeof(uint32_t));
}

/// Bytes of an Arena that a Laboratory takes at most: itself, and what reserve() makes.
constexpr size_t laboratoryBytes(int width, int height, const TaaPolicy& policy) {
    using namespace lab;
    const int w = width + kLeftColumns + kRightColumns, h = height + 2 * kMargin;
    const size_t facts =
        (needsDepth(policy) ? 1 : 0) + (policy.id_reject ? 1 : 0) + (needsNormal(policy) ? 1 : 0);
    const size_t history = 3 * planeArenaBytes<uint32_t>(w, h) +
                           facts * planeArenaBytes<uint16_t>(w, h) +
                           (needsMemory(policy) ? planeArenaBytes<uint8_t>(w, h) : 0) +
                           (needsMotion(policy) ? planeArenaBytes<Motion>(w, h) : 0);
    const size_t shown =
        3 * planeArenaBytes<uint16_t>(width, height) + planeArenaBytes<uint8_t>(width, height);
    return arenaBytes(kStateBytes) + 2 * history + (kShowsOverPast ? 0 : shown);
}

}  // namespace still
