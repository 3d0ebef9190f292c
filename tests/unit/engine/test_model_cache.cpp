#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "engine/internal/model_cache.h"
#include "engine/internal/model_format.h"
#include "engine/load.h"
#include "tests/support/data_path.h"

using namespace still;
namespace fs = std::filesystem;

namespace {

std::string textOf(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// All of a model as bytes.
std::string bytesOf(const ObjModel& model) {
    const FlatModel flat = flatten({}, model);
    std::string bytes = flat.table;
    for (const FlatArray& array : flat.arrays) {
        bytes += array.bytes;
    }
    return bytes;
}

std::string image(int width, int height, const std::string& pixels) {
    std::string bytes =
        "P6\n" + std::to_string(width) + " " + std::to_string(height) + "\n255\n" + pixels;
    bytes.resize(bytes.size() + size_t(width) * size_t(height) * 3 - pixels.size(), '\x20');
    return bytes;
}

/// A model with everything that a cache must keep, a missing image and its warning too, in a file
/// large enough to be kept.
class CachedModel {
  public:
    const TempFolder folder;
    const fs::path cache_folder = folder.path() / "made" / "when needed";
    const std::string text =
        "mtllib m.mtl\nmtllib none.mtl\n"
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\n"
        "usemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 1/1 3/3 4/2\nf 1 2 4\n#" +
        std::string(size_t{1} << 20, 'x') + "\n";
    const fs::path obj = folder.write("model.obj", text);
    const fs::path colour = folder.write("c.ppm", image(5, 3, "abcdefghi"));

    CachedModel() {
        folder.write("mask.ppm", image(2, 2, std::string(6, '\xFF')));
        folder.write("m.mtl",
                     "newmtl a\nmap_Kd c.ppm\nnorm c.ppm\nmap_d mask.ppm\nKs 0.1 0.2 0.3\nNs 7\n"
                     "newmtl b\nmap_Kd missing.ppm\nKe 3 2 1\nd 0.5\n");
    }

    ObjModel load() const {
        Result<ObjModel> model = loadObj(obj, {cache_folder});
        REQUIRE(model);
        return std::move(*model);
    }
    ModelCache cache() const { return {cache_folder, obj, FileAccess({}, obj)}; }
    bool hit() const { return cache().load().has_value(); }
    std::string fresh() const { return bytesOf(*loadObj(obj)); }
    std::string entry() const { return textOf(cache().file()); }
    void setEntry(const std::string& bytes) const {
        std::ofstream(cache().file(), std::ios::binary) << bytes;
    }
};

}  // namespace

TEST_CASE("model cache: a model comes back as it was, warnings too", "[unit][engine]") {
    const CachedModel scene;
    CHECK(!scene.hit());
    const ObjModel first = scene.load();
    CHECK(first.warnings.size() == 2);
    CHECK(first.textures.size() == 2);
    CHECK(first.alpha_textures.size() == 1);
    CHECK(!first.mesh.tangents.empty());
    const std::optional<ObjModel> kept = scene.cache().load();
    REQUIRE(kept);
    CHECK(bytesOf(*kept) == bytesOf(first));
    CHECK(bytesOf(*kept) == scene.fresh());
    CHECK(kept->warnings == first.warnings);
    CHECK(bytesOf(scene.load()) == bytesOf(first));
}

TEST_CASE("model cache: what stands there is what loading takes", "[unit][engine]") {
    const CachedModel scene;
    const ObjModel model = scene.load();
    ObjModel other = model;
    other.mesh.x[0] = 0.25f;
    other.warnings.push_back("from the cache");
    InputLog log;
    REQUIRE(log.read(scene.obj));
    scene.cache().store(other, log);
    CHECK(bytesOf(scene.load()) == bytesOf(other));
    const Result<Scene> loaded = loadScene(scene.obj, {scene.cache_folder});
    REQUIRE(loaded);
    CHECK(loaded->warnings == other.warnings);
}

TEST_CASE("model cache: a model knows its files, also those looked for in vain, read or kept",
          "[unit][engine]") {
    const CachedModel model;
    const std::vector<std::string> read = model.load().files;
    REQUIRE(model.hit());
    CHECK(model.load().files == read);
    std::set<std::string> names;
    for (const std::string& file : read) {
        names.insert(fs::relative(file, model.folder.path()).string());
    }
    CHECK(names == std::set<std::string>{"model.obj", "m.mtl", "none.mtl", "c.ppm", "mask.ppm",
                                         "missing.ppm"});
}

TEST_CASE("model cache: any file that changes makes a model stale, whatever its date and size",
          "[unit][engine]") {
    const CachedModel scene;
    const std::string before = bytesOf(scene.load());
    for (const std::string name : {"model.obj", "m.mtl", "c.ppm", "mask.ppm"}) {
        INFO(name);
        REQUIRE(scene.hit());
        const fs::path file = scene.folder.path() / name;
        const std::string bytes = textOf(file);
        const fs::file_time_type time = fs::last_write_time(file);
        std::string changed = bytes;
        changed[name == "model.obj" ? bytes.find("v 1") + 2 : bytes.size() - 2] = '3';
        scene.folder.write(name, changed);
        fs::last_write_time(file, time);
        CHECK(!scene.hit());
        CHECK(bytesOf(scene.load()) == scene.fresh());
        CHECK(scene.hit());
        scene.folder.write(name, bytes);
        CHECK(!scene.hit());
        CHECK(bytesOf(scene.load()) == before);
        scene.folder.write(name, bytes + " ");
        CHECK(!scene.hit());
        scene.folder.write(name, bytes);
    }
    fs::last_write_time(scene.obj, fs::file_time_type::clock::now() + std::chrono::hours(1));
    CHECK(scene.hit());
    fs::remove(scene.colour);
    CHECK(!scene.hit());
    CHECK(scene.load().warnings.size() == 3);
}

TEST_CASE("model cache: a file that was missing and appears makes a model stale",
          "[unit][engine]") {
    for (const std::string name : {"none.mtl", "missing.ppm"}) {
        INFO(name);
        const CachedModel scene;
        scene.load();
        REQUIRE(scene.hit());
        scene.folder.write(name, name == "none.mtl" ? "newmtl c\n" : image(1, 1, "abc"));
        CHECK(!scene.hit());
        CHECK(scene.load().warnings.size() == 1);
        CHECK(scene.hit());
    }
}

TEST_CASE("model cache: the same file under another name is another model", "[unit][engine]") {
    const CachedModel scene;
    scene.load();
    const fs::path detour = scene.folder.path() / "." / "model.obj";
    CHECK(!ModelCache(scene.cache_folder, detour, FileAccess({}, detour)).load());
    const Result<ObjModel> model = loadObj(detour, {scene.cache_folder});
    REQUIRE(model);
    CHECK(model->warnings == loadObj(detour)->warnings);
}

TEST_CASE("model cache: damaged files are as good as absent and are made again", "[unit][engine]") {
    const CachedModel scene;
    const std::string model = bytesOf(scene.load());
    const std::string good = scene.entry();
    REQUIRE(good.size() > 500);
    const auto refused = [&](const std::string& bytes) {
        scene.setEntry(bytes);
        return !scene.hit();
    };
    REQUIRE(!refused(good));
    for (size_t at = 0; at < good.size(); ++at) {
        std::string bad = good;
        bad[at] = char(bad[at] ^ (1 << (at % 8)));
        if (!refused(bad)) {
            FAIL("a flipped bit in byte " << at << " of " << good.size() << " goes unnoticed");
        }
        if (at % 7 == 0 && !refused(good.substr(0, at))) {
            FAIL("cut to " << at << " of " << good.size() << " bytes goes unnoticed");
        }
    }
    CHECK(refused(good + "x"));
    CHECK(refused(""));
    CHECK(bytesOf(scene.load()) == model);
    CHECK(scene.hit());
}

TEST_CASE("model cache: a folder that cannot be used costs time only", "[unit][engine]") {
    const CachedModel scene;
    const std::string model = scene.fresh();
    const fs::path blocked = scene.folder.write("a file", "not a folder");
    for (const fs::path& folder : {blocked, blocked / "below", fs::path("/proc/none")}) {
        const Result<ObjModel> loaded = loadObj(scene.obj, {folder});
        REQUIRE(loaded);
        CHECK(bytesOf(*loaded) == model);
    }
    fs::create_directories(scene.cache().file());  // in the entry's place
    CHECK(bytesOf(scene.load()) == model);
    CHECK(bytesOf(scene.load()) == model);
}

TEST_CASE("model cache: small models, and files that are no models, are not kept",
          "[unit][engine]") {
    const TempFolder folder;
    const fs::path cache = folder.path() / "cache";
    const fs::path small = folder.write("small.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const fs::path broken = folder.write("broken.obj", "f 1 2 3\n#" + std::string(2 << 20, 'x'));
    REQUIRE(loadObj(small, {cache}));
    const Result<ObjModel> failed = loadObj(broken, {cache});
    REQUIRE(!failed);
    CHECK(failed.error().message == loadObj(broken).error().message);
    CHECK(!fs::exists(cache));
}

TEST_CASE("model cache: bytes that fit their hash by design give a sound model or none",
          "[unit][engine]") {
    const CachedModel scene;
    const ObjModel good = scene.load();
    const FlatModel flat = flatten({"key", {{"a file", {1, 2, 3}}}}, good);
    std::vector<ArrayInfo> infos;
    std::string arrays;
    for (const FlatArray& array : flat.arrays) {
        infos.push_back(array.info());
        arrays += array.bytes;
    }
    const auto read = [&](const std::string& table, const std::vector<ArrayInfo>& sizes) {
        ModelOrigin origin;
        std::optional<ObjModel> model(std::in_place);
        const std::vector<ModelFill> fills = unflatten(table, sizes, origin, *model);
        std::istringstream stream(arrays);
        bool filled = !fills.empty();
        for (const ModelFill& fill : fills) {
            filled = filled && fill.run(stream);
        }
        return filled && isSound(*model) ? std::move(model) : std::nullopt;
    };
    const auto intact = read(flat.table, infos);
    REQUIRE(intact);
    CHECK(bytesOf(*intact) == bytesOf(good));
    std::mt19937 random(7);
    int sound = 0;
    for (int round = 0; round < 20000; ++round) {
        std::string table = flat.table;
        std::vector<ArrayInfo> sizes = infos;
        for (uint32_t changes = random() % 3 + 1; changes > 0; --changes) {
            table[random() % table.size()] = char(random() % 4 == 0 ? random() : random() % 4);
        }
        if (round % 4 == 0) {
            table.resize(random() % table.size());
        }
        if (round % 5 == 0) {
            sizes[random() % sizes.size()].bytes = random() % 64;
        }
        const auto model = read(table, sizes);
        sound += model ? 1 : 0;
        if (model && model->mesh.indices != good.mesh.indices) {
            FAIL("arrays are hashed");
        }
    }
    CHECK(sound > 1000);   // names, colours
    CHECK(sound < 15000);  // counts, sizes
}

TEST_CASE("model cache: several may read and write the same model at once", "[unit][engine]") {
    const CachedModel scene;
    const std::string model = scene.fresh();
    std::vector<std::thread> threads;
    std::vector<char> same(4);
    for (size_t t = 0; t < same.size(); ++t) {
        threads.emplace_back([&, t] {
            same[t] = 1;
            for (int i = 0; i < 8; ++i) {
                const Result<ObjModel> loaded = loadObj(scene.obj, {scene.cache_folder});
                same[t] = same[t] != 0 && loaded && bytesOf(*loaded) == model;
                std::error_code ignored;
                fs::remove(scene.cache().file(), ignored);
            }
        });
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
    CHECK(same == std::vector<char>(4, 1));
    CHECK(bytesOf(scene.load()) == model);
    size_t files = 0;
    for ([[maybe_unused]] const auto& entry : fs::directory_iterator(scene.cache_folder)) {
        ++files;
    }
    CHECK(files == 1);
}

TEST_CASE("model cache: the models not used for longest go first when there is no room",
          "[unit][engine]") {
    const TempFolder folder;
    const auto now = fs::file_time_type::clock::now();
    const auto write = [&](const std::string& name, int hours_old) {
        const fs::path file = folder.write(name, std::string(100, 'x'));
        fs::last_write_time(file, now - std::chrono::hours(hours_old));
        return file;
    };
    const fs::path old = write("a.model", 3), older = write("b.model", 4),
                   fresh = write("c.model", 2);
    const fs::path other = write("reference.entry", 9);
    const fs::path abandoned = write("d.model.1.unfinished", 2);
    const fs::path growing = write("e.model.2.unfinished", 0);
    pruneModels(folder.path(), 250);
    CHECK(fs::exists(fresh));
    CHECK(fs::exists(old));
    CHECK(!fs::exists(older));
    CHECK(fs::exists(other));
    CHECK(!fs::exists(abandoned));
    CHECK(fs::exists(growing));
    pruneModels(folder.path(), 300);
    CHECK(fs::exists(old));
    pruneModels(folder.path(), 0);
    CHECK(!fs::exists(fresh));
    pruneModels(folder.path() / "none", 0);
}

TEST_CASE("model cache: numbers that would lead the rasterizer astray are no model",
          "[unit][engine]") {
    const CachedModel scene;
    const ObjModel good = scene.load();
    REQUIRE(isSound(good));
    const auto broken = [&](const auto& damage) {
        ObjModel model = good;
        damage(model);
        InputLog log;
        REQUIRE(log.read(scene.obj));
        scene.cache().store(model, log);
        return !scene.hit();
    };
    CHECK(!broken([](ObjModel&) {}));
    CHECK(broken([](ObjModel& m) { m.mesh.indices[1] = m.mesh.vertexCount(); }));
    CHECK(broken([](ObjModel& m) { m.mesh.indices.pop_back(); }));
    CHECK(broken([](ObjModel& m) { m.mesh.y.pop_back(); }));
    CHECK(broken([](ObjModel& m) { m.mesh.attributes.pop_back(); }));
    CHECK(broken([](ObjModel& m) { m.mesh.tangents.clear(); }));
    CHECK(broken([](ObjModel& m) { m.mesh.parts[1].first_triangle = 0; }));
    CHECK(broken([](ObjModel& m) { m.mesh.parts[1].material = 2; }));
    CHECK(broken([](ObjModel& m) { m.mesh.z[0] = NAN; }));
    CHECK(broken([](ObjModel& m) { m.mesh.attributes[0].u = 1e9f; }));
    CHECK(broken([](ObjModel& m) { m.mesh.tangents[0].handedness = 0; }));
    CHECK(broken([](ObjModel& m) { m.materials[0].colour_texture = 2; }));
    CHECK(broken([](ObjModel& m) { m.materials[0].alpha_texture = -2; }));
    CHECK(broken([](ObjModel& m) { m.materials[0].shininess = 0; }));
    CHECK(broken([](ObjModel& m) { m.materials[0].diffuse[1] = INFINITY; }));
    CHECK(broken([](ObjModel& m) { m.materials[0].alpha_mode = AlphaMode{3}; }));
    CHECK(broken([](ObjModel& m) { m.material_names.pop_back(); }));
    CHECK(broken([](ObjModel& m) { m.textures[0].texels[0] = UINT32_MAX; }));
    CHECK(broken([](ObjModel& m) { m.textures[0].texels.pop_back(); }));
    CHECK(broken([](ObjModel& m) { m.textures[0].levels.clear(); }));
    CHECK(broken([](ObjModel& m) { m.textures[0].levels[0].width = 6; }));
    CHECK(broken([](ObjModel& m) { m.textures[0].levels[2].offset = 18; }));
    CHECK(broken([](ObjModel& m) { --m.textures[0].levels[1].stride; }));
    CHECK(broken([](ObjModel& m) { m.textures[0].wrap = Wrap{2}; }));
    CHECK(broken([](ObjModel& m) { m.alpha_textures[0].texels.pop_back(); }));
}
