// Random pictures through the oracle and through every way the fast rasterizer has; and the tool
// that makes failing ones small, on rasterizers that are wrong.

#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/support/busy_scene.h"
#include "tests/support/oracle_compare.h"
#include "tests/support/plane_compare.h"
#include "tests/support/property.h"
#include "tests/support/random_triangles.h"

using namespace still;
using namespace still::test;

namespace {

/// Several triangles to a part, several materials, as meshes have them.
void joinParts(Mesh& mesh, uint32_t materials, Random& random) {
    std::vector<MeshPart> joined;
    for (const MeshPart& part : mesh.parts) {
        if (!joined.empty() && random.integer(0, 2) > 0) {
            joined.back().triangle_count += part.triangle_count;
        } else {
            joined.push_back(part);
            joined.back().material = uint32_t(random.integer(0, int(materials) - 1));
        }
    }
    mesh.parts = joined;
}

/// Opaque triangles of all kinds, in the plane or in space, of one to five instances.
DrawCase opaqueCase(uint64_t seed) {
    Random random(seed);
    DrawCase made;
    const bool flat = random.integer(0, 1) == 0;
    const int width = random.integer(1, 150), height = random.integer(1, 90);
    made.view = flat ? flatView(width, height, random) : deepView(width, height, random);
    TestScene& scene = made.scene;
    scene.materials.resize(4);
    scene.materials[1].diffuse = {0.9f, 0.1f, 0.2f};
    scene.materials[2].specular = {1, 1, 1};
    const int instances = random.integer(1, 5);
    for (int i = 0; i < instances; ++i) {
        Instance& instance = scene.addMesh();
        if (!flat && random.integer(0, 1) == 0) {
            const glm::dmat4 place =
                rigid(random.real(0, 1), random.real(-1, 1), 0, random.real(-6, 0));
            instance.transform = toAffine(place);
            instance.transform_before = toAffine(place * rigid(0.003, 0.02, 0, 0));
        }
        const int triangles = random.integer(1, 25);
        for (int k = 0; k < triangles; ++k) {
            if (flat) {
                const size_t kind = size_t(random.integer(0, int(kFlatKinds.size()) - 1));
                addFlat(scene, made.view, kFlatKinds[kind], random);
            } else {
                const size_t kind = size_t(random.integer(0, int(kDeepKinds.size()) - 1));
                addDeep(scene, kDeepKinds[kind], random);
            }
        }
        joinParts(scene.meshes.back(), 4, random);
    }
    return made;
}

/// Everything at once: textures, alpha tests, lights, motion.
DrawCase busyCase(uint64_t seed) {
    return {busyScene(seed), busyView(seed)};
}

std::string compareToOracle(DrawCase& c) {
    const DrawList list = c.scene.list();
    GBuffer fast;
    draw(list, c.view, fast);
    return differenceToOracle(list, c.view, fast);
}

/// Every kernel, order and way of shading against the scalar kernels in order.
std::string compareKernels(DrawCase& c) {
    const DrawList list = c.scene.list();
    GBuffer expected;
    draw(list, c.view, expected, {.simd = SimdTarget::scalar, .planes = kAllPlanes});
    for (SimdTarget target : availableSimdTargets()) {
        for (Shading shading : {Shading::deferred, Shading::forward}) {
            Workers workers(1, Schedule::shuffled, 3);
            Rasterizer rasterizer;
            GBuffer out;
            rasterizer.transformAndBin(
                list, c.view, {.simd = target, .shading = shading, .planes = kAllPlanes}, workers);
            rasterizer.rasterize(out, workers);
            const std::string difference = firstDifference(expected, out);
            if (!difference.empty()) {
                return std::string(name(target)) +
                       (shading == Shading::forward ? ", forward: " : ": ") + difference;
            }
        }
    }
    return {};
}

}  // namespace

TEST_CASE("property: of random pictures the oracle sees the same surfaces", "[property]") {
    CHECK(counterexample(seeds(1, 150), opaqueCase, compareToOracle) == "");
}

TEST_CASE("property: of random pictures all kernels, orders and ways of shading draw the same",
          "[property]") {
    CHECK(counterexample(seeds(1, 40), opaqueCase, compareKernels) == "");
    CHECK(counterexample(seeds(100, 10), busyCase, compareKernels) == "");
}

TEST_CASE("property: thousands of random pictures", "[property][slow]") {
    CHECK(counterexample(seeds(10000, 10000), opaqueCase, compareToOracle) == "");
    CHECK(counterexample(seeds(10000, 3000), opaqueCase, compareKernels) == "");
    CHECK(counterexample(seeds(10000, 1000), busyCase, compareKernels) == "");
}

namespace {

/// The fast rasterizer, but as if it culled what is seen from behind.
std::string compareCulling(DrawCase& c) {
    DrawCase culled = c;
    const glm::dmat4& m = c.view.view_projection;
    for (Mesh& mesh : culled.scene.meshes) {
        for (size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
            std::array<glm::dvec2, 3> at;
            for (size_t k = 0; k < 3; ++k) {
                const uint32_t v = mesh.indices[t + k];
                const glm::dvec4 clip = m * glm::dvec4(mesh.x[v], mesh.y[v], mesh.z[v], 1);
                at[k] = {clip.x / clip.w, clip.y / clip.w};
            }
            const double area = (at[1].x - at[0].x) * (at[2].y - at[0].y) -
                                (at[1].y - at[0].y) * (at[2].x - at[0].x);
            if (area < 0) {
                mesh.indices[t + 1] = mesh.indices[t + 2] = mesh.indices[t];
            }
        }
    }
    GBuffer fast;
    draw(culled.scene.list(), c.view, fast);
    return differenceToOracle(c.scene.list(), c.view, fast);
}

DrawCase flatCase(uint64_t seed) {
    Random random(seed);
    DrawCase made;
    made.view = flatView(120, 80, random);
    made.scene.materials.resize(3);
    for (int i = 0; i < 4; ++i) {
        made.scene.addMesh();
        for (int k = 0; k < 15; ++k) {
            addFlat(made.scene, made.view, FlatKind::ordinary, random);
        }
        joinParts(made.scene.meshes.back(), 3, random);
    }
    return made;
}

}  // namespace

TEST_CASE("property: a rasterizer that culls is caught, with one triangle in one pixel to show",
          "[property]") {
    const DrawCase found = flatCase(5);
    const DrawCase small = minimized(found, compareCulling);
    DrawCase copy = small;
    CHECK(small.scene.instances.size() == 1);
    REQUIRE(small.scene.meshes.size() == 1);
    CHECK(small.scene.meshes[0].triangleCount() == 1);
    CHECK(small.scene.meshes[0].x.size() == 3);
    CHECK(small.scene.materials.size() == 1);
    CHECK(small.view.width * small.view.height == 1);
    CHECK(small.view.jitter_x_fx8 == 0);
    CHECK(compareCulling(copy) == "pixel (0, 0) shows surface 0, the oracle sees 1");
    CHECK(compareToOracle(copy) == "");

    const std::string report = counterexample(seeds(5, 1), flatCase, compareCulling);
    INFO(report);
    CHECK(report.find("STILL_SEED=") != std::string::npos);
    CHECK(report.find("scene.meshes.back().indices = {0, 1, 2};") != std::string::npos);
    CHECK(std::count(report.begin(), report.end(), '\n') < 30);
}

TEST_CASE("property: minimising keeps what a failure needs and nothing else", "[property]") {
    // It takes two instances, one of which moved, and a texture.
    const DrawCheck check = [](DrawCase& c) -> std::string {
        c.scene.list();
        const auto& all = c.scene.instances;
        const bool moved =
            std::any_of(all.begin(), all.end(), [](const Instance& i) { return i.moved; });
        bool textured = false;
        for (const Mesh& mesh : c.scene.meshes) {
            for (const MeshPart& part : mesh.parts) {
                textured |= c.scene.materials[part.material].colour_texture != kNoTexture;
            }
        }
        return all.size() >= 2 && moved && textured && c.view.width >= 17 ? "fails" : "";
    };
    DrawCase small = minimized(busyCase(4), check);
    CHECK(check(small) == "fails");
    CHECK(small.scene.instances.size() == 2);
    CHECK(small.view.width == 17);
    CHECK(small.view.height == 1);
    CHECK(small.scene.materials.size() == 1);
    CHECK(small.scene.materials[0].specular == Material{}.specular);
    CHECK(small.scene.lighting.points.empty());
    CHECK(small.scene.meshes[0].triangleCount() + small.scene.meshes[1].triangleCount() == 1);
    DrawCase right = busyCase(4);
    CHECK(minimized(right, [](DrawCase&) { return std::string(); }).view.width == right.view.width);
}
