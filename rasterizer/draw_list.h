#pragma once
// What the rasterizer draws: plain values, no file names, no scene graph, no clock.
// Right-handed world, +Y up by habit only; front faces are counter-clockwise but nothing is culled.

#include <array>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace still {

/// What shading reads per vertex. `u`, `v` are 0 in meshes without texture coordinates; v grows
/// upwards (OBJ convention: v = 0 is the bottom row of the image).
struct VertexAttributes {
    float nx, ny, nz;  ///< unit length, object space
    float u, v;
};

/// Only in meshes with a normal-mapped or height-mapped part: unit tangent along +u and handedness
/// (+1 or −1); bitangent = handedness · cross(normal, tangent).
struct VertexTangent {
    float x, y, z, handedness;
};

/// Consecutive triangles that share a material. Each part of each instance is one surface.
struct MeshPart {
    uint32_t first_triangle = 0;
    uint32_t triangle_count = 0;
    uint32_t material = 0;
};

/// Indexed triangles. Positions are SoA because the vertex stage streams them; attributes are AoS
/// because shading picks single vertices. All coordinates are finite; indices are in range; parts
/// cover the triangles in order without gaps.
struct Mesh {
    std::vector<float> x, y, z;
    std::vector<VertexAttributes> attributes;  ///< one per vertex
    std::vector<VertexTangent> tangents;       ///< empty, or one per vertex
    std::vector<uint32_t> indices;             ///< three per triangle
    std::vector<MeshPart> parts;

    uint32_t vertexCount() const { return uint32_t(x.size()); }
    uint32_t triangleCount() const { return uint32_t(indices.size() / 3); }
};

enum class Wrap : uint8_t { repeat, clamp };

struct TextureLevel {
    uint32_t width = 0, height = 0;
    uint32_t offset = 0;  ///< of the level's first texel in Texture::texels
    uint32_t stride = 0;  ///< from row to row: width + 2, see texture_layout.h
    friend bool operator==(const TextureLevel&, const TextureLevel&) = default;
};

/// Three 10-bit channels in a word (r in bits 0–9, g 10–19, b 20–29), row 0 at the top.
/// Colour: linear light = (c / 1023)², i.e. gamma 2.0, which keeps darks that 8-bit linear loses
/// and decodes with one multiplication. Normal map: component = c · 2/1023 − 1.
/// Level 0 is the image; each further level halves both sizes (floor, at least 1). A chain ends at
/// 1×1 or earlier: where coarser levels would be wrong, the last one is used for all distances
/// beyond. Levels have borders: made by texture_layout.h.
struct Texture {
    Wrap wrap = Wrap::repeat;
    std::vector<TextureLevel> levels;
    std::vector<uint32_t> texels;
};

/// One byte per texel, 255 = opaque (or, in height maps, highest), laid out like Texture.
struct AlphaTexture {
    Wrap wrap = Wrap::repeat;
    std::vector<TextureLevel> levels;
    std::vector<uint8_t> texels;
};

constexpr int32_t kNoTexture = -1;

enum class AlphaMode : uint8_t {
    opaque,
    test,        ///< a sample exists where alpha ≥ 0.5
    stochastic,  ///< a sample exists with probability alpha, by a hash of pixel, surface and sample
};

/// Lambert + Blinn-Phong. All colours are linear light.
struct Material {
    std::array<float, 3> diffuse{0.8f, 0.8f, 0.8f};   ///< Kd; multiplied by colour_texture
    std::array<float, 3> specular{0.0f, 0.0f, 0.0f};  ///< Ks
    std::array<float, 3> emission{0.0f, 0.0f, 0.0f};  ///< Ke, not lit, not textured
    float shininess = 10.0f;                          ///< Ns, in [1, 1024]
    float opacity = 1.0f;                             ///< d, in [0, 1]; multiplied by alpha_texture
    AlphaMode alpha_mode = AlphaMode::opaque;
    int32_t colour_texture = kNoTexture;  ///< into DrawList::textures
    int32_t normal_texture = kNoTexture;  ///< into DrawList::textures; needs tangents
    int32_t alpha_texture = kNoTexture;   ///< into DrawList::alpha_textures
    /// Into DrawList::alpha_textures, 255 = the surface itself, 0 = `height_scale` below it; needs
    /// tangents. The other textures are looked up where the view ray meets that ground (parallax);
    /// depth, silhouette and motion stay those of the flat surface.
    int32_t height_texture = kNoTexture;
    float height_scale = 0.0f;  ///< in texture coordinates: 1 = as deep as one repeat is wide
    /// Added to the interpolated texture coordinates: 1 = one repeat of the texture, v upwards.
    /// Keep it within ±1 where textures repeat, so that no precision is lost.
    float u_offset = 0.0f, v_offset = 0.0f;

    friend bool operator==(const Material&, const Material&) = default;
};

/// Affine transform, row-major 3×4: p' = M · (p, 1).
using Affine = std::array<float, 12>;
constexpr Affine kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

/// One drawn mesh. Its surfaces are first_surface … first_surface + parts − 1; surfaces are
/// numbered from 1, without gaps, in submission order. 0 is the background.
struct Instance {
    uint32_t mesh = 0;
    uint16_t object = 0;         ///< 1-based object number, for people and for id dumps
    uint16_t first_surface = 1;  ///< filled by the owner of the list
    Affine transform = kIdentity;
    Affine transform_before = kIdentity;  ///< in the previous frame
    bool identity = true;                 ///< transform is exactly kIdentity
    bool moved = false;                   ///< transform != transform_before
};

/// Surface numbers must stay below this (bit 15 of the id plane is the moved flag).
constexpr uint32_t kMaxSurfaces = 32767;

struct DirectionalLight {
    std::array<float, 3> direction{0.0f, -1.0f, 0.0f};  ///< unit, the way the light travels
    std::array<float, 3> colour{0.0f, 0.0f, 0.0f};      ///< white surface facing it gets this value
};

/// Falls off with 1/d²: a white surface facing it at distance 1 gets `colour`.
struct PointLight {
    std::array<float, 3> position{};
    std::array<float, 3> colour{};
};

/// A glowing ball. Falls off like a PointLight of this colour in its middle; casts soft shadows.
struct SphereLight {
    std::array<float, 3> position{};
    float radius = 0.0f;  ///< > 0
    std::array<float, 3> colour{};
};

/// A glowing rectangle centre ± edge_u / 2 ± edge_v / 2, which shines towards cross(edge_u,
/// edge_v). From afar and straight ahead it lights like a PointLight of this colour; casts soft
/// shadows.
struct RectangleLight {
    std::array<float, 3> centre{};
    std::array<float, 3> edge_u{}, edge_v{};  ///< perpendicular, not 0
    std::array<float, 3> colour{};
};

enum class SunShadow : uint8_t {
    none,
    mapped,  ///< from a shadow map, looked up at one random place a sample
    traced,
};

/// How much of the ambient light reaches a place.
enum class AmbientLight : uint8_t {
    plain,             ///< all
    screen_occlusion,  ///< without what the depth plane hides, at half resolution
    traced_occlusion,  ///< without what lies within occlusion_distance
    bounce,            ///< the sky's, and what the surfaces in its way reflect: one bounce
};

/// Light that needs a random sample a pixel and frame. By default there is none, and none is paid
/// for. What is in here is left out of the G-buffer's colour.
struct SampledLight {
    SunShadow sun_shadow = SunShadow::none;
    float sun_tangent = 0.0f;  ///< of half the angle that the sun's disc spans; 0 = sharp shadows
    AmbientLight ambient = AmbientLight::plain;
    float occlusion_distance = 0.0f;  ///< > 0 with AmbientLight::…_occlusion, world units
    std::vector<SphereLight> spheres{};
    std::vector<RectangleLight> rectangles{};

    bool any() const {
        return sun_shadow != SunShadow::none || ambient != AmbientLight::plain ||
               !spheres.empty() || !rectangles.empty();
    }
};

struct Lighting {
    std::array<float, 3> ambient{};
    DirectionalLight sun;
    std::vector<PointLight> points;
    SampledLight sampled{};
};

/// Of each triangle of a mesh one bit, bit t % 32 of word t / 32: its winding agrees with its
/// vertex normals, so that it is counter-clockwise seen from outside.
using WindingBits = std::vector<uint32_t>;
WindingBits windingBits(const Mesh& mesh);

/// Everything that is drawn this frame. The spans must stay valid until the frame is rasterized.
/// Submission order is instance order, then triangle order; at equal depth the first one stays.
struct DrawList {
    std::span<const Mesh> meshes;
    std::span<const Material> materials;
    std::span<const Texture> textures;
    std::span<const AlphaTexture> alpha_textures;
    std::span<const Instance> instances;
    /// windingBits() of each mesh, or empty: then they are found out for what is visible.
    std::span<const WindingBits> windings{};
    Lighting lighting;
    std::array<float, 3> background{};  ///< linear light
};

/// Camera and time of one frame.
struct FrameView {
    int width = 0, height = 0;  ///< 1 … kMaxTargetSize
    /// Projection · view, unjittered, OpenGL clip space (z in −w … w). Double, because reversed Z
    /// and reprojection are derived from them before anything is rounded to float.
    glm::dmat4 view_projection{1.0};
    glm::dmat4 view_projection_before{1.0};  ///< of the previous frame
    glm::vec3 eye{0.0f};                     ///< world position, for highlights
    /// Where in the pixel the sample is taken, from the pixel's centre, x right, y down,
    /// in 1/256 pixel, −128 … 127.
    int jitter_x_fx8 = 0, jitter_y_fx8 = 0;
    /// Index in the sample sequence; stochastic transparency draws by it.
    uint32_t sample = 0;
};

constexpr int kMaxTargetSize = 8192;

}  // namespace still
