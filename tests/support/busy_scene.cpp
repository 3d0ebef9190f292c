#include "tests/support/busy_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "rasterizer/texture_layout.h"

namespace still::test {
namespace {

std::vector<TextureLevel> chain(uint32_t width, uint32_t height, uint32_t& texels) {
    std::vector<TextureLevel> levels;
    texels = 0;
    for (;;) {
        levels.push_back({width, height, 0, 0});
        texels += width * height;
        if (width == 1 && height == 1) {
            return levels;
        }
        width = std::max(1u, width / 2);
        height = std::max(1u, height / 2);
    }
}

Texture noiseTexture(uint32_t width, uint32_t height, Wrap wrap, bool normals, Random& random) {
    Texture t;
    t.wrap = wrap;
    uint32_t count = 0;
    t.levels = chain(width, height, count);
    for (uint32_t k = 0; k < count; ++k) {
        const auto channel = [&](int low) { return uint32_t(random.integer(low, 1023)); };
        t.texels.push_back(channel(normals ? 300 : 0) | channel(normals ? 300 : 0) << 10 |
                           channel(normals ? 700 : 0) << 20);
    }
    layOut(t);
    return t;
}

AlphaTexture noiseAlpha(uint32_t width, uint32_t height, Wrap wrap, Random& random) {
    AlphaTexture t;
    t.wrap = wrap;
    uint32_t count = 0;
    t.levels = chain(width, height, count);
    for (uint32_t k = 0; k < count; ++k) {
        t.texels.push_back(uint8_t(random.integer(0, 255)));
    }
    layOut(t);
    return t;
}

std::array<float, 3> colour(Random& random, double top) {
    return {float(random.real(0, top)), float(random.real(0, top)), float(random.real(0, top))};
}

/// One material per combination of alpha mode, texture and highlight.
void addMaterials(TestScene& scene, Random& random) {
    scene.materials.clear();
    scene.textures = {noiseTexture(64, 32, Wrap::repeat, false, random),
                      noiseTexture(13, 27, Wrap::clamp, false, random),
                      noiseTexture(32, 32, Wrap::repeat, true, random)};
    scene.alpha_textures = {noiseAlpha(16, 16, Wrap::repeat, random),
                            noiseAlpha(9, 31, Wrap::clamp, random)};
    for (int k = 0; k < 24; ++k) {
        Material m;
        m.diffuse = colour(random, 1);
        m.colour_texture = k % 4 == 3 ? kNoTexture : k % 2;
        m.normal_texture = k % 3 == 1 ? 2 : kNoTexture;
        m.alpha_mode = AlphaMode(k % 8 < 4 ? 0 : k % 3);
        if (m.alpha_mode != AlphaMode::opaque) {
            m.alpha_texture = k % 3 - 1;
            m.opacity = float(random.real(0.5, 1));
        }
        if (k % 5 == 2) {
            m.specular = colour(random, 2);
            m.shininess = float(std::exp2(random.integer(0, 10)));
        }
        if (k % 7 == 0) {
            m.emission = colour(random, 12);
        }
        if (k % 6 < 2) {
            m.u_offset = 0.37f;
            m.v_offset = -0.84f;
        }
        if (k % 5 < 2) {
            m.height_texture = k % 2;
            m.height_scale = 0.05f * float(1 + k % 3);
        }
        scene.materials.push_back(m);
    }
}

TestVertex randomVertex(const glm::dvec3& centre, double size, Random& random) {
    const glm::dvec3 p =
        centre + size * glm::dvec3(random.real(-1, 1), random.real(-1, 1), random.real(-1, 1));
    const glm::dvec3 n = glm::normalize(
        glm::dvec3(random.real(-0.5, 0.5), random.real(-0.5, 0.5), random.real(0.2, 1)));
    return {
        float(p.x),
        float(p.y),
        float(p.z),
        {float(n.x), float(n.y), float(n.z), float(random.real(-3, 3)), float(random.real(-3, 3))}};
}

void addTangents(Mesh& mesh, Random& random) {
    for (const VertexAttributes& a : mesh.attributes) {
        const glm::dvec3 n(a.nx, a.ny, a.nz);
        const glm::dvec3 t = glm::normalize(glm::cross(n, glm::dvec3(0, 1, 0.1)));
        mesh.tangents.push_back(
            {float(t.x), float(t.y), float(t.z), random.integer(0, 1) == 0 ? -1.0f : 1.0f});
    }
}

void addObject(TestScene& scene, Random& random) {
    Instance& instance = scene.addMesh();
    const int motion = random.integer(0, 2);
    if (motion > 0) {
        const glm::dmat4 now = rigid(random.real(-0.1, 0.1), random.real(-1, 1), 0.1, 0.2);
        instance.transform = instance.transform_before = toAffine(now);
        if (motion == 2) {
            instance.transform_before = toAffine(rigid(0.005, 0.05, -0.02, 0.03) * now);
        }
    }
    for (int k = 0; k < 20; ++k) {
        const double z = -std::exp2(random.real(-2, 4));
        const glm::dvec3 centre(random.real(-0.8, 0.8) * -z, random.real(-0.5, 0.5) * -z, z);
        const double size = std::exp2(random.real(-5, 1));
        std::array<TestVertex, 3> v;
        for (TestVertex& vertex : v) {
            vertex = randomVertex(centre, size, random);
        }
        const int last_material = int(scene.materials.size()) - 1;
        scene.addTriangle(v[0], v[1], v[2], uint32_t(random.integer(0, last_material)));
    }
    addTangents(scene.meshes.back(), random);
}

}  // namespace

FrameView busyView(uint64_t seed) {
    Random random(seed + 9000);
    FrameView view;
    view.width = random.integer(65, 211);
    view.height = random.integer(50, 140);
    view.view_projection = perspective(1.5, double(view.width) / view.height, 0.1, 100);
    view.view_projection_before = view.view_projection * rigid(0.003, 0.02, -0.01, 0.05);
    view.jitter_x_fx8 = random.integer(-128, 127);
    view.jitter_y_fx8 = random.integer(-128, 127);
    view.sample = uint32_t(random.integer(0, 1000));
    return view;
}

TestScene busyScene(uint64_t seed) {
    Random random(seed + 7000);
    TestScene scene;
    addMaterials(scene, random);
    scene.lighting.ambient = {0.2f, 0.25f, 0.3f};
    scene.lighting.sun = {{0.6f, -0.64f, -0.48f}, {1.5f, 1.4f, 1.2f}};
    for (int k = 0; k < int(seed % 3); ++k) {
        scene.lighting.points.push_back({{float(k), 0.5f, -2.0f}, {3, 2, 1}});
    }
    for (int object = 0; object < 6; ++object) {
        addObject(scene, random);
    }
    return scene;
}

Texture levelTexture(uint32_t size, const std::vector<std::array<uint32_t, 3>>& colours,
                     Wrap wrap) {
    Texture t;
    t.wrap = wrap;
    uint32_t count = 0;
    t.levels = chain(size, size, count);
    for (size_t level = 0; level < t.levels.size(); ++level) {
        const auto& c = colours[std::min(level, colours.size() - 1)];
        t.texels.insert(t.texels.end(), size_t(t.levels[level].width) * t.levels[level].height,
                        c[0] | c[1] << 10 | c[2] << 20);
    }
    layOut(t);
    return t;
}

AlphaTexture constantAlpha(uint32_t size, uint8_t value) {
    AlphaTexture t;
    uint32_t count = 0;
    t.levels = chain(size, size, count);
    t.texels.assign(count, value);
    layOut(t);
    return t;
}

}  // namespace still::test
