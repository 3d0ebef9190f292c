#include "tests/support/test_scene.h"

#include <cmath>

namespace still::test {

Instance& TestScene::addMesh() {
    Instance instance;
    instance.mesh = uint32_t(meshes.size());
    instance.object = uint16_t(instances.size() + 1);
    meshes.emplace_back();
    return instances.emplace_back(instance);
}

namespace {

void addVertex(Mesh& mesh, const TestVertex& v) {
    mesh.indices.push_back(mesh.vertexCount());
    mesh.x.push_back(v.x);
    mesh.y.push_back(v.y);
    mesh.z.push_back(v.z);
    mesh.attributes.push_back(v.attributes);
}

}  // namespace

void TestScene::addTriangle(const TestVertex& a, const TestVertex& b, const TestVertex& c,
                            uint32_t material) {
    if (meshes.empty()) {
        addMesh();
    }
    Mesh& mesh = meshes.back();
    mesh.parts.push_back({mesh.triangleCount(), 1, material});
    addVertex(mesh, a);
    addVertex(mesh, b);
    addVertex(mesh, c);
}

void TestScene::addQuad(const std::array<TestVertex, 4>& corners, uint32_t material) {
    addTriangle(corners[0], corners[1], corners[2], material);
    Mesh& mesh = meshes.back();
    const uint32_t first = mesh.vertexCount() - 3;
    mesh.parts.back().triangle_count = 2;
    addVertex(mesh, corners[3]);
    mesh.indices.back() = first;
    mesh.indices.push_back(first + 2);
    mesh.indices.push_back(first + 3);
}

DrawList TestScene::list() {
    uint16_t surface = 1;
    for (Instance& instance : instances) {
        instance.first_surface = surface;
        instance.identity = instance.transform == kIdentity;
        instance.moved = instance.transform != instance.transform_before;
        surface = uint16_t(surface + meshes[instance.mesh].parts.size());
    }
    DrawList list;
    list.meshes = meshes;
    list.materials = materials;
    list.textures = textures;
    list.alpha_textures = alpha_textures;
    list.instances = instances;
    list.lighting = lighting;
    return list;
}

TestVertex atPixel(const FrameView& view, double x_px, double y_px, double depth) {
    TestVertex v;
    v.x = float(x_px / view.width * 2 - 1);
    v.y = float(1 - y_px / view.height * 2);
    v.z = float(1 - 2 * depth);
    return v;
}

glm::dmat4 perspective(double focal, double aspect, double near, double far) {
    glm::dmat4 m(0.0);
    m[0][0] = focal / aspect;
    m[1][1] = focal;
    m[2][2] = (near + far) / (near - far);
    m[2][3] = -1;
    m[3][2] = 2 * near * far / (near - far);
    return m;
}

glm::dmat4 rigid(double turns, double x, double y, double z) {
    const double angle = turns * 6.283185307179586;
    glm::dmat4 m(1.0);
    m[0][0] = std::cos(angle);
    m[0][2] = -std::sin(angle);
    m[2][0] = std::sin(angle);
    m[2][2] = std::cos(angle);
    m[3] = {x, y, z, 1};
    return m;
}

Affine toAffine(const glm::dmat4& m) {
    Affine a;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
            a[size_t(row * 4 + column)] = float(m[column][row]);
        }
    }
    return a;
}

void draw(const DrawList& list, const FrameView& view, GBuffer& out,
          const RasterSettings& settings) {
    Workers workers(1, Schedule::serial);
    Rasterizer rasterizer;
    rasterizer.transformAndBin(list, view, settings, workers);
    rasterizer.rasterize(out, workers);
}

double Random::real(double low, double high) {
    return low + (high - low) * (double(engine_() >> 11) * 0x1p-53);
}

int Random::integer(int low, int high) {
    return low + int(engine_() % uint64_t(high - low + 1));
}

}  // namespace still::test
