#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "demos/scenes/builtin.h"
#include "engine/timeline.h"

using namespace still;

namespace {

Scene built(const std::string& name) {
    Result<Scene> scene = builtinScene(name);
    REQUIRE(scene.has_value());
    return std::move(*scene);
}

template <class T>
bool sameBytes(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

bool allFinite(const std::vector<float>& values) {
    return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

bool hasUnitNormals(const Mesh& mesh) {
    return std::all_of(
        mesh.attributes.begin(), mesh.attributes.end(), [](const VertexAttributes& a) {
            const double length2 = double(a.nx) * a.nx + double(a.ny) * a.ny + double(a.nz) * a.nz;
            return std::abs(length2 - 1) < 1e-5 && std::isfinite(a.u) && std::isfinite(a.v);
        });
}

/// Unit tangents at right angles to the normals.
bool hasGoodTangents(const Mesh& mesh) {
    for (size_t i = 0; i < mesh.tangents.size(); ++i) {
        const VertexTangent& t = mesh.tangents[i];
        const VertexAttributes& a = mesh.attributes[i];
        const double length2 = double(t.x) * t.x + double(t.y) * t.y + double(t.z) * t.z;
        const double cosine = double(t.x) * a.nx + double(t.y) * a.ny + double(t.z) * a.nz;
        if (std::abs(length2 - 1) > 1e-5 || std::abs(cosine) > 1e-5 ||
            std::abs(t.handedness) != 1.0f) {
            return false;
        }
    }
    return true;
}

bool partsCover(const Mesh& mesh) {
    uint32_t next = 0;
    for (const MeshPart& part : mesh.parts) {
        if (part.first_triangle != next || part.triangle_count == 0) {
            return false;
        }
        next += part.triangle_count;
    }
    return next == mesh.triangleCount();
}

void checkMesh(const Mesh& mesh, const Scene& scene) {
    CHECK(mesh.y.size() == mesh.x.size());
    CHECK(mesh.z.size() == mesh.x.size());
    REQUIRE(mesh.attributes.size() == mesh.x.size());
    REQUIRE((mesh.tangents.empty() || mesh.tangents.size() == mesh.x.size()));
    CHECK(mesh.indices.size() % 3 == 0);
    CHECK(std::all_of(mesh.indices.begin(), mesh.indices.end(),
                      [&](uint32_t i) { return i < mesh.vertexCount(); }));
    CHECK(allFinite(mesh.x));
    CHECK(allFinite(mesh.y));
    CHECK(allFinite(mesh.z));
    CHECK(hasUnitNormals(mesh));
    CHECK(hasGoodTangents(mesh));
    CHECK(partsCover(mesh));
    for (const MeshPart& part : mesh.parts) {
        REQUIRE(part.material < scene.materials.size());
        CHECK((scene.materials[part.material].normal_texture == kNoTexture ||
               !mesh.tangents.empty()));
    }
}

void checkMaterial(const Material& material, const Scene& scene) {
    const int textures = int(scene.textures.size());
    CHECK(material.colour_texture < textures);
    CHECK(material.normal_texture < textures);
    CHECK(material.alpha_texture < int(scene.alpha_textures.size()));
    CHECK(material.shininess >= 1);
    CHECK(material.shininess <= 1024);
    CHECK(material.opacity >= 0);
    CHECK(material.opacity <= 1);
}

template <class T>
bool strictlyIncreasing(const Track<T>& track) {
    for (size_t i = 1; i < track.keys.size(); ++i) {
        if (track.keys[i].frame <= track.keys[i - 1].frame) {
            return false;
        }
    }
    return true;
}

}  // namespace

TEST_CASE("scenes: the courtyard is listed first, an unknown name is refused", "[scenes][unit]") {
    REQUIRE(!builtinSceneNames().empty());
    CHECK(builtinSceneNames().front() == "courtyard");
    const Result<Scene> refused = builtinScene("cathedral");
    REQUIRE(!refused.has_value());
    CHECK(refused.error().message.find("cathedral") != std::string::npos);
    CHECK(refused.error().message.find("courtyard") != std::string::npos);
}

TEST_CASE("scenes: every scene keeps what draw lists promise", "[scenes][unit]") {
    for (const std::string& name : builtinSceneNames()) {
        INFO(name);
        const Scene scene = built(name);
        CHECK(scene.name == name);
        CHECK(scene.mesh_names.size() == scene.meshes.size());
        for (size_t i = 0; i < scene.meshes.size(); ++i) {
            INFO(scene.mesh_names[i]);
            checkMesh(scene.meshes[i], scene);
        }
        for (const Material& material : scene.materials) {
            checkMaterial(material, scene);
        }
        for (const SceneObject& object : scene.objects) {
            INFO(object.name);
            REQUIRE(object.mesh < scene.meshes.size());
            CHECK(strictlyIncreasing(object.tracks.translation));
            CHECK(strictlyIncreasing(object.tracks.rotation_deg));
            CHECK(strictlyIncreasing(object.tracks.scale));
        }
        CHECK(!scene.objects.empty());
        CHECK(surfaceCount(scene) < kMaxSurfaces);
        CHECK(scene.camera.near > 0);
        CHECK(scene.camera.near < scene.camera.far);
        CHECK(std::is_sorted(scene.cuts.begin(), scene.cuts.end()));
    }
}

TEST_CASE("scenes: sizes are as announced", "[scenes][unit]") {
    for (const std::string& name : builtinSceneNames()) {
        INFO(name);
        const Scene scene = built(name);
        if (name == "courtyard") {
            CHECK(scene.triangleCount() >= 90000);
            CHECK(scene.triangleCount() <= 130000);
            CHECK(scene.objects.size() >= 12);
            CHECK(scene.views.size() >= 5);
        } else {
            CHECK(scene.triangleCount() < 10000);
        }
    }
}

TEST_CASE("scenes: building a scene twice gives equal bytes", "[scenes][determinism]") {
    for (const std::string& name : builtinSceneNames()) {
        INFO(name);
        const Scene a = built(name), b = built(name);
        REQUIRE(a.meshes.size() == b.meshes.size());
        for (size_t i = 0; i < a.meshes.size(); ++i) {
            const Mesh &m = a.meshes[i], &n = b.meshes[i];
            CHECK(sameBytes(m.x, n.x));
            CHECK(sameBytes(m.y, n.y));
            CHECK(sameBytes(m.z, n.z));
            CHECK(sameBytes(m.attributes, n.attributes));
            CHECK(sameBytes(m.tangents, n.tangents));
            CHECK(sameBytes(m.indices, n.indices));
        }
        REQUIRE(a.textures.size() == b.textures.size());
        for (size_t i = 0; i < a.textures.size(); ++i) {
            CHECK(sameBytes(a.textures[i].texels, b.textures[i].texels));
        }
        REQUIRE(a.alpha_textures.size() == b.alpha_textures.size());
        for (size_t i = 0; i < a.alpha_textures.size(); ++i) {
            CHECK(sameBytes(a.alpha_textures[i].texels, b.alpha_textures[i].texels));
        }
    }
}
