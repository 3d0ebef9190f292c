// Rays against trees: a loop over all triangles in double is the oracle.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "rasterizer/internal/light_setup.h"
#include "rasterizer/texture_layout.h"
#include "tests/support/test_scene.h"

using namespace still;
using namespace still::test;
using namespace still::internal;

namespace {

TestVertex vertexAt(double x, double y, double z) {
    return {float(x), float(y), float(z), {0, 0, 1, 0, 0}};
}

void addRandomTriangle(TestScene& scene, double size, Random& random) {
    const double x = random.real(-1, 1), y = random.real(-1, 1), z = random.real(-1, 1);
    const auto corner = [&] {
        return vertexAt(x + random.real(-size, size), y + random.real(-size, size),
                        z + random.real(-size, size));
    };
    scene.addTriangle(corner(), corner(), corner());
}

/// Soups of triangles, one of them turned, stretched and mirrored.
TestScene soups(uint64_t seed) {
    Random random(seed);
    TestScene scene;
    for (int mesh = 0; mesh < 4; ++mesh) {
        Instance& instance = scene.addMesh();
        if (mesh > 0) {
            glm::dmat4 m = rigid(random.real(0, 1), random.real(-2, 2), random.real(-2, 2),
                                 random.real(-2, 2));
            m[0] *= random.real(0.3, 2);
            m[1] *= mesh == 2 ? -1.5 : 0.7;
            instance.transform = toAffine(m);
            instance.identity = false;
        }
        for (int i = 0; i < (mesh == 3 ? 1 : 300); ++i) {
            addRandomTriangle(scene, mesh == 1 ? 0.05 : 0.3, random);
        }
    }
    // A floor in the plane of two axes: its box is flat.
    scene.addMesh();
    scene.addQuad(
        {vertexAt(-3, -2, -3), vertexAt(3, -2, -3), vertexAt(3, -2, 3), vertexAt(-3, -2, 3)});
    return scene;
}

Ray randomRay(Random& random) {
    Ray ray{};
    for (int k = 0; k < 3; ++k) {
        ray.origin[k] = float(random.real(-3, 3));
        const int kind = random.integer(0, 9);
        ray.direction[k] = kind == 0   ? 0.0f
                           : kind == 1 ? float(random.integer(-1, 1))
                                       : float(random.real(-1, 1));
    }
    if (ray.direction[0] == 0.0f && ray.direction[1] == 0.0f && ray.direction[2] == 0.0f) {
        ray.direction[1] = -1.0f;
    }
    ray.end = random.integer(0, 1) == 0 ? 1e30f : float(random.real(0.1, 4));
    return ray;
}

struct Oracle {
    double nearest = 1e300;   ///< of the hits that rounding cannot undo
    double earliest = 1e300;  ///< of those and of what may or may not be hit
};

glm::dvec3 worldCorner(const DrawList& list, const Instance& instance, uint32_t vertex) {
    const Mesh& mesh = list.meshes[instance.mesh];
    const double p[3] = {mesh.x[vertex], mesh.y[vertex], mesh.z[vertex]};
    glm::dvec3 q;
    for (int r = 0; r < 3; ++r) {
        const float* m = &instance.transform[size_t(r) * 4];
        q[r] = m[0] * p[0] + m[1] * p[1] + m[2] * p[2] + m[3];
    }
    return q;
}

double sixVolumes(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
    return a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) +
           a.z * (b.x * c.y - b.y * c.x);
}

Oracle bruteForce(const DrawList& list, const Ray& ray) {
    constexpr double kUnsure = 1e-4;
    const glm::dvec3 o(ray.origin[0], ray.origin[1], ray.origin[2]);
    const glm::dvec3 d(ray.direction[0], ray.direction[1], ray.direction[2]);
    Oracle oracle;
    for (const Instance& instance : list.instances) {
        const Mesh& mesh = list.meshes[instance.mesh];
        for (size_t t = 0; t < mesh.triangleCount(); ++t) {
            glm::dvec3 p[3];
            for (size_t c = 0; c < 3; ++c) {
                p[c] = worldCorner(list, instance, mesh.indices[t * 3 + c]) - o;
            }
            const double det = sixVolumes(p[1] - p[0], p[2] - p[0], d);
            if (std::fabs(det) < 1e-9) {
                // Seen from its edge: anything may come out.
                oracle.earliest = -1e300;
                continue;
            }
            const double b[3] = {sixVolumes(p[1], p[2], d) / det, sixVolumes(p[2], p[0], d) / det,
                                 sixVolumes(p[0], p[1], d) / det};
            const double least = std::min({b[0], b[1], b[2]});
            const double at = sixVolumes(p[0], p[1], p[2]) / det;
            if (least > -kUnsure && at > -kUnsure && at < double(ray.end) * (1 + kUnsure)) {
                oracle.earliest = std::min(oracle.earliest, at);
                if (least > kUnsure && at > kUnsure && at < double(ray.end) * (1 - kUnsure)) {
                    oracle.nearest = std::min(oracle.nearest, at);
                }
            }
        }
    }
    return oracle;
}

struct Traced {
    std::vector<uint8_t> blocked;
    std::vector<RayHit> hits;
};

Traced traceAll(const SceneTree& tree, const std::vector<Ray>& rays, SimdTarget target) {
    Traced traced;
    traced.blocked.resize(rays.size());
    traced.hits.resize(rays.size());
    const TraceKernels kernels = traceFor(target);
    kernels.occluded(tree, rays.data(), int(rays.size()), traced.blocked.data());
    kernels.closest(tree, rays.data(), int(rays.size()), traced.hits.data());
    return traced;
}

std::vector<Ray> randomRays(int count, uint64_t seed) {
    Random random(seed);
    std::vector<Ray> rays;
    for (int i = 0; i < count; ++i) {
        rays.push_back(randomRay(random));
    }
    return rays;
}

}  // namespace

TEST_CASE("trace: rays hit what a loop over all triangles hits") {
    for (uint64_t seed = 0; seed < 4; ++seed) {
        TestScene scene = soups(seed);
        const DrawList list = scene.list();
        Workers workers(1);
        SceneTree tree;
        TreeKeeper keeper;
        keeper.update(list, tree, workers);
        const std::vector<Ray> rays = randomRays(3000, seed + 100);
        const Traced traced = traceAll(tree, rays, SimdTarget::scalar);
        int sure_hits = 0, sure_misses = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            const Oracle oracle = bruteForce(list, rays[i]);
            const bool hit = traced.hits[i].instance != kNothingHit;
            CAPTURE(seed, i, oracle.nearest, oracle.earliest);
            REQUIRE(hit == (traced.blocked[i] != 0));
            if (oracle.nearest < 1e300) {
                ++sure_hits;
                REQUIRE(hit);
                REQUIRE(double(traced.hits[i].t) < oracle.nearest + 2e-4);
            }
            if (oracle.earliest == 1e300) {
                ++sure_misses;
                REQUIRE_FALSE(hit);
            } else if (hit && oracle.earliest > -1) {
                REQUIRE(double(traced.hits[i].t) > oracle.earliest - 2e-4);
            }
        }
        CHECK(sure_hits > 500);
        CHECK(sure_misses > 300);
    }
}

TEST_CASE("trace: every target finds the very same hits", "[determinism]") {
    TestScene scene = soups(7);
    const DrawList list = scene.list();
    Workers workers(1);
    SceneTree tree;
    TreeKeeper keeper;
    keeper.update(list, tree, workers);
    const std::vector<Ray> rays = randomRays(20000, 8);
    const Traced expected = traceAll(tree, rays, SimdTarget::scalar);
    for (SimdTarget target : availableSimdTargets()) {
        const Traced traced = traceAll(tree, rays, target);
        CAPTURE(name(target));
        CHECK(traced.blocked == expected.blocked);
        CHECK(std::memcmp(traced.hits.data(), expected.hits.data(), rays.size() * sizeof(RayHit)) ==
              0);
    }
}

TEST_CASE("trace: rays that are traced together are blocked as they are alone", "[determinism]") {
    TestScene scene = soups(11);
    scene.materials.resize(2);
    scene.materials[1].alpha_mode = AlphaMode::stochastic;
    scene.materials[1].opacity = 0.5f;
    Random random(12);
    for (Mesh& mesh : scene.meshes) {
        for (MeshPart& part : mesh.parts) {
            part.material = uint32_t(random.integer(0, 1));
        }
    }
    const DrawList list = scene.list();
    Workers workers(1);
    SceneTree tree;
    TreeKeeper keeper;
    keeper.update(list, tree, workers);
    // Bundles of any number of rays, narrow ones and wide ones.
    for (int bundle = 0; bundle < 600; ++bundle) {
        const Ray first = randomRay(random);
        const float width = float(random.real(0, 1)) * float(random.integer(0, 1)) + 0.01f;
        std::vector<Ray> rays(size_t(random.integer(1, 40)), first);
        for (Ray& ray : rays) {
            for (int k = 0; k < 3; ++k) {
                ray.origin[k] += width * float(random.real(-1, 1));
                ray.direction[k] += width * float(random.real(-1, 1));
            }
            ray.random = uint32_t(random.integer(0, 1 << 30));
        }
        std::vector<uint8_t> alone(rays.size()), together(rays.size());
        traceReference().occluded(tree, rays.data(), int(rays.size()), alone.data());
        for (SimdTarget target : availableSimdTargets()) {
            traceFor(target).occludedTogether(tree, rays.data(), int(rays.size()), together.data());
            CAPTURE(bundle, name(target));
            REQUIRE(together == alone);
        }
    }
}

TEST_CASE("trace: no ray slips between triangles that share an edge") {
    // A bumpy ball around the origin; rays go to its corners and to points on its edges.
    constexpr int kAround = 24, kUp = 12;
    Random random(3);
    std::vector<TestVertex> grid;
    for (int j = 0; j <= kUp; ++j) {
        for (int i = 0; i < kAround; ++i) {
            const double a = 6.283185307179586 * i / kAround, b = 3.141592653589793 * j / kUp;
            const bool pole = j == 0 || j == kUp;
            const double r = pole ? 1.0 : random.real(0.8, 1.2);
            const double s = pole ? 0.0 : std::sin(b);
            grid.push_back(vertexAt(r * s * std::cos(a), r * std::cos(b), r * s * std::sin(a)));
        }
    }
    TestScene scene;
    scene.addMesh();
    const auto at = [&](int j, int i) { return grid[size_t(j * kAround + i % kAround)]; };
    std::vector<Ray> rays;
    const auto aim = [&](const TestVertex& a, const TestVertex& b, float f) {
        Ray ray{};
        ray.end = 1e30f;
        ray.direction[0] = a.x + (b.x - a.x) * f;
        ray.direction[1] = a.y + (b.y - a.y) * f;
        ray.direction[2] = a.z + (b.z - a.z) * f;
        for (float& o : ray.origin) {
            o = float(random.real(-0.01, 0.01));
        }
        rays.push_back(ray);
        for (float& o : ray.origin) {
            o = 0.0f;
        }
        rays.push_back(ray);
    };
    for (int j = 0; j < kUp; ++j) {
        for (int i = 0; i < kAround; ++i) {
            scene.addTriangle(at(j, i), at(j, i + 1), at(j + 1, i));
            scene.addTriangle(at(j, i + 1), at(j + 1, i + 1), at(j + 1, i));
            for (float f : {0.0f, 0.25f, 0.3333f, 0.5f, 0.9f}) {
                aim(at(j, i), at(j, i + 1), f);
                aim(at(j, i), at(j + 1, i), f);
                aim(at(j, i + 1), at(j + 1, i), f);
            }
        }
    }
    const DrawList list = scene.list();
    Workers workers(1);
    SceneTree tree;
    TreeKeeper keeper;
    keeper.update(list, tree, workers);
    for (SimdTarget target : availableSimdTargets()) {
        const Traced traced = traceAll(tree, rays, target);
        CAPTURE(name(target));
        CHECK(std::count(traced.blocked.begin(), traced.blocked.end(), 0) == 0);
    }
}

TEST_CASE("trace: no tree is too deep for the stack of those who walk through it") {
    // Each triangle is much smaller than the one before, around one point, and many are the same.
    TestScene scene;
    scene.addMesh();
    double size = 1e6;
    for (int i = 0; i < 3000; ++i) {
        size = i % 2 == 0 && size > 1e-30 ? size * 0.93 : size;
        scene.addTriangle(vertexAt(0, 0, 0), vertexAt(size, size * 0.1, 0),
                          vertexAt(0, size, size * 0.2));
    }
    const DrawList list = scene.list();
    Workers workers(1);
    SceneTree tree;
    TreeKeeper keeper;
    keeper.update(list, tree, workers);
    const auto depthOf = [&](const auto& self, const std::vector<BvhNode>& nodes,
                             uint32_t at) -> int {
        int deepest = 0;
        for (uint32_t child : nodes[at].child) {
            if ((child & kLeafBit) == 0) {
                deepest = std::max(deepest, self(self, nodes, child));
            }
        }
        return deepest + 1;
    };
    const auto& nodes = tree.instances[0].tree->nodes;
    CHECK(2 * 7 * depthOf(depthOf, nodes, 0) + 2 * kTreeWidth < kTraceStack);
}

TEST_CASE("trace: of equal distances the first instance and the first triangle count") {
    TestScene scene;
    for (int mesh = 0; mesh < 3; ++mesh) {
        scene.addMesh();
        for (int i = 0; i < 20; ++i) {
            scene.addTriangle(vertexAt(-1, -1, mesh == 0 ? 1 : 2),
                              vertexAt(3, -1, mesh == 0 ? 1 : 2),
                              vertexAt(-1, 3, mesh == 0 ? 1 : 2));
        }
    }
    const DrawList list = scene.list();
    Workers workers(1);
    SceneTree tree;
    TreeKeeper keeper;
    keeper.update(list, tree, workers);
    Ray ray{{0.1f, 0.2f, 4.0f}, 1e30f, {0.01f, 0.02f, -1.0f}, 0};
    RayHit hit;
    traceReference().closest(tree, &ray, 1, &hit);
    CHECK(hit.instance == 1);
    CHECK(hit.triangle == 0);
}

TEST_CASE("trace: the tree follows instances that move, and holds none that is flat") {
    TestScene scene;
    Instance& instance = scene.addMesh();
    instance.identity = false;
    scene.addTriangle(vertexAt(-1, -1, 0), vertexAt(1, -1, 0), vertexAt(0, 1, 0));
    Workers workers(1);
    SceneTree tree;
    TreeKeeper keeper;
    const auto hitAt = [&](double x) {
        const DrawList list = scene.list();
        keeper.update(list, tree, workers);
        const Ray ray{{float(x), 0.0f, 5.0f}, 1e30f, {0.0f, 0.0f, -1.0f}, 0};
        uint8_t blocked = 0;
        traceReference().occluded(tree, &ray, 1, &blocked);
        return blocked != 0;
    };
    for (double x : {0.0, 7.5, -100.0}) {
        scene.instances[0].transform = toAffine(rigid(0.1, x, 0, 0));
        CHECK(hitAt(x));
        CHECK_FALSE(hitAt(x + 2));
    }
    scene.instances[0].transform = Affine{};
    CHECK_FALSE(hitAt(0));
}

TEST_CASE("trace: rays pass through the holes of alpha-tested and stochastic surfaces") {
    TestScene scene;
    scene.materials.resize(3);
    scene.alpha_textures.resize(1);
    AlphaTexture& mask = scene.alpha_textures[0];
    mask.wrap = Wrap::repeat;
    mask.levels.push_back({.width = 2, .height = 1});
    mask.texels = {255, 0};  // the left half is there
    layOut(mask);
    scene.materials[1].alpha_mode = AlphaMode::test;
    scene.materials[1].alpha_texture = 0;
    scene.materials[2].alpha_mode = AlphaMode::stochastic;
    scene.materials[2].opacity = 0.25f;
    scene.addMesh();
    const auto quad = [&](float z, uint32_t material) {
        scene.addQuad({TestVertex{0, 0, z, {0, 0, 1, 0, 0}}, TestVertex{1, 0, z, {0, 0, 1, 1, 0}},
                       TestVertex{1, 1, z, {0, 0, 1, 1, 1}}, TestVertex{0, 1, z, {0, 0, 1, 0, 1}}},
                      material);
    };
    quad(0.0f, 1);
    quad(-10.0f, 2);
    const DrawList list = scene.list();
    Workers workers(1);
    SceneTree tree;
    TreeKeeper keeper;
    keeper.update(list, tree, workers);
    const auto blockedShare = [&](float x, float z) {
        int count = 0;
        for (uint32_t i = 0; i < 4000; ++i) {
            const Ray ray{{x, 0.4f, z}, 5.0f, {0.0f, 0.0f, -1.0f}, i * 0x9E3779B9u};
            uint8_t blocked = 0;
            traceReference().occluded(tree, &ray, 1, &blocked);
            count += blocked;
        }
        return count / 4000.0;
    };
    CHECK(blockedShare(0.25f, 1.0f) == 1.0);
    CHECK(blockedShare(0.75f, 1.0f) == 0.0);
    CHECK(blockedShare(0.25f, -9.0f) == Approx(0.25).margin(0.02));
}
