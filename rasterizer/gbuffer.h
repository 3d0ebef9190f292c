#pragma once
// What the rasterizer hands on: planes of one sample per pixel, and what it knows about each tile.
// Formats, ranges and rounding are explained in rasterizer/README.md.

#include <cstdint>
#include <vector>

#include "rasterizer/image.h"

namespace still {

/// Tiles are kTileSize × kTileSize pixels; one task, one writer, one cache-resident set of planes.
constexpr int kTileSize = 64;

/// Planes that someone reads this frame; colour, depth and id always exist.
struct PlaneSet {
    bool normal = false;
    bool motion = false;  ///< motion and previous depth
    bool albedo = false;  ///< what diffuse light is multiplied by
    friend bool operator==(const PlaneSet&, const PlaneSet&) = default;
};

/// Bits of the id plane: surface number (0 = background), and whether that surface's instance
/// moved.
constexpr uint16_t kSurfaceMask = 0x7FFF;
constexpr uint16_t kMovedBit = 0x8000;

/// Motion of one pixel in 1/256 pixel, previous position minus current position, both unjittered:
/// the surface seen at p now was seen at p + motion. Range −127.99 … 127.99 pixel in each axis.
struct Motion {
    int16_t x_fx8 = 0, y_fx8 = 0;
    friend bool operator==(const Motion&, const Motion&) = default;
};
/// x_fx8 of a pixel that has no history: farther than the range, or behind the previous camera.
constexpr int16_t kNoHistory = INT16_MIN;

/// What is known about a tile once it is rasterized; later passes choose their loop by it.
struct TileFacts {
    /// An instance that moved is here, or within 2 pixels, now or was so in the last frame.
    bool moved = false;
    bool camera_moved = false;  ///< same for all tiles of a frame

    /// Nothing in the tile changed place since the last frame: all motion is exactly zero.
    bool still() const { return !moved && !camera_moved; }
};

struct GBuffer {
    PlaneSet planes;
    Image<uint16_t> red, green, blue;  ///< linear light, 1.0 = 4096 (fx12), saturated
    Image<uint16_t> albedo_red, albedo_green, albedo_blue;  ///< fx12 too; 0 where nothing is
    Image<uint32_t> depth;   ///< bits of the reversed-Z float, see logDepth16()
    Image<uint16_t> id;      ///< kSurfaceMask, kMovedBit
    Image<uint32_t> normal;  ///< octahedral: low 16 bits x, high 16 bits y, snorm16; world
    Image<Motion> motion;
    Image<uint16_t> depth_before;  ///< logDepth16 the surface had in the previous frame (expected)
    int tiles_x = 0, tiles_y = 0;
    std::vector<TileFacts> tiles;  ///< row by row
    /// Per tile, 1 while its motion holds zeros: a tile that stays still is not written again.
    std::vector<uint8_t> motion_is_zero;

    int width() const { return red.width(); }
    int height() const { return red.height(); }
    /// Makes the planes exist; a changed size makes their contents zero.
    void resize(int width, int height, PlaneSet wanted);
};

/// Decodes the normal plane. The result is not exactly of unit length.
struct NormalVector {
    float x, y, z;
};
NormalVector decodeOctahedral(uint32_t packed);

}  // namespace still
