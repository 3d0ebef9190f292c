// Arbitrary draw lists straight into the rasterizer. What flawOf() lets through must be drawn
// without harm, and alike by the scalar kernels and the best SIMD ones, by deferred and forward
// shading, by one and two threads.

#include <algorithm>
#include <array>
#include <cstring>
#include <glm/mat4x4.hpp>
#include <string>
#include <vector>

#include "postfx/denoise.h"
#include "rasterizer/draw_list_check.h"
#include "rasterizer/light_sampler.h"
#include "rasterizer/rasterizer.h"
#include "rasterizer/texture_layout.h"
#include "tests/fuzz/fuzz.h"

namespace {

using namespace still;
using fuzz::Bytes;
using fuzz::require;

struct OwnedList {
    std::vector<Mesh> meshes;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<AlphaTexture> alpha_textures;
    std::vector<Instance> instances;
    std::vector<WindingBits> windings;
    Lighting lighting;
    std::array<float, 3> background{};

    DrawList list() const {
        return {.meshes = meshes,
                .materials = materials,
                .textures = textures,
                .alpha_textures = alpha_textures,
                .instances = instances,
                .windings = windings,
                .lighting = lighting,
                .background = background};
    }
};

std::array<float, 3> reals(Bytes& in) {
    const float x = in.real(), y = in.real(), z = in.real();
    return {x, y, z};
}

/// Mostly what a colour is.
std::array<float, 3> colour(Bytes& in) {
    if (in.below(16) == 0) {
        return reals(in);
    }
    const uint8_t r = in.byte(), g = in.byte(), b = in.byte();
    return {float(r) / 128.0f, float(g) / 128.0f, float(b) / 128.0f};
}

/// One of `count`, seldom none of them.
uint32_t choice(Bytes& in, size_t count) {
    const uint8_t byte = in.byte();
    return byte >= 0xFC || count == 0 ? uint32_t{byte} << 24 | byte : byte % uint32_t(count);
}

int32_t textureChoice(Bytes& in, size_t count) {
    return in.flag() ? int32_t(choice(in, count)) : kNoTexture;
}

template <class AnyTexture>
AnyTexture texture(Bytes& in) {
    using Texel = typename decltype(AnyTexture::texels)::value_type;
    AnyTexture made;
    made.wrap = in.flag() ? Wrap::repeat : Wrap::clamp;
    uint32_t width = 1 + uint32_t(in.below(9)), height = 1 + uint32_t(in.below(9));
    const int levels = 1 + in.below(4);
    uint32_t seed = in.word();
    for (int k = 0; k < levels; ++k) {
        made.levels.push_back({width, height, 0, 0});
        for (uint32_t i = 0; i < width * height; ++i) {
            seed = seed * 1664525u + 1013904223u;
            made.texels.push_back(Texel(seed >> 2));
        }
        width = std::max(width / 2, 1u);
        height = std::max(height / 2, 1u);
    }
    layOut(made);
    if (in.byte() == 255) {  // now and then one that is not laid out
        made.levels[in.byte() % made.levels.size()].offset += in.byte();
    }
    return made;
}

Material material(Bytes& in, const OwnedList& list) {
    Material m;
    const uint8_t kind = in.byte();
    m.diffuse = colour(in);
    if ((kind & 1) != 0) {
        m.specular = colour(in);
        m.shininess = float(1 + in.byte() * 4);
    }
    if ((kind & 2) != 0) {
        m.emission = colour(in);
    }
    m.alpha_mode = AlphaMode(kind >> 2 & 3);
    m.opacity = float(in.byte()) / 255.0f;
    m.colour_texture = textureChoice(in, list.textures.size());
    m.normal_texture = textureChoice(in, list.textures.size());
    m.alpha_texture = textureChoice(in, list.alpha_textures.size());
    m.height_texture = textureChoice(in, list.alpha_textures.size());
    m.height_scale = float(in.byte()) / 255.0f;
    m.u_offset = (kind & 16) != 0 ? in.real() : 0.0f;
    m.v_offset = (kind & 32) != 0 ? in.real() : 0.0f;
    return m;
}

Mesh mesh(Bytes& in, size_t materials) {
    Mesh m;
    const int vertices = (3 + in.below(18)) % 20;
    const bool tangents = in.below(8) != 7;
    for (int i = 0; i < vertices; ++i) {
        const std::array<float, 3> p = reals(in);
        m.x.push_back(p[0]);
        m.y.push_back(p[1]);
        m.z.push_back(p[2]);
        const uint8_t n = in.byte();
        const float u = in.real(), v = in.real();
        const auto axis = [n](int third) { return float(n / third % 3) - 1.0f; };
        m.attributes.push_back({axis(1), axis(3), n == 255 ? in.real() : axis(9), u, v});
        if (tangents) {
            m.tangents.push_back({axis(27), 0.0f, 1.0f, (n & 1) != 0 ? 1.0f : -1.0f});
        }
    }
    const int parts = (1 + in.below(4)) % 4;
    for (int i = 0; i < parts; ++i) {
        const uint32_t first = m.triangleCount();
        const uint32_t triangles = uint32_t(1 + in.below(12)) % 12;
        for (uint32_t k = 0; k < triangles * 3; ++k) {
            m.indices.push_back(choice(in, m.x.size()));
        }
        m.parts.push_back({first, triangles, choice(in, materials)});
    }
    return m;
}

Affine affine(Bytes& in) {
    Affine a = kIdentity;
    const uint8_t kind = in.byte();
    for (size_t i = 0; i < a.size(); ++i) {
        if (i % 4 == 3 ? (kind & 1) != 0 : (kind & 2) != 0) {
            a[i] = in.real();
        }
    }
    return a;
}

Instance instance(Bytes& in, size_t meshes) {
    Instance made;
    const uint8_t kind = in.byte();
    made.mesh = kind == 255 ? 63 : kind % uint32_t(meshes);
    made.transform = (kind & 16) != 0 ? affine(in) : kIdentity;
    made.transform_before = (kind & 32) != 0 ? affine(in) : made.transform;
    made.identity = made.transform == kIdentity;
    made.moved = made.transform != made.transform_before;
    return made;
}

void numberSurfaces(OwnedList& list) {
    uint32_t surface = 1;
    for (Instance& each : list.instances) {
        each.first_surface = uint16_t(surface);
        surface +=
            each.mesh < list.meshes.size() ? uint32_t(list.meshes[each.mesh].parts.size()) : 0;
    }
}

Lighting lighting(Bytes& in) {
    Lighting light;
    const uint8_t kind = in.byte();
    light.ambient = colour(in);
    light.sun.colour = colour(in);
    light.sun.direction =
        (kind & 1) != 0 ? std::array{0.6f, -0.8f, 0.0f} : std::array{0.0f, 0.0f, -1.0f};
    for (int i = 0; i < (kind >> 1 & 1); ++i) {
        light.points.push_back({reals(in), colour(in)});
    }
    if ((kind & 0x60) != 0x60) {  // one in four has sampled light
        return light;
    }
    light.sampled.sun_shadow = SunShadow(in.below(3));
    light.sampled.sun_tangent = float(in.below(64)) / 64.0f;
    light.sampled.ambient = AmbientLight(in.below(4));
    light.sampled.occlusion_distance = 0.25f + float(in.byte());
    if (in.flag()) {
        light.sampled.spheres.push_back({reals(in), 0.01f + float(in.byte()), colour(in)});
    }
    if (in.flag()) {
        const float size = 0.01f + float(in.byte());
        light.sampled.rectangles.push_back({reals(in), {size, 0, 0}, {0, 0, size}, colour(in)});
    }
    return light;
}

void hold(float& value, float limit) {
    value = value != value ? 0.0f : std::clamp(value, -limit, limit);
}

void hold(std::array<float, 3>& values, float low, float high) {
    for (float& value : values) {
        value = value != value ? low : std::clamp(value, low, high);
    }
}

void repair(Mesh& mesh, size_t materials) {
    for (std::vector<float>* axis : {&mesh.x, &mesh.y, &mesh.z}) {
        for (float& value : *axis) {
            hold(value, kMaxPosition);
        }
    }
    for (VertexAttributes& a : mesh.attributes) {
        hold(a.nz, 1.0f);
        hold(a.u, kMaxTexcoord);
        hold(a.v, kMaxTexcoord);
    }
    const auto vertices = uint32_t(mesh.x.size());
    for (uint32_t& index : mesh.indices) {
        index %= std::max(vertices, 1u);
    }
    if (vertices == 0) {
        mesh.indices.clear();
        mesh.parts.clear();
    }
    mesh.tangents.resize(vertices, {1, 0, 0, 1});
    for (MeshPart& part : mesh.parts) {
        part.material %= uint32_t(materials);
    }
}

/// Puts right what flawOf() would stumble over, so that more than refusals is tried.
void repair(OwnedList& list) {
    for (Mesh& mesh : list.meshes) {
        repair(mesh, list.materials.size());
    }
    const auto holdTexture = [](int32_t& texture, size_t count) {
        texture = texture < 0 || texture >= int32_t(count) ? kNoTexture : texture;
    };
    for (Material& m : list.materials) {
        for (std::array<float, 3>* colour : {&m.diffuse, &m.specular, &m.emission}) {
            hold(*colour, 0.0f, kMaxColour);
        }
        m.alpha_mode = std::min(m.alpha_mode, AlphaMode::stochastic);
        hold(m.u_offset, kMaxTextureOffset);
        hold(m.v_offset, kMaxTextureOffset);
        holdTexture(m.colour_texture, list.textures.size());
        holdTexture(m.normal_texture, list.textures.size());
        holdTexture(m.alpha_texture, list.alpha_textures.size());
        holdTexture(m.height_texture, list.alpha_textures.size());
    }
    for (PointLight& light : list.lighting.points) {
        hold(light.position, -kMaxPosition, kMaxPosition);
        hold(light.colour, 0.0f, kMaxColour);
    }
    hold(list.lighting.ambient, 0.0f, kMaxColour);
    hold(list.lighting.sun.colour, 0.0f, kMaxColour);
    hold(list.background, 0.0f, kMaxColour);
}

/// What decides about the most comes first, for inputs may be short.
OwnedList drawList(Bytes& in) {
    OwnedList list;
    const uint8_t counts = in.byte();
    list.lighting = lighting(in);
    list.background = colour(in);
    const size_t meshes = 1 + (counts >> 5 & 1);
    for (int i = (counts >> 6) + 1; i > 0; --i) {
        list.instances.push_back(instance(in, meshes));
    }
    for (size_t i = 0; i < meshes; ++i) {
        list.meshes.push_back(mesh(in, 1 + (counts >> 3 & 3)));
    }
    for (int i = 0; i < (counts & 3); ++i) {
        list.textures.push_back(texture<Texture>(in));
    }
    for (int i = 0; i < (counts >> 2 & 1); ++i) {
        list.alpha_textures.push_back(texture<AlphaTexture>(in));
    }
    for (int i = 0; i < 1 + (counts >> 3 & 3); ++i) {
        list.materials.push_back(material(in, list));
    }
    return list;
}

glm::dmat4 projection(Bytes& in) {
    glm::dmat4 m(1.0);
    const int kind = in.below(4);
    if (kind == 0) {
        return m;
    }
    if (kind == 3) {
        for (int i = 0; i < 16; ++i) {
            m[i / 4][i % 4] = double(in.real());
        }
        return m;
    }
    // Near 0.1, far 1000, from a little behind the origin.
    m = glm::dmat4(0.0);
    m[0][0] = m[1][1] = kind == 1 ? 1.7 : double(in.real());
    m[2][2] = -1.0002;
    m[2][3] = -1;
    m[3][2] = -0.20002;
    glm::dmat4 view(1.0);
    view[3][0] = double(in.real());
    view[3][1] = double(in.real());
    view[3][2] = -2.0 + double(in.real());
    return m * view;
}

FrameView frameView(Bytes& in) {
    FrameView view;
    const bool large = in.below(4) == 0;
    view.width = large ? 1 + in.below(70) : 1 + in.below(20);
    view.height = large ? 1 + in.below(40) : 1 + in.below(12);
    view.view_projection = projection(in);
    view.view_projection_before = in.flag() ? projection(in) : view.view_projection;
    const std::array<float, 3> eye = reals(in);
    view.eye = {eye[0], eye[1], eye[2]};
    view.jitter_x_fx8 = int8_t(in.byte());
    view.jitter_y_fx8 = int8_t(in.byte());
    view.sample = in.word();
    return view;
}

/// Everything a frame consists of.
struct Drawn {
    GBuffer gbuffer;
    Image<uint16_t> overdraw;
    LightImages light;
};

struct Way {
    RasterSettings settings;
    Workers* workers = nullptr;
};

void draw(const DrawList& list, const FrameView& view, const Way& way, Drawn& out) {
    Rasterizer rasterizer;
    rasterizer.transformAndBin(list, view, way.settings, *way.workers);
    rasterizer.rasterize(out.gbuffer, *way.workers);
    out.overdraw.resize(view.width, view.height);
    rasterizer.overdraw(out.overdraw.view(), *way.workers);
    if (list.lighting.sampled.any()) {
        LightSampler sampler;
        sampler.setUp(list, view, way.settings.simd, *way.workers);
        sampler.sample(out.gbuffer, out.light, true, *way.workers);
    }
}

template <class T>
void compare(const Image<T>& a, const Image<T>& b, const char* plane) {
    require(a.width() == b.width() && a.height() == b.height(), plane);
    for (int y = 0; y < a.height(); ++y) {
        const T* p = a.view().row(y);
        const T* q = b.view().row(y);
        for (int x = 0; x < a.width(); ++x) {
            if (std::memcmp(p + x, q + x, sizeof(T)) != 0) {
                require(false, std::string(plane) + " differs at (" + std::to_string(x) + ", " +
                                   std::to_string(y) + ")");
            }
        }
    }
}

void compare(const Drawn& a, const Drawn& b) {
    compare(a.gbuffer.depth, b.gbuffer.depth, "depth");
    compare(a.gbuffer.id, b.gbuffer.id, "id");
    compare(a.overdraw, b.overdraw, "overdraw");
    compare(a.gbuffer.normal, b.gbuffer.normal, "normal");
    compare(a.gbuffer.motion, b.gbuffer.motion, "motion");
    compare(a.gbuffer.depth_before, b.gbuffer.depth_before, "depth_before");
    compare(a.gbuffer.albedo_red, b.gbuffer.albedo_red, "albedo");
    compare(a.light.direct_red, b.light.direct_red, "direct light");
    compare(a.light.indirect_red, b.light.indirect_red, "indirect light");
    compare(a.gbuffer.red, b.gbuffer.red, "red");
    compare(a.gbuffer.green, b.gbuffer.green, "green");
    compare(a.gbuffer.blue, b.gbuffer.blue, "blue");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    static Workers one(1), two(2);
    Bytes in({data, size});
    const uint8_t how = in.byte();
    RasterSettings settings;
    settings.simd = SimdTarget::scalar;
    settings.mip_bias_fx8 = (how & 1) != 0 ? (int(in.byte()) - 128) * 32 : 0;
    settings.camera_motion_only = (how & 2) != 0;
    const FrameView view = frameView(in);
    OwnedList owned = drawList(in);
    if ((how & 0x80) == 0) {
        repair(owned);
    }
    numberSurfaces(owned);
    settings.planes = {
        .normal = true, .motion = true, .albedo = (how & 4) != 0 || owned.lighting.sampled.any()};
    if (flawOf(owned.list()) != nullptr) {
        return 0;
    }
    Way other{settings, &one};
    (how & 8) != 0 ? void(other.workers = &two) : void(other.settings.simd = bestSimdTarget());
    if ((how & 0x30) == 0x30) {
        other.settings.shading = Shading::forward;
    }
    Drawn expected, got;
    draw(owned.list(), view, {settings, &one}, expected);
    if ((how & 0x40) != 0) {
        for (const Mesh& each : owned.meshes) {
            owned.windings.push_back(windingBits(each));
        }
    }
    draw(owned.list(), view, other, got);
    compare(expected, got);
    return 0;
}
