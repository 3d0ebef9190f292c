#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "engine/internal/obj.h"
#include "tests/support/data_path.h"

using namespace still;

namespace {

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

Result<ObjModel> load(const std::string& text) {
    const TempFolder folder;
    return loadObj(folder.write("model.obj", text));
}

ObjModel loadGood(const std::string& text) {
    Result<ObjModel> model = load(text);
    INFO((model ? std::string() : model.error().message));
    REQUIRE(model);
    return std::move(*model);
}

/// What the header of Mesh promises. Returns what is wrong, or nothing.
std::string brokenPromise(const ObjModel& model) {
    const Mesh& mesh = model.mesh;
    const size_t n = mesh.vertexCount();
    if (mesh.y.size() != n || mesh.z.size() != n || mesh.attributes.size() != n) {
        return "array sizes";
    }
    if (!mesh.tangents.empty() && mesh.tangents.size() != n) {
        return "tangent count";
    }
    for (const uint32_t i : mesh.indices) {
        if (i >= n) {
            return "index out of range";
        }
    }
    uint32_t next = 0;
    for (const MeshPart& part : mesh.parts) {
        if (part.first_triangle != next || part.triangle_count == 0 ||
            part.material >= model.materials.size()) {
            return "parts";
        }
        next += part.triangle_count;
    }
    if (next != mesh.triangleCount() || next == 0) {
        return "parts do not cover the triangles";
    }
    for (size_t i = 0; i < n; ++i) {
        const VertexAttributes& a = mesh.attributes[i];
        const double length =
            std::sqrt(double(a.nx) * a.nx + double(a.ny) * a.ny + double(a.nz) * a.nz);
        if (!(std::abs(length - 1.0) < 1e-6)) {
            return "normal length";
        }
        if (!(std::abs(a.u) <= 32768.0f && std::abs(a.v) <= 32768.0f)) {
            return "texture coordinates";
        }
        if (!std::isfinite(mesh.x[i]) || !std::isfinite(mesh.y[i]) || !std::isfinite(mesh.z[i])) {
            return "position";
        }
    }
    for (const VertexTangent& t : mesh.tangents) {
        const double length = std::sqrt(double(t.x) * t.x + double(t.y) * t.y + double(t.z) * t.z);
        if (!(std::abs(length - 1.0) < 1e-6) || std::abs(t.handedness) != 1.0f) {
            return "tangent";
        }
    }
    const auto known = [](int32_t texture, size_t count) {
        return texture == kNoTexture || (texture >= 0 && size_t(texture) < count);
    };
    for (const Material& m : model.materials) {
        if (!known(m.colour_texture, model.textures.size()) ||
            !known(m.normal_texture, model.textures.size()) ||
            !known(m.alpha_texture, model.alpha_textures.size())) {
            return "texture number";
        }
    }
    return {};
}

void checkRefused(const std::string& text, const std::string& reason) {
    const Result<ObjModel> model = load(text);
    INFO(text.substr(0, 200));
    REQUIRE_FALSE(model);
    CHECK(isOneLineAbout(model.error().message, "model.obj"));
    CHECK_THAT(model.error().message, Catch::Contains(reason));
}

}  // namespace

TEST_CASE("obj: every odd file loads with the promises kept or is refused with one line",
          "[unit][engine][data]") {
    int loaded = 0;
    const auto files = dataFiles("obj_odd", {".obj"});
    for (const auto& file : files) {
        INFO(file);
        const Result<ObjModel> model = loadObj(file);
        if (!model) {
            CHECK(isOneLineAbout(model.error().message, file.filename().string()));
            continue;
        }
        ++loaded;
        CHECK(brokenPromise(*model) == "");
        for (const std::string& warning : model->warnings) {
            CHECK(isOneLineAbout(warning, file.parent_path().filename().string()));
        }
    }
    CHECK((files.empty() || loaded >= 38));
}

TEST_CASE("obj: the shared scenes load with all their triangles", "[unit][engine][data]") {
    struct Expected {
        const char* file;
        uint32_t triangles;
        size_t materials, textures, alpha_textures;
    };
    // City tiles and cornell boxes hold zero-area faces, which are dropped.
    for (const Expected& e : std::vector<Expected>{{"sponza/sponza.obj", 262267, 25, 35, 3},
                                                   {"tree/tree.obj", 2067, 2, 2, 1},
                                                   {"fence_wires/fence_wires.obj", 5054, 5, 1, 1},
                                                   {"city_kit/building_small_c.obj", 817, 1, 1, 0},
                                                   {"city_kit/grass_trees.obj", 380, 1, 1, 0},
                                                   {"balloon/balloon.obj", 35698, 37, 17, 0},
                                                   {"bunny/bunny.obj", 69451, 1, 0, 0},
                                                   {"spot/spot_quadrangulated.obj", 5856, 1, 1, 0},
                                                   {"suzanne/suzanne.obj", 968, 1, 0, 0}}) {
        const auto file = dataFile(e.file);
        if (file.empty()) {
            continue;
        }
        INFO(e.file);
        const Result<ObjModel> model = loadObj(file);
        REQUIRE(model);
        CHECK(brokenPromise(*model) == "");
        CHECK(model->warnings.empty());
        CHECK(model->mesh.triangleCount() == e.triangles);
        CHECK(model->materials.size() == e.materials);
        CHECK(model->textures.size() == e.textures);
        CHECK(model->alpha_textures.size() == e.alpha_textures);
    }
}

TEST_CASE("obj: negative indices, all line ends and comments", "[unit][engine]") {
    for (const char* text :
         {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1",
          "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n", "v 0 0 0\rv 1 0 0\rv 0 1 0\rf -3 -2 -1\r",
          "\xEF\xBB\xBFv 0 0 0 1.0\n v\t1 0 0 0.5 0.5 0.5\nv 0 1 \\\n0\nf  1 2 3  # a comment 9"}) {
        INFO(text);
        const ObjModel model = loadGood(text);
        CHECK(model.mesh.triangleCount() == 1);
        CHECK(model.mesh.x == std::vector<float>{0, 1, 0});
        CHECK(model.mesh.y == std::vector<float>{0, 0, 1});
        CHECK(model.mesh.indices == std::vector<uint32_t>{0, 1, 2});
        CHECK(model.warnings.empty());
    }
}

TEST_CASE("obj: relative indices count from where the face stands", "[unit][engine]") {
    const ObjModel model =
        loadGood(kTriangle + "f -3 -2 -1\nv 0 0 5\nv 1 0 5\nv 0 1 5\nf -3 -2 -1\n");
    CHECK(model.mesh.vertexCount() == 6);
    CHECK(model.mesh.z == std::vector<float>{0, 0, 0, 5, 5, 5});
}

TEST_CASE("obj: corners that agree share a vertex, others do not", "[unit][engine]") {
    const std::string quad =
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 1\nvn 0 0 1\n"
        "vn 0 0 2\nvn 0 1 0\n";
    CHECK(loadGood(quad + "f 1/1/1 2/1/1 3/1/1\nf 1/1/1 3/1/1 4/1/1").mesh.vertexCount() == 4);
    CHECK(loadGood(quad + "f 1/1/1 2/1/1 3/1/1\nf 1/2/1 3/1/1 4/1/1").mesh.vertexCount() == 5);
    CHECK(loadGood(quad + "f 1/1/1 2/1/1 3/1/1\nf 1/1/3 3/1/1 4/1/1").mesh.vertexCount() == 5);
    // Equal directions are equal normals; generated ones as well.
    CHECK(loadGood(quad + "f 1/1/1 2/1/1 3/1/1\nf 1/1/2 3/1/2 4/1/2").mesh.vertexCount() == 4);
    CHECK(loadGood(quad + "f 1//1 2//1 3//1\nf 1 3 4").mesh.vertexCount() == 4);
}

TEST_CASE("obj: parts follow groups and materials in file order", "[unit][engine]") {
    const TempFolder folder;
    folder.write("m.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
    const auto file = folder.write(
        "model.obj", "mtllib m.mtl\n" + kTriangle +
                         "f 1 2 3\nusemtl blue\ng a\nf 1 2 3\nf 1 2 3\nusemtl blue\nf 1 2 3\n"
                         "usemtl red\nf 1 2 3\no b\nf 1 2 3\ng empty\ng c\nf 1 1 1\nusemtl blue\n"
                         "f 1 2 3\n");
    const Result<ObjModel> model = loadObj(file);
    REQUIRE(model);
    const std::vector<MeshPart>& parts = model->mesh.parts;
    REQUIRE(parts.size() == 5);
    const auto redness = [&](size_t i) { return model->materials[parts[i].material].diffuse; };
    const std::array<float, 3> red{1, 0, 0}, blue{0, 0, 1}, grey{0.8f, 0.8f, 0.8f};
    CHECK(redness(0) == grey);
    CHECK(redness(1) == blue);
    CHECK(parts[1].triangle_count == 3);
    CHECK(redness(2) == red);
    CHECK(redness(3) == red);
    CHECK(redness(4) == blue);
    CHECK(brokenPromise(*model) == "");
    CHECK(model->materials.size() == 3);
}

TEST_CASE("obj: libraries with blanks, backslashes, several of them", "[unit][engine]") {
    const TempFolder folder;
    folder.write("my lib.mtl", "newmtl a\nKd 1 0 0\n");
    folder.write("sub/b.mtl", "newmtl b\nKd 0 1 0\n");
    folder.write("c.mtl", "newmtl c\nKd 0 0 1\nnewmtl a\nKd 0 0 0");
    for (const char* lines :
         {"mtllib my lib.mtl\nmtllib sub\\b.mtl c.mtl\n", "mtllib my\\ lib.mtl sub/b.mtl c.mtl\n",
          "mtllib my lib.mtl\r\nmtllib ./sub/b.mtl\r\nmtllib c.mtl \r\n"}) {
        INFO(lines);
        const Result<ObjModel> model = loadObj(folder.write(
            "model.obj", lines + kTriangle +
                             "usemtl a\nf 1 2 3\nusemtl b # green\nf 1 2 3\nusemtl c\nf 1 2 3\n"));
        REQUIRE(model);
        CHECK(model->warnings.empty());
        REQUIRE(model->materials.size() == 3);
        CHECK(model->materials[0].diffuse[0] == 1.0f);
        CHECK(model->materials[1].diffuse[1] == 1.0f);
        CHECK(model->materials[2].diffuse[2] == 1.0f);
    }
}

TEST_CASE("obj: what is odd but usable gives warnings", "[unit][engine]") {
    const auto onlyWarning = [](const std::string& text) {
        const ObjModel model = loadGood(text);
        CHECK(brokenPromise(model) == "");
        CHECK(model.warnings.size() == 1);
        CHECK(isOneLineAbout(model.warnings.at(0), "model.obj"));
        return model.warnings.at(0);
    };
    using Catch::Contains;
    CHECK_THAT(onlyWarning(kTriangle + "f 1 2 3\nl 1 2 3\np 1\nl 1 2\n"),
               Contains("3 point or line"));
    CHECK_THAT(onlyWarning(kTriangle + "f 1 2\nf 1 2 3\n"), Contains("fewer than three"));
    CHECK_THAT(onlyWarning(kTriangle + "usemtl x\nf 1 2 3\nf 1 2 3"), Contains("\"x\""));
    CHECK_THAT(onlyWarning("mtllib no.mtl\n" + kTriangle + "f 1 2 3"), Contains("no.mtl"));
    CHECK_THAT(onlyWarning(kTriangle + "f 1/1 2/2 3/3"), Contains("do not exist"));
    CHECK_THAT(onlyWarning(kTriangle + "vt nan 0\nf 1/1 2/1 3/1"), Contains("texture coordinates"));
    CHECK_THAT(onlyWarning(kTriangle + "vn 0 x 0\nf 1//1 2//1 3//1"), Contains("normals"));
}

TEST_CASE("obj: what cannot be drawn is refused with line and reason", "[unit][engine]") {
    checkRefused("", "no triangles");
    checkRefused("hello\nworld", "no triangles");
    checkRefused(std::string("\0\0\0f 1 2 3", 10), "no triangles");
    checkRefused(kTriangle, "no triangles");
    checkRefused(kTriangle + "f 1 2 2\nf 1 1 1\n", "no triangles");
    checkRefused(kTriangle + "f 1 2 4\n", ":4: face 1: vertex 4 does not exist");
    checkRefused(kTriangle + "f 1 2 3\nf 1 2 -4\n", ":5: face 2: vertex -4");
    checkRefused(kTriangle + "f 0 1 2\n", "vertex 0");
    checkRefused(kTriangle + "f a b c\n", "vertex 0");
    checkRefused("f 1 2 3\n" + kTriangle, ":1: face 1");
    checkRefused(kTriangle + "f 1 2 4294967299\n", "more than 9 digits");
    checkRefused("v 0 0 0\nv 1 nan 0\n" + kTriangle + "f 1 2 3", ":2: vertex 2 is not finite");
    checkRefused("v inf 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3", "vertex 1 is not finite");
    checkRefused("v 1e999 0 0\n", "vertex 1 is not finite");
    checkRefused("v 1e30 0 0\n", "vertex 1");
    checkRefused("v 0 0\n", "expected three numbers");
    checkRefused("v 0 zero 0\n", "expected three numbers");
}

TEST_CASE("obj: files that cannot be opened", "[unit][engine]") {
    const TempFolder folder;
    for (const auto& file : {folder.path() / "none.obj", folder.path()}) {
        const Result<ObjModel> model = loadObj(file);
        REQUIRE_FALSE(model);
        CHECK(isOneLineAbout(model.error().message, file.filename().string()));
    }
}

TEST_CASE("obj: faces of hundreds of corners", "[unit][engine]") {
    // tinyobjloader's own face sizes wrap at 256.
    for (const int n : {255, 256, 257, 1000}) {
        std::string text, face = "f";
        for (int i = 0; i < n; ++i) {
            const double a = 6.283185307179586 * i / n;
            text += "v " + std::to_string(std::cos(a)) + " " + std::to_string(std::sin(a)) + " 0\n";
            face += " " + std::to_string(i + 1);
        }
        CHECK(loadGood(text + face + "\n").mesh.triangleCount() == uint32_t(n - 2));
    }
}

TEST_CASE("obj: insane texture coordinates come back by whole tiles", "[unit][engine]") {
    const ObjModel far = loadGood(kTriangle +
                                  "vt 1000000.25 0.5\nvt 1000001.25 0.5\nvt 1000000.25 1.5\n"
                                  "f 1/1 2/2 3/3\n");
    const auto& a = far.mesh.attributes;
    CHECK(a[1].u - a[0].u == 1.0f);
    CHECK(a[0].u - std::floor(a[0].u) == 0.25f);
    CHECK(std::abs(a[0].u) <= 2.0f);
    CHECK(a[2].v == 1.5f);
    CHECK(brokenPromise(loadGood(kTriangle + "vt -3e38 0\nvt 3e38 0\nf 1/1 2/2 3/1\n")) == "");
}

TEST_CASE("obj: normal-mapped models have tangents and split mirrored seams", "[unit][engine]") {
    const TempFolder folder;
    folder.write("n.ppm", "P6\n1 1\n255\n\x80\x80\xFF");
    folder.write("m.mtl", "newmtl a\nnorm n.ppm\n");
    // Two quads that mirror the texture at their common edge.
    const Result<ObjModel> model = loadObj(folder.write(
        "model.obj",
        "mtllib m.mtl\nusemtl a\nv -1 0 0\nv 0 0 0\nv 0 1 0\nv -1 1 0\nv 1 0 0\nv 1 1 0\n"
        "vt 1 0\nvt 0 0\nvt 0 1\nvt 1 1\nf 1/1 2/2 3/3 4/4\nf 2/2 5/1 6/4 3/3\n"));
    REQUIRE(model);
    CHECK(brokenPromise(*model) == "");
    REQUIRE(model->mesh.tangents.size() == 8);
    for (uint32_t i = 0; i < 8; ++i) {
        const VertexTangent& t = model->mesh.tangents[i];
        const bool left = std::find(model->mesh.indices.begin(), model->mesh.indices.begin() + 6,
                                    i) != model->mesh.indices.begin() + 6;
        CHECK(t.x == (left ? -1.0f : 1.0f));
        CHECK(t.handedness == (left ? -1.0f : 1.0f));
    }
}

TEST_CASE("obj: plain faces mean what they mean to tinyobjloader", "[unit][engine]") {
    const std::string vertices =
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\nvn 0 0 -1\n";
    const TempFolder folder;
    const auto loadText = [&](const std::string& text) {
        return loadObj(folder.write("model.obj", text));
    };
    // A comment, or a plus sign, sends a line to tinyobjloader.
    for (const std::string face :
         {"1 2 3", "1/1 2/2 3/3", "1//1 2//1 3//2", "1/1/1 2/2/2 3/3/1", "-4/-3/-2 -3/-2/-1 -1",
          "1 2 3 4", "\t1/1\t 2/2   3/3/1 4", "1 2", "1/0/0 2/0 3//0", "1/9 2/2 3//9"}) {
        INFO(face);
        const Result<ObjModel> plain_model = loadText(vertices + "f " + face + "\nf 1 3 4\n");
        const Result<ObjModel> other_model = loadText(vertices + "f " + face + " #\nf +1 3 4\n");
        REQUIRE((plain_model && other_model));
        const ObjModel &plain = *plain_model, &other = *other_model;
        CHECK(plain.mesh.indices == other.mesh.indices);
        CHECK(plain.mesh.x == other.mesh.x);
        CHECK(plain.warnings == other.warnings);
        REQUIRE(plain.mesh.attributes.size() == other.mesh.attributes.size());
        for (size_t i = 0; i < plain.mesh.attributes.size(); ++i) {
            const VertexAttributes &a = plain.mesh.attributes[i], &b = other.mesh.attributes[i];
            CHECK(std::array{a.nx, a.ny, a.nz, a.u, a.v} == std::array{b.nx, b.ny, b.nz, b.u, b.v});
        }
    }
    for (const std::string face : {"1 2 7", "1 2 0", "1 2 -5", "1 2 1234567890"}) {
        INFO(face);
        const Result<ObjModel> plain = loadText(vertices + "f " + face + "\n");
        const Result<ObjModel> other = loadText(vertices + "f " + face + " #\n");
        REQUIRE((!plain && !other));
        CHECK(plain.error().message == other.error().message);
    }
}

TEST_CASE("obj: vertices are shared across mirrored texture when the normal map is broken",
          "[unit][engine]") {
    const TempFolder folder;
    folder.write("good.ppm", "P6\n1 1\n255\nabc");
    folder.write("bad.ppm", "P6\n1 1\n255\n");
    folder.write("m.mtl", "newmtl good\nnorm good.ppm\nnewmtl bad\nnorm bad.ppm\n");
    const auto count = [&](const std::string& material) {
        const Result<ObjModel> model = loadObj(
            folder.write(material + ".obj",
                         "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 0\n"
                         "vt 0 1\nusemtl " +
                             material + "\nf 1/1 2/2 3/3\nf 2/2 4/1 3/3\n"));
        REQUIRE(model);
        CHECK(model->mesh.tangents.empty() == (material == "bad"));
        return model->mesh.vertexCount();
    };
    CHECK(count("good") == 6);
    CHECK(count("bad") == 4);
}

TEST_CASE("obj: models are appended to a scene with their numbers moved", "[unit][engine]") {
    const TempFolder folder;
    folder.write("c.ppm", "P6\n1 1\n255\nabc");
    folder.write("m.mtl", "newmtl a\nmap_Kd c.ppm\nmap_d c.ppm\nnewmtl b\nd 0.5\n");
    const auto file = folder.write(
        "model.obj", "mtllib m.mtl\n" + kTriangle + "usemtl b\nf 1 2 3\nusemtl a\nf 1 2 3\n");
    Scene scene;
    for (uint32_t i = 0; i < 2; ++i) {
        Result<ObjModel> model = loadObj(file);
        REQUIRE(model);
        CHECK(appendModel(scene, std::move(*model), "m" + std::to_string(i)) == i);
    }
    CHECK(scene.mesh_names == std::vector<std::string>{"m0", "m1"});
    REQUIRE(scene.materials.size() == 4);
    CHECK(scene.materials[2].colour_texture == kNoTexture);
    CHECK(scene.materials[3].colour_texture == 1);
    CHECK(scene.materials[3].alpha_texture == 1);
    CHECK(scene.meshes[1].parts[1].material == 3);
    CHECK(scene.objects.empty());
}
