// Golden pictures as a library: manifests, recordings, verdicts.

#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <sstream>

#include "engine/golden.h"
#include "engine/shapes.h"
#include "tests/support/data_path.h"
#include "tests/support/test_scene.h"

using namespace still;

namespace {

const std::string kCase = R"({"name": "a", "scene": "builtin:ball", "resolution": [70, 40])";

/// A ball that turns to another colour by a touch in frame `change`, if any.
Scene ball(int change) {
    Scene scene;
    scene.meshes.push_back(shapes::sphere(16, 8));
    scene.materials.push_back({.diffuse = {0.5f, 0.25f, 0.125f}});
    scene.materials.push_back({.diffuse = {0.5f, 0.25f, 0.126f}});
    scene.objects.emplace_back().name = "ball";
    scene.camera.eye.keys = {{0, {0, 0, 3}}};
    if (change >= 0) {
        scene.material_tracks.push_back({0, {}, {{change, 1}}});
    }
    return scene;
}

golden::Options withBall(int change) {
    golden::Options options;
    options.builtin = [change](const std::string& name) -> Result<Scene> {
        return name == "ball" ? Result<Scene>(ball(change)) : fail(name + ": expected ball");
    };
    return options;
}

std::string manifestError(const std::string& text) {
    const TempFolder folder;
    folder.write("golden.json", text);
    const auto manifest = golden::readManifest(folder.path());
    if (manifest) {
        return "none";
    }
    CHECK(isOneLineAbout(manifest.error().message, "golden.json"));
    return manifest.error().message.substr((folder.path() / "golden.json").string().size());
}

std::string caseError(const std::string& more) {
    return manifestError("{\"cases\": [" + kCase + more + "}]}");
}

/// Writes what the manifest's cases are now as their recordings.
void recordAll(const std::filesystem::path& folder, const golden::Options& options) {
    const auto manifest = golden::readManifest(folder);
    REQUIRE(manifest);
    for (const golden::Case& golden_case : manifest->cases) {
        const auto record = golden::renderCase(*manifest, golden_case, options);
        REQUIRE(record);
        std::ofstream(golden::recordFile(*manifest, golden_case.name))
            << golden::recordText(*record);
    }
}

golden::Record randomRecord(test::Random& random) {
    golden::Record record{random.integer(1, 300), random.integer(1, 200), {}};
    const int tiles = ((record.width + 63) / 64) * ((record.height + 63) / 64);
    int frame = 0;
    for (int k = random.integer(1, 3); k > 0; --k, frame += random.integer(1, 9)) {
        golden::Record::Frame& to = record.frames.emplace_back();
        to.frame = frame;
        for (StageHash& hash : to.stages) {
            hash.whole = uint64_t(random.integer(0, 1 << 30)) << 33;
            for (int tile = 0; tile < tiles; ++tile) {
                hash.tiles.push_back(uint32_t(random.integer(0, INT32_MAX)) * 2);
            }
        }
    }
    return record;
}

}  // namespace

TEST_CASE("golden: a manifest's cases say all they can say", "[unit][golden]") {
    const TempFolder folder;
    folder.write("golden.json", R"({"notes": "all keys", "cases": [
        {"name": "one", "scene": "a.json", "resolution": [320, 180], "frames": 3, "start": 5,
         "anti_aliasing": "taa:variance", "taa": "sigma=2,dering=on", "tone_map": "reinhard",
         "view": "top", "orbit_deg": 30, "comment": ""},
        {"name": "Two_2", "scene": "b.obj", "resolution": [1, 8192], "frames": [0, 7, 63],
         "anti_aliasing": "ssaa:16", "cameras": "c.json"},
        {"name": "3", "scene": "builtin:x", "resolution": [8, 8], "samples": 4, "colour": 1}]})");
    const auto manifest = golden::readManifest(folder.path());
    REQUIRE(manifest);
    REQUIRE(manifest->cases.size() == 3);
    const golden::Case& one = manifest->cases[0];
    CHECK(one.frames == std::vector<int>{5, 6, 7});
    CHECK(one.settings.width == 320);
    CHECK(one.settings.tone_map == ToneMap::reinhard);
    CHECK(one.settings.policy.sigma_fx8 == 512);
    CHECK(one.settings.camera.orbit_deg == 30);
    CHECK(one.settings.camera.orbit_frames == 8);
    CHECK(one.view == "top");
    const golden::Case& two = manifest->cases[1];
    CHECK(two.frames == std::vector<int>{0, 7, 63});
    CHECK(two.settings.anti_aliasing == AntiAliasing::ssaa);
    CHECK(two.settings.ssaa_samples == 16);
    CHECK(two.cameras == "c.json");
    CHECK(manifest->cases[2].samples == 4);
    CHECK(manifest->cases[2].frames == std::vector<int>{0});
    REQUIRE(manifest->warnings.size() == 1);
    CHECK(manifest->warnings[0].find("/cases/2/colour: unknown key") != std::string::npos);
}

TEST_CASE("golden: a broken manifest is refused with file, place and what was expected",
          "[unit][golden]") {
    CHECK(manifestError("{") != "none");
    CHECK(manifestError("{}") == ": /: expected the key \"cases\"");
    CHECK(manifestError(R"({"cases": []})") ==
          ": /cases: expected an array of at least 1, found an array of 0");
    CHECK(manifestError(R"({"cases": [7]})") == ": /cases/0: expected an object, found 7");
    CHECK(manifestError("{\"cases\": [" + kCase + "}, " + kCase + "}]}") ==
          ": /: expected cases with different names, found two called a");
    CHECK(caseError("") == "none");
    CHECK(caseError(R"(, "frames": 0)") ==
          ": /cases/0/frames: expected a whole number from 1 to 1000000, found 0");
    CHECK(caseError(R"(, "frames": [3, 3])") ==
          ": /cases/0/frames/1: expected a frame after the one before, found 3");
    CHECK(caseError(R"(, "frames": [3], "start": 1)") ==
          ": /cases/0/start: expected no start where the frames are a list");
    CHECK(caseError(R"(, "anti_aliasing": "taa:nobody")").find("the presets are still, fast") !=
          std::string::npos);
    CHECK(caseError(R"(, "anti_aliasing": "fxaa", "taa": "sigma=1")") ==
          ": /cases/0/taa: expected \"anti_aliasing\" to be a kind of taa");
    CHECK(caseError(R"(, "taa": "sigma=x")").starts_with(": /cases/0/taa: sigma=x: sigma takes"));
    CHECK(caseError(R"(, "tone_map": "film")") ==
          ": /cases/0/tone_map: expected none or reinhard, found \"film\"");
    CHECK(caseError(R"(, "view": "x", "cameras": "c.json")") ==
          ": /cases/0/cameras: expected neither view nor orbit_deg beside a camera file");
    for (const char* name : {"../a", "a b", "a.b", ".hidden", "ü"}) {
        const std::string text = R"({"cases": [{"name": ")" + std::string(name) +
                                 R"(", "scene": "x", "resolution": [8, 8]}]})";
        CHECK(manifestError(text).starts_with(": /cases/0/name: expected a name"));
    }
    CHECK(manifestError(R"({"cases": [{"name": "a", "scene": "x", "resolution": [0, 8]}]})") ==
          ": /cases/0/resolution/0: expected a whole number from 1 to 8192, found 0");
    std::string many = R"({"cases": [)";
    for (int i = 0; i < 5; ++i) {
        many += std::string(i == 0 ? "" : ",") + R"({"name": "n)" + std::to_string(i) +
                R"(", "scene": "x", "resolution": [8, 8], "frames": 1000000})";
    }
    CHECK(manifestError(many + "]}") == ": /cases/4: expected at most 4000000 frames in all cases");
}

TEST_CASE("golden: every case is in exactly one shard, in any number of shards", "[unit][golden]") {
    golden::Manifest manifest;
    for (int i = 0; i < 7; ++i) {
        manifest.cases.emplace_back().name = char('a' + i);
    }
    for (int shards = 1; shards <= 9; ++shards) {
        std::string names;
        for (int shard = 1; shard <= shards; ++shard) {
            golden::Options options;
            options.shard = shard;
            options.shards = shards;
            const auto part = golden::chosenCases(manifest, options);
            for (const golden::Case* one : *part) {
                names += one->name;
            }
        }
        std::sort(names.begin(), names.end());
        CHECK(names == "abcdefg");
    }
    golden::Options options;
    options.only = {"f", "b"};
    REQUIRE(golden::chosenCases(manifest, options)->size() == 2);
    CHECK(golden::chosenCases(manifest, options)->front()->name == "b");
    options.only = {"b", "x"};
    CHECK(golden::chosenCases(manifest, options).error().message ==
          "x: expected names of cases out of a, b, c, d, e, f, g");
}

TEST_CASE("golden: recordings come back from their text as they went", "[unit][golden]") {
    const TempFolder folder;
    test::Random random(3);
    for (int k = 0; k < 20; ++k) {
        const golden::Record record = randomRecord(random);
        const auto back = golden::readRecord(folder.write("a.hashes", golden::recordText(record)));
        REQUIRE(back);
        CHECK(*back == record);
    }
}

TEST_CASE("golden: a recording that is cut or damaged is refused with its line, or is another one",
          "[unit][golden]") {
    const TempFolder folder;
    test::Random random(4);
    const golden::Record record = randomRecord(random);
    const std::string text = golden::recordText(record);
    const auto refused = [&](const std::string& bytes) {
        const auto read = golden::readRecord(folder.write("a.hashes", bytes));
        if (!read) {
            CHECK(isOneLineAbout(read.error().message, "a.hashes:"));
            CHECK(read.error().message.find("expected ") != std::string::npos);
        }
        return !read;
    };
    CHECK(refused(""));
    CHECK(refused("stillframe golden 2" + text.substr(19)));
    CHECK(refused(text + "\n"));
    CHECK(refused(text.substr(0, text.size() / 2)));
    for (int k = 0; k < 300; ++k) {
        std::string damaged = text;
        // Not bit 5, which only makes hexadecimal digits large.
        damaged[size_t(random.integer(0, int(text.size()) - 1))] ^= char(1 << random.integer(0, 4));
        if (!refused(damaged)) {
            CHECK_FALSE(*golden::readRecord(folder.path() / "a.hashes") == record);
        }
    }
}

TEST_CASE("golden: tiles at the right and lower edge end with the picture", "[unit][golden]") {
    const golden::TileRectangle r = golden::tileRectangle(5, 150, 70);
    CHECK((r.tile_x == 2 && r.tile_y == 1));
    CHECK((r.x == 128 && r.y == 64 && r.width == 22 && r.height == 6));
}

TEST_CASE("golden: tiles of smaller frames are told as the picture's pixels", "[unit][golden]") {
    golden::FrameDifference difference;
    difference.width = 150;
    difference.height = 70;
    difference.frame_width = 75;
    difference.frame_height = 35;
    difference.stages.stage = Stage::depth;
    const golden::TileRectangle r = golden::tileRectangle(difference, 1);
    CHECK((r.tile_x == 1 && r.tile_y == 0));
    CHECK((r.x == 128 && r.y == 0 && r.width == 22 && r.height == 70));
    difference.stages.stage = Stage::output;
    CHECK(golden::tileRectangle(difference, 5).tile_y == 1);
}

TEST_CASE("golden: verify() is true as long as every bit is as recorded", "[unit][golden]") {
    const TempFolder folder;
    folder.write("golden.json",
                 "{\"cases\": [" + kCase + R"(, "frames": 3, "anti_aliasing": "taa:fast"}]})");
    const golden::Options right = withBall(-1);

    const golden::Verdict none = golden::verify(folder.path(), right);
    CHECK_FALSE(none.ok);
    CHECK(none.message.find("a.hashes is not there\naccept with: stillframe golden record ") !=
          std::string::npos);

    recordAll(folder.path(), right);
    const golden::Verdict equal = golden::verify(folder.path(), right);
    CHECK(equal);
    CHECK(equal.message == "golden: 1 equal");

    const golden::Verdict changed = golden::verify(folder.path(), withBall(2));
    CHECK_FALSE(changed);
    INFO(changed.message);
    CHECK(
        changed.message.starts_with("a: frame 2: color is the first stage that differs, in tile "
                                    "(0, 0), pixels 0,0 to 63,39"));
    CHECK(changed.message.find("; 1 of 3 frames differ\n") != std::string::npos);
    CHECK(changed.failed == std::vector<std::string>{"a"});
    std::ostringstream stream;
    stream << changed;
    CHECK(stream.str() == changed.message);
}

TEST_CASE("golden: upscaled pictures are recorded and verified like others", "[unit][golden]") {
    const TempFolder folder;
    folder.write("golden.json", "{\"cases\": [" + kCase +
                                    R"(, "frames": 3, "anti_aliasing": "taa:performance"}]})");
    recordAll(folder.path(), withBall(-1));
    CHECK(golden::verify(folder.path(), withBall(-1)));
    const golden::Verdict changed = golden::verify(folder.path(), withBall(2));
    CHECK_FALSE(changed);
    CHECK(
        changed.message.starts_with("a: frame 2: color is the first stage that differs, in tile "
                                    "(0, 0), pixels 0,0 to 69,39"));
}

TEST_CASE("golden: verify() tells what keeps it from comparing", "[unit][golden]") {
    const TempFolder folder;
    const golden::Options options = withBall(-1);
    const auto verdict = [&](const std::string& more) {
        folder.write("golden.json", "{\"cases\": [" + kCase + more + "}]}");
        const golden::Verdict result = golden::verify(folder.path(), options);
        CHECK_FALSE(result.ok);
        return result.message;
    };
    CHECK(isOneLineAbout(golden::verify(folder.path() / "nowhere").message, "golden.json"));
    folder.write("golden.json", "{\"cases\": [" + kCase + "}]}");
    recordAll(folder.path(), options);
    CHECK(golden::verify(folder.path(), options));
    CHECK(verdict(R"(, "frames": 2)").find("a.hashes: recorded frame 0, expected frames 0 to 1") !=
          std::string::npos);
    CHECK(verdict(R"(, "view": "top")").find("/cases/0/view: top: the scene has no views") !=
          std::string::npos);
    CHECK(verdict(R"(, "cameras": "none.json")").find("none.json") != std::string::npos);
    folder.write("golden.json",
                 R"({"cases": [{"name": "a", "scene": "builtin:ball", "resolution": [71, 40]}]})");
    CHECK(
        golden::verify(folder.path(), options).message.find("recorded at 70x40, expected 71x40") !=
        std::string::npos);
    folder.write("golden.json",
                 R"({"cases": [{"name": "a", "scene": "builtin:cube", "resolution": [70, 40]}]})");
    CHECK(golden::verify(folder.path(), options).message.find("/cases/0/scene: cube: expected") !=
          std::string::npos);
    CHECK(golden::verify(folder.path()).message.find("no built-in scenes are known here") !=
          std::string::npos);
    folder.write("a.hashes", "?");
    CHECK(golden::verify(folder.path(), options).message.find("a.hashes:1: expected") !=
          std::string::npos);
}

TEST_CASE("golden: a single picture of what stands still is finished, as render makes it",
          "[unit][golden]") {
    const TempFolder folder;
    const auto output = [&](const std::string& more) {
        folder.write("golden.json", "{\"cases\": [" + kCase + more + "}]}");
        const auto manifest = golden::readManifest(folder.path());
        REQUIRE(manifest);
        const auto record = golden::renderCase(*manifest, manifest->cases[0], withBall(-1));
        REQUIRE(record);
        return record->frames.back().stages[size_t(Stage::output)];
    };
    const StageHash finished = output("");
    CHECK(finished == output(R"(, "samples": 64)"));
    CHECK(finished == output(R"(, "frames": 64)"));
    CHECK_FALSE(finished == output(R"(, "samples": 1)"));
}

TEST_CASE("golden: the accept command survives a shell", "[unit][golden]") {
    CHECK(golden::acceptCommand("tests/golden", {"a", "b-2"}) ==
          "stillframe golden record tests/golden --only a,b-2");
    CHECK(golden::acceptCommand("it's here", {"a"}) ==
          "stillframe golden record 'it'\\''s here' --only a");
}
