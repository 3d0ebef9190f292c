#pragma once
// What the vertex and triangle stages hand on, and the table of their kernels. Each kernel stands
// in NAME-inl.h (Highway) and NAME_reference.cpp (the plain scalar truth).

#include <cstddef>
#include <cstdint>

#include "rasterizer/draw_list.h"
#include "rasterizer/gbuffer.h"
#include "rasterizer/internal/matrix.h"
#include "rasterizer/limits.h"
#include "rasterizer/simd.h"

namespace still::internal {

// ---- vertex stage ----------------------------------------------------------------------------

/// Why a vertex may need care. A triangle whose vertices share one of the frustum bits is outside.
enum Outcode : uint8_t {
    kOutNear = 1,  ///< in front of the near plane or w ≤ 0: no screen position
    kOutLeft = 2,  ///< beyond the picture's edge by more than a pixel
    kOutRight = 4,
    kOutTop = 8,
    kOutBottom = 16,
    kOutFar = 32,
    kOutGuard = 64,    ///< farther than the guard band: no screen position
    kOutInvalid = 128  ///< not finite: the triangle is dropped
};
constexpr int kOutFrustum = kOutNear | kOutLeft | kOutRight | kOutTop | kOutBottom | kOutFar;

/// Half size of the guard band around the picture's centre, in pixels: edge lengths stay below 2^15
/// pixels, so that edge functions fit 64 bits and, inside a tile, 32 bits.
constexpr float kGuardBandPx = 16384.0f;

/// x of a vertex that has no position on the screen.
constexpr int32_t kNoPosition = INT32_MIN;

/// A vertex on the screen, relative to the picture's top left, still without jitter. One 16-byte
/// load fetches it, whatever the order of the triangles.
struct alignas(16) ScreenVertex {
    int32_t x_fx8;  ///< or kNoPosition: y_fx8 is the outcode that says why, z and inv_w are 0
    int32_t y_fx8;
    float z;  ///< reversed depth
    float inv_w;

    bool placed() const { return x_fx8 != kNoPosition; }
};

struct VertexJob {
    const float *x, *y, *z;          ///< object space
    MatrixF clip;                    ///< rows x, y, z' (reversed), w
    float scale_x_fx8, scale_y_fx8;  ///< NDC → 1/256 pixel: 128·width, −128·height
    int32_t centre_x_fx8, centre_y_fx8;
    float frustum_x, frustum_y;  ///< 1 plus one pixel in NDC
    float guard_fx8;
    ScreenVertex* out;
};

/// Bounds in object space.
struct PositionBox {
    float low[3], high[3];
};

// ---- triangle stage --------------------------------------------------------------------------

constexpr int kTileShift = 6;
static_assert(1 << kTileShift == kTileSize);

/// Triangles up to this size in x and in y, a tile's, stay in 16-bit coordinates relative to any
/// tile that they touch, touch at most two in a row, and products of their extents fit 32 bits.
constexpr int32_t kCompactExtentFx8 = 64 << 8;

/// Bits of TileTriangle::id.
constexpr uint32_t kTriangleMask = 0xFFFF;
constexpr uint32_t kSwapped = 1u << 16;  ///< vertices 1 and 2 were exchanged to orient it
constexpr uint32_t kWide = 1u << 17;     ///< too large for 16 bits, or clipped

struct Corner16 {
    int16_t x_fx8, y_fx8;
};

/// One triangle in one tile, ready for coverage: what a tile reads of all that may be visible in
/// it, in submission order. Oriented so that its doubled area is positive with y down. Eight words,
/// so that as many lanes as there are can take one triangle each.
struct alignas(32) TileTriangle {
    Corner16 corner[3];  ///< relative to the tile's first sample; unspecified when wide
    float z[3];          ///< of the corners; unspecified when wide
    /// Samples within its bounds, the tile and the picture, from the tile's first, inclusive, never
    /// empty.
    uint8_t x0, y0, x1, y1;
    uint32_t id;  ///< low half: triangle in its chunk; when wide: index into Chunk::wide
};
static_assert(sizeof(TileTriangle) == 32);

/// A large or clipped triangle. Positions are relative to the sample of pixel (0, 0): pixel (x, y)
/// is sampled at (256·x, 256·y). Oriented as TileTriangle.
struct SetupTriangle {
    int32_t x_fx8[3], y_fx8[3];
    float z[3], inv_w[3];
    uint32_t triangle;  ///< in its mesh
    int32_t clip;       ///< index of its barycentrics, or −1 when it was not clipped
    uint8_t swapped;    ///< vertices 1 and 2 were exchanged to orient it
};

/// Barycentric coordinates of a clipped triangle's vertices in the triangle it came from.
struct ClipBarycentrics {
    float b[3][3];
};

struct TriangleJob {
    const uint32_t* indices = nullptr;  ///< of the first of them
    const ScreenVertex* vertices = nullptr;
    uint32_t count = 0;                      ///< 1 … kChunkTriangles
    int sample_x_fx8 = 0, sample_y_fx8 = 0;  ///< position of the sample in a pixel
    int width = 0, height = 0;               ///< of the picture
};

/// What is left of a chunk's triangles, in their order: those that have a sample within their
/// bounds and the picture, and an area, except that wide ones are yet to be set up. Coordinates and
/// box are relative to the first tile that the triangle touches, and the box may reach beyond it;
/// of wide ones only `id` is specified, with the triangle in the chunk.
struct TriangleBatch {
    static constexpr uint32_t kCapacity = kChunkTriangles + 16;  ///< whole vectors are stored
    /// Bits of `place`; without any the lower half is the first tile, x + 256 · y.
    static constexpr uint32_t kSeveralTiles = 1u << 16, kWidePlace = 1u << 17;

    TileTriangle records[kCapacity];
    alignas(64) uint32_t place[kCapacity];
    uint32_t count = 0;
    uint32_t flags = 0;  ///< union of the upper halves of `place`
    /// Rectangle of tiles that the compact ones touch, inclusive; empty without any.
    int32_t tile_x0 = 0, tile_y0 = 0, tile_x1 = 0, tile_y1 = 0;
};
static_assert(kMaxTargetSize / kTileSize <= 256);

struct GeometryKernels {
    void (*transformVertices)(const VertexJob& job, int begin, int end);
    /// `count` ≥ 1. Serial, and so fast that it need not be kept from frame to frame.
    PositionBox (*boundVertices)(const float* x, const float* y, const float* z, size_t count);
    /// Replaces the batch's contents.
    void (*cullTriangles)(const TriangleJob& job, TriangleBatch& batch);
};

/// The plain scalar kernels that define the truth.
const GeometryKernels& referenceGeometry();
/// Kernels for a target of availableSimdTargets().
const GeometryKernels& geometryFor(SimdTarget target);

}  // namespace still::internal
