#pragma once
// What the tile stages hand to the SIMD kernels, and the table of kernels. Each kernel stands in
// NAME-inl.h (Highway) and NAME_reference.cpp (the plain scalar truth).

#include <cstdint>
#include <span>

#include "rasterizer/draw_list.h"
#include "rasterizer/gbuffer.h"
#include "rasterizer/internal/geometry.h"
#include "rasterizer/internal/matrix.h"
#include "rasterizer/simd.h"

namespace still::internal {

// ---- triangles -------------------------------------------------------------------------------

/// What shading needs of a triangle that is visible in a tile, in one place: b_k / w as planes over
/// the tile, evaluated from an anchor pixel near the triangle so that slivers keep their precision,
/// and the attributes of its three corners. Kernels load it in quads of four words (see
/// LaneTriangles), so the layout is fixed.
struct alignas(64) ShadeTriangle {
    float p[3];
    float anchor_x;  ///< tile-local pixel
    float p_dx[3];
    float anchor_y;
    float p_dy[3];
    float flip;  ///< −1 when the shading normal points away from the eye
    // Texture coordinates, and what their slopes take from the triangle: Σ p_dx_k, Σ p_dy_k,
    // Σ p_dx_k · u_k, …
    float u[3], sum_dx;
    float v[3], sum_dy;
    float u_dx, u_dy, v_dx, v_dy;
    float nx[3];
    float handedness;  ///< of the tangent at corner 0
    float ny[3];
    int32_t surface;
    float nz[3];
    float unused[1];
    // Only for surfaces with highlights, under point lights, or in motion.
    float x[3], unused_x, y[3], unused_y, z[3], unused_z;
    // Only for surfaces with normal or height maps.
    float tx[3], unused_tx, ty[3], unused_ty, tz[3], unused_tz;
    int32_t vertex[3];
    int32_t unused_vertex;
};
static_assert(sizeof(ShadeTriangle) == 256);

// ---- frame-wide tables -----------------------------------------------------------------------

/// What a surface's shading needs; a tile runs the smallest kernel that covers its surfaces.
enum ShadeFeature : uint8_t {
    kShadeTexture = 1,
    kShadeNormalMap = 2,
    kShadePosition = 4,  ///< highlights or point lights
    kShadeMoved = 8,
    kShadeHeightMap = 16,
};

/// The smallest kernel that covers them: 0 = plain colours, 1 = textures, 2 = everything but height
/// maps, 3 = with them.
constexpr int shadeLevel(uint8_t features) {
    return (features & kShadeHeightMap) != 0                      ? 3
           : (features & (kShadeNormalMap | kShadePosition)) != 0 ? 2
           : (features & kShadeTexture) != 0                      ? 1
                                                                  : 0;
}

constexpr int kAttributeStride = sizeof(VertexAttributes) / sizeof(float);
constexpr int kTangentStride = sizeof(VertexTangent) / sizeof(float);

struct Surface {
    const float* attributes = nullptr;  ///< VertexAttributes as floats, stride kAttributeStride
    const float* tangents = nullptr;    ///< VertexTangent as floats, stride kTangentStride
    const float *x = nullptr, *y = nullptr, *z = nullptr;
    const uint32_t* indices = nullptr;
    const uint32_t* windings = nullptr;  ///< WindingBits of the mesh, or null
    const Material* material = nullptr;
    const Texture* colour = nullptr;
    const Texture* normal = nullptr;
    const AlphaTexture* alpha = nullptr;
    const AlphaTexture* height = nullptr;
    bool normal_like_colour = false;  ///< the two textures have the same levels and wrap alike
    uint32_t instance = 0;
    uint8_t features = 0;
    int shininess = 0;  ///< 0 = no highlight
    int mip_bias_fx8 = 0;
};

struct InstanceSetup {
    MatrixF clip;  ///< object → reversed-depth clip space
    Affine world;
    float normal[9];  ///< inverse transpose of world's 3×3, up to scale
    bool identity = true;
    bool mirrored = false;  ///< the transform turns triangles inside out
    bool moved = false;
    bool own_motion = false;            ///< moved, and the motion plane shows it
    MatrixF pixels_now, pixels_before;  ///< object → (x_px·w, y_px·w, z', w); only when moved
};

/// The light that colours are made of: all but what is sampled.
struct PlainLight {
    std::array<float, 3> ambient{};
    DirectionalLight sun{};
    std::span<const PointLight> points{};
};

struct FrameTables {
    const DrawList* list = nullptr;
    const FrameView* view = nullptr;
    PlainLight light;
    PlaneSet planes;
    bool camera_moved = false;
    Matrix reproject;  ///< (x_px, y_px, z, 1) now → (x_px·w, y_px·w, z', w) before
    const Surface* surfaces = nullptr;  ///< [0] is unused: the background
    const InstanceSetup* instances = nullptr;
};

// ---- tile stage ------------------------------------------------------------------------------

constexpr int kTilePixels = kTileSize * kTileSize;
constexpr int kBlockSize = 8;
constexpr int kBlocksPerTile = kTileSize / kBlockSize;
constexpr uint32_t kNothingVisible = 0xFFFFFFFFu;

/// Kernels may read and write this many elements behind a tile's depths.
constexpr int kTileSlack = kTileSize + kBlockSize;
/// Triangles that kernels take at once, at most: as many spare ones follow the last.
constexpr int kMaxBatch = 16;

struct Chunk;

/// Consecutive triangles of a tile that come from one chunk.
struct TileRun {
    uint32_t begin;  ///< its first triangle's place in the tile; the next run's is the end
    const Chunk* chunk;
};

/// Where a tile's pixels go: first pixel of each plane, strides in elements.
struct TilePlanes {
    uint16_t *red, *green, *blue, *id, *depth_before;
    uint16_t *albedo_red, *albedo_green, *albedo_blue;  ///< null: not wanted
    uint32_t *depth, *normal;
    /// Null: the plane is not wanted, or stays zero and depth_before is that of the depth itself.
    Motion* motion;
    ptrdiff_t stride;
};

/// A tile in work. Arrays of kTilePixels are row by row, kTileSize wide.
struct TileContext {
    const FrameTables* frame = nullptr;
    int x0 = 0, y0 = 0;  ///< of the tile in the picture
    int width = 0, height = 0;
    const TileTriangle* triangles = nullptr;  ///< in submission order
    uint32_t triangle_count = 0;
    const TileRun* runs = nullptr;  ///< in order; behind the last one is one that begins at the end
    uint32_t run_count = 0;
    bool forward = false;
    float* depth = nullptr;
    uint32_t* visible = nullptr;  ///< index into triangles (and shade), or kNothingVisible
    /// One per triangle and a spare one; filled where `shade_ready` is 1: during visibility when
    /// alpha is looked up, after it for all that are visible.
    ShadeTriangle* shade = nullptr;
    uint8_t* shade_ready = nullptr;
    uint8_t* seen = nullptr;  ///< scratch of prepareShading: one per triangle and one more
    uint8_t features = 0;     ///< union of the surfaces that may be visible
    uint32_t blocks_hidden = 0, blocks_outside = 0;  ///< counted by rasterizeTile
    uint32_t pixels_shaded = 0;                      ///< counted by prepareShading
    TilePlanes planes{};
    MatrixF reproject{};  ///< tile-local: (x, y, z, 1) → (x_local·w, y_local·w, z', w) before
};

struct RasterKernels {
    /// Fills depth and visible; in forward mode also shades into the planes.
    void (*rasterizeTile)(TileContext& tile);
    /// Fills what shadeTile reads of the visible triangles, and their features.
    void (*prepareShading)(TileContext& tile);
    /// Shades every pixel of the tile once, by `visible`.
    void (*shadeTile)(const TileContext& tile);
};

/// The plain scalar kernels that define the truth.
const RasterKernels& referenceKernels();
/// Kernels for a target of availableSimdTargets().
const RasterKernels& kernelsFor(SimdTarget target);

}  // namespace still::internal
