// Scenes read files of their own folder only, unless more is asked for.

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "engine/golden.h"
#include "engine/internal/file_access.h"
#include "engine/internal/model_cache.h"
#include "engine/internal/obj.h"
#include "engine/load.h"
#include "tests/support/data_path.h"

using namespace still;
namespace fs = std::filesystem;

namespace {

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n";
const std::string kRed = "newmtl red\nKd 1 0 0\n";
const std::string kPicture = "P6 1 1 255\n\xFF\x01\x02";

/// A scene's folder beside others, with links that lead about.
///
///     scene/s.json  scene/in.obj  scene/sub/in.obj  scene/link.obj → in.obj
///     scene/out.obj → ../secret.obj  scene/away → ..  secret.obj  scene2/secret.obj
struct Places {
    TempFolder temp;
    fs::path folder = temp.path() / "scene";
    FileAccess access{LoadOptions{}, folder / "s.json"};

    Places() {
        for (const char* name :
             {"scene/in.obj", "scene/sub/in.obj", "secret.obj", "scene2/secret.obj"}) {
            temp.write(name, kTriangle + "f 1 2 3\n");
        }
        temp.write("scene/in.mtl", kRed);
        temp.write("secret.mtl", kRed);
        temp.write("secret.ppm", kPicture);
        temp.write("secret.json", R"({"width": 4, "height": 4, "frames": []})");
        fs::create_symlink("in.obj", folder / "link.obj");
        fs::create_symlink("../secret.obj", folder / "out.obj");
        fs::create_symlink("..", folder / "away");
    }
    Result<Scene> scene(const std::string& json, bool allow_outside = false) const {
        return loadScene(temp.write("scene/s.json", json), {.allow_outside = allow_outside});
    }
    Result<ObjModel> model(const std::string& text, const LoadOptions& options = {}) const {
        return loadObj(temp.write("scene/m.obj", text), options);
    }
};

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("file access: names inside of the folder are permitted, others are not",
          "[unit][engine]") {
    const Places places;
    const auto permits = [&](const std::string& name) {
        return places.access.permits(places.folder, name);
    };
    for (const std::string& name :
         {std::string("in.obj"), std::string("./in.obj"), std::string("sub/in.obj"),
          std::string("sub/../in.obj"), std::string("sub\\in.obj"), std::string("link.obj"),
          std::string("not there.obj"), std::string("../scene/in.obj"),
          (places.folder / "in.obj").string()}) {
        INFO(name);
        CHECK(permits(name));
    }
    for (const std::string& name :
         {std::string("../secret.obj"), std::string("sub/../../secret.obj"),
          std::string("..\\secret.obj"), std::string("sub\\..\\..\\secret.obj"),
          std::string("/etc/passwd"), std::string("\\\\server\\share\\secret.obj"),
          std::string("C:\\secret.obj"), std::string("c:secret.obj"), std::string("out.obj"),
          std::string("away/secret.obj"), std::string("../scene2/secret.obj"),
          std::string("nowhere/../../secret.obj"), std::string("../not there.obj"),
          std::string("../secret.obj\0/../scene/in.obj", 32)}) {
        INFO(name);
        CHECK_FALSE(permits(name));
    }
    CHECK(places.access.permits(places.folder / "sub", "../in.obj"));
    CHECK(FileAccess({.allow_outside = true}, places.folder / "s.json")
              .permits(places.folder, "../secret.obj"));
    CHECK(FileAccess({.folder = places.temp.path()}, places.folder / "s.json")
              .permits(places.folder, "../secret.obj"));
}

TEST_CASE("file access: what is permitted lies in the folder, for names of any parts",
          "[unit][engine]") {
    const Places places;
    const std::string root = fs::canonical(places.folder).string() + "/";
    const std::array<std::string, 9> parts{"..",      ".",          "sub", "in.obj", "link.obj",
                                           "out.obj", "secret.obj", "",    "away"};
    std::mt19937 random(7);
    int inside = 0, outside = 0;
    for (int i = 0; i < 4000; ++i) {
        std::string name = parts[random() % parts.size()];
        for (uint32_t more = random() % 5; more > 0; --more) {
            name += "/" + parts[random() % parts.size()];
        }
        std::error_code error;
        const std::string real = fs::canonical(places.folder / name, error).string();
        if (error) {  // no such file: nothing can be read
            continue;
        }
        const bool lies_inside = (real + "/").starts_with(root);
        INFO(name << " is " << real);
        CHECK(places.access.permits(places.folder, name) == lies_inside);
        ++(lies_inside ? inside : outside);
    }
    CHECK(inside > 100);
    CHECK(outside > 100);
}

TEST_CASE("file access: a scene file that leads out is refused with place and option",
          "[unit][engine]") {
    const Places places;
    const auto refused = [&](const std::string& json, const std::string& key) {
        const Result<Scene> scene = places.scene(json);
        REQUIRE_FALSE(scene);
        INFO(scene.error().message);
        CHECK(isOneLineAbout(scene.error().message, "s.json"));
        CHECK(contains(scene.error().message, key));
        CHECK(contains(scene.error().message, "--allow-outside"));
    };
    refused(R"({"obj": "../secret.obj"})", "/obj: ");
    refused(R"({"obj": "out.obj"})", "/obj: ");
    refused(R"({"objects": [{"obj": "away/secret.obj"}]})", "/objects/0/obj: ");
    refused(R"({"obj": "in.obj", "camera": {"file": "../secret.json"}})", "/camera/file: ");
    refused(R"({"objects": [{"shape": "box", "material": {"image": "../secret.ppm"}}]})",
            "/objects/0/material/image: ");
    refused(
        R"({"objects": [{"shape": "box",
                         "material": {"height": {"image": "../secret.ppm", "scale": 1}}}]})",
        "/objects/0/material/height/image: ");
    CHECK(places.scene(R"({"obj": "../secret.obj"})", true));
    CHECK(places.scene(R"({"obj": "sub/../link.obj"})"));
}

TEST_CASE("file access: a scene file that names a pipe is refused instead of waited for",
          "[unit][engine]") {
    const Places places;
    REQUIRE(std::system(("mkfifo '" + (places.folder / "pipe.obj").string() + "'").c_str()) == 0);
    const Result<Scene> scene = places.scene(R"({"obj": "pipe.obj"})");
    REQUIRE_FALSE(scene);
    CHECK(contains(scene.error().message, "pipe.obj: is not an ordinary file"));
}

TEST_CASE("file access: libraries and images of an OBJ that lie outside are told and not read",
          "[unit][engine]") {
    const Places places;
    const std::string faces = "usemtl red\nf 1/1 2/1 3/1\n";
    for (const std::string library : {"../secret.mtl", "..\\secret.mtl", "away/secret.mtl"}) {
        const std::string text = "mtllib " + library + "\n" + kTriangle + faces;
        const Result<ObjModel> model = places.model(text);
        REQUIRE(model);
        CHECK(model->materials.at(0).diffuse != std::array<float, 3>{1, 0, 0});
        REQUIRE(model->warnings.size() == 2);
        CHECK(contains(model->warnings[0], "--allow-outside"));
        CHECK(std::none_of(model->files.begin(), model->files.end(),
                           [](const std::string& file) { return contains(file, "secret"); }));
        const Result<ObjModel> all = places.model(text, {.allow_outside = true});
        REQUIRE(all);
        CHECK(all->materials.at(0).diffuse == std::array<float, 3>{1, 0, 0});
    }
    for (const std::string image : {"../secret.ppm", "..\\secret.ppm", "C:\\x\\secret.ppm"}) {
        places.temp.write("scene/i.mtl", "newmtl red\nmap_Kd " + image + "\n");
        const Result<ObjModel> model = places.model("mtllib i.mtl\n" + kTriangle + faces);
        REQUIRE(model);
        CHECK(model->textures.empty());
        REQUIRE(model->warnings.size() == 1);
        CHECK(contains(model->warnings[0], "--allow-outside"));
    }
    // A path of another machine still finds the file beside the library.
    places.temp.write("scene/secret.ppm", kPicture);
    const Result<ObjModel> found = places.model("mtllib i.mtl\n" + kTriangle + faces);
    REQUIRE(found);
    CHECK(found->textures.size() == 1);
    CHECK(found->warnings.empty());
}

TEST_CASE("file access: an OBJ in a folder of the scene may name what lies beside that folder",
          "[unit][engine]") {
    const Places places;
    places.temp.write("scene/sub/up.obj",
                      "mtllib ../in.mtl\n" + kTriangle + "usemtl red\nf 1 2 3\n");
    const Result<Scene> scene = places.scene(R"({"obj": "sub/up.obj"})");
    REQUIRE(scene);
    CHECK(scene->warnings.empty());
    const Result<ObjModel> alone = loadObj(places.folder / "sub" / "up.obj");
    REQUIRE(alone);
    CHECK(alone->warnings.size() == 2);
}

TEST_CASE("file access: the model cache does not hand out what was read from outside",
          "[unit][engine]") {
    const Places places;
    const fs::path cache = places.temp.path() / "cache";
    const std::string text = "mtllib ../secret.mtl\n" + kTriangle + "usemtl red\nf 1 2 3\n" +
                             std::string(1 << 20, '#');  // worth keeping
    const Result<ObjModel> all = places.model(text, {.cache_folder = cache, .allow_outside = true});
    REQUIRE(all);
    CHECK(ModelCache(cache, places.folder / "m.obj", FileAccess()).load());
    const Result<ObjModel> confined = places.model(text, {.cache_folder = cache});
    REQUIRE(confined);
    CHECK(all->materials.at(0).diffuse == std::array<float, 3>{1, 0, 0});
    CHECK(confined->materials.at(0).diffuse != std::array<float, 3>{1, 0, 0});
}

TEST_CASE("file access: golden manifests name scenes and cameras of their own folder",
          "[unit][engine]") {
    const Places places;
    const auto errorOf = [&](const std::string& names, bool allow_outside) {
        places.temp.write("scene/golden.json",
                          R"({"cases": [{"name": "a", "resolution": [8, 8], )" + names + "}]}");
        const auto manifest = golden::readManifest(places.folder);
        REQUIRE(manifest);
        golden::Options options;
        options.threads = 1;
        options.allow_outside = allow_outside;
        const auto rendered = golden::renderCase(*manifest, manifest->cases[0], options);
        return rendered ? std::string() : rendered.error().message;
    };
    const std::string outside = R"("scene": "../secret.obj")";
    CHECK(contains(errorOf(outside, false), "golden.json: /cases/0/scene: expected a file in"));
    CHECK(errorOf(outside, true).empty());
    CHECK(errorOf(R"("scene": "sub/in.obj")", false).empty());
    CHECK(contains(errorOf(R"("scene": "in.obj", "cameras": "../secret.json")", false),
                   "/cases/0/cameras: expected a file in"));
}

TEST_CASE("memory need: a model or image that is too large for the limit is refused by name",
          "[unit][engine]") {
    const Places places;
    const std::string faces = "usemtl red\nf 1/1 2/1 3/1\n";
    const std::string text = "mtllib i.mtl\n" + kTriangle + faces;
    places.temp.write("scene/i.mtl", "newmtl red\nmap_Kd wide.ppm\n");
    places.temp.write("scene/wide.ppm", "P6 1000 1000 255\n" + std::string(3000000, 'x'));
    const LoadOptions small{.max_memory_bytes = 8 << 20};
    const Result<ObjModel> model = places.model(text, small);
    REQUIRE_FALSE(model);
    CHECK(isOneLineAbout(model.error().message, "wide.ppm"));
    CHECK(contains(model.error().message, "--max-memory"));
    CHECK(places.model(text, {.max_memory_bytes = 20 << 20}));
    const Result<ObjModel> long_text =
        places.model(text + std::string(3 << 20, '\n'), {.max_memory_bytes = 8 << 20});
    REQUIRE_FALSE(long_text);
    CHECK(isOneLineAbout(long_text.error().message, "m.obj"));
}

TEST_CASE("load: a scene of more triangles than can be numbered is refused", "[unit][engine]") {
    const TempFolder folder;
    std::string obj = kTriangle;
    for (int i = 0; i < 4500; ++i) {
        obj += "f 1 2 3\n";
    }
    folder.write("m.obj", obj);
    std::string json = R"({"objects": [{"obj": "m.obj"})";
    for (int i = 1; i < 30000; ++i) {
        json += R"(,{"obj":"m.obj"})";
    }
    const Result<Scene> scene = loadScene(folder.write("s.json", json + "]}"));
    REQUIRE_FALSE(scene);
    CHECK(isOneLineAbout(scene.error().message, "s.json"));
}
