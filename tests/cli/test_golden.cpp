// `stillframe golden` as people run it.

#include <algorithm>
#include <catch2/catch.hpp>

#include "demos/stillframe/png.h"
#include "engine/image_file.h"
#include "tests/cli/shell.h"
#include "tests/support/data_path.h"

namespace still::test {
namespace {

using Names = std::vector<std::string>;

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

using Texels = std::vector<std::pair<int, int>>;
const Texels kOne{{5, 5}};

/// A picture of 12 × 8 texels; the lowest bit of one channel of `odd` texels is flipped.
void writeTexture(const std::filesystem::path& file, const Texels& odd) {
    Image<Rgb8> image(12, 8);
    for (int y = 0; y < 8; ++y) {
        for (int x = 0; x < 12; ++x) {
            image.at(x, y) = {200, 160, uint8_t(40 + 10 * x + y)};
        }
    }
    for (const auto& [x, y] : odd) {
        image.at(x, y).g ^= 1;
    }
    command::Interruption interruption;
    REQUIRE(command::savePng(file, std::as_const(image).view(), interruption));
}

/// A wall that fills a picture of 192 × 128, so that a texel covers 16 × 16 pixels, and is shown
/// from frame 3 on with another image.
void writeWall(const TempFolder& folder) {
    writeTexture(folder.path() / "early.png", {});
    writeTexture(folder.path() / "late.png", {});
    folder.write("wall.obj",
                 "mtllib wall.mtl\nv -1.5 -1 0\nv 1.5 -1 0\nv 1.5 1 0\nv -1.5 1 0\nvt 0 0\nvt 1 0\n"
                 "vt 1 1\nvt 0 1\nusemtl wall\nf 1/1 2/2 3/3 4/4\n");
    folder.write("wall.mtl", "newmtl wall\nKd 1 1 1\nmap_Kd early.png\n");
    folder.write("wall.json", R"({"objects": [{"name": "wall", "obj": "wall.obj", "materials":
        [{"name": "wall", "swaps": [{"frame": 3, "material":
            {"diffuse": [1, 1, 1], "image": "late.png"}}]}]}],
        "lights": {"ambient": {"colour": [1, 1, 1]}},
        "camera": {"eye": [0, 0, 10], "target": [0, 0, 0], "fov_y_deg": 11.421186}})");
}

/// Three cases of the wall, and a scene that has nothing to do with it.
const std::string kManifest = R"({"cases": [
    {"name": "wall", "scene": "wall.json", "resolution": [192, 128], "frames": 4},
    {"name": "wall-variance", "scene": "wall.json", "resolution": [192, 128], "frames": 4,
     "anti_aliasing": "taa:variance"},
    {"name": "wall-raw", "scene": "wall.json", "resolution": [192, 128], "frames": [1, 3, 4],
     "anti_aliasing": "none"},
    {"name": "cubes", "scene": "builtin:cubes", "resolution": [96, 54], "frames": 2}]})";

}  // namespace

TEST_CASE("golden: finds a one-bit change made on purpose in one tile of one frame, and names it",
          "[cli]") {
    const TempFolder folder;
    writeWall(folder);
    folder.write("golden.json", kManifest);
    REQUIRE(shell(folder.path(), "stillframe golden record .").code == 0);
    CHECK(shell(folder.path(), "stillframe golden verify .").code == 0);

    writeTexture(folder.path() / "late.png", kOne);
    const Ran ran = shell(folder.path(), "stillframe golden verify .");
    INFO(ran.out << ran.err);
    CHECK(ran.code == 1);
    CHECK(ran.err.empty());
    const std::string place =
        ": frame 3: color is the first stage that differs, in tile (1, 1), pixels 64,64 to "
        "127,127; ";
    for (const std::string name : {"wall", "wall-variance"}) {
        CHECK(has(ran.out, name + place));
        CHECK(has(ran.out.substr(ran.out.find(name + place)), "; 1 of 4 frames differ\n"));
    }
    CHECK(has(ran.out, "wall-raw" + place));
    CHECK(has(ran.out, "4 cases: 1 equal, 3 different\nreport: ./out/report.html\n"));
    CHECK(has(ran.out,
              "accept with: stillframe golden record . --only wall,wall-variance,wall-raw\n"));

    SECTION("the pictures show it, and the first pixel lies in the tile") {
        const auto out = folder.path() / "out";
        const auto actual = readImageFile(out / "wall.actual.png");
        const auto expected = readImageFile(out / "wall.expected.png");
        const auto diff = readImageFile(out / "wall.diff.png");
        REQUIRE((actual && expected && diff));
        int first_x = -1, first_y = -1;
        for (int y = 0; y < 128; ++y) {
            for (int x = 0; x < 192; ++x) {
                const bool differs = actual->at(x, y) != expected->at(x, y);
                CHECK(differs == (diff->at(x, y).r == 255 && diff->at(x, y).b == 0));
                CHECK((!differs || (x / 64 == 1 && y / 64 == 1)));
                first_x = differs && first_y < 0 ? x : first_x;
                first_y = differs && first_y < 0 ? y : first_y;
            }
        }
        CHECK(has(ran.out, "pixels, first at " + std::to_string(first_x) + "," +
                               std::to_string(first_y) + ": "));
    }
    SECTION("the page holds three cases, without outside parts") {
        const std::string page = contentsOf(folder.path() / "out/report.html");
        CHECK(page.starts_with("<!DOCTYPE html>"));
        CHECK_FALSE(has(page, "http"));
        CHECK(has(page, "\"rectangles\":[[64,64,64,64]]"));
        CHECK(has(page, "\"diff\":\"data:image/png;base64,iVBOR"));
        CHECK_FALSE(has(page, "\"name\":\"cubes\""));
    }
    SECTION("JSON says the same") {
        const Ran json = shell(folder.path(), "stillframe golden verify . --json --only wall");
        CHECK(json.code == 1);
        std::string text = json.out;
        std::erase_if(text, [](char c) { return c == ' ' || c == '\n'; });
        CHECK(
            text.starts_with("{\"ok\":false,\"cases\":[{\"name\":\"wall\",\"result\":\"differs\""));
        CHECK(has(text,
                  "\"frames\":4,\"differing_frames\":1,\"frame\":3,\"stage\":\"color\","
                  "\"tile\":[1,1],\"rectangle\":[64,64,64,64],\"tiles\":1,\"first_pixel\":["));
    }
    SECTION("the printed command accepts the change, and touches nothing else") {
        const std::string cubes = contentsOf(folder.path() / "cubes.hashes");
        const size_t at = ran.out.find("stillframe golden record");
        const Ran accepted = shell(folder.path(), ran.out.substr(at));
        CHECK(accepted.out ==
              "wall: changed, 4 frames\nwall-variance: changed, 4 frames\nwall-raw: changed, 3 "
              "frames\n");
        CHECK(contentsOf(folder.path() / "cubes.hashes") == cubes);
        const Ran again = shell(folder.path(), "stillframe golden verify . --quiet");
        CHECK(again.code == 0);
        CHECK(again.out.empty());
        CHECK(filesIn(folder.path() / "out").empty());
    }
}

TEST_CASE("golden: the page's keys and buttons switch pictures in a real browser", "[cli]") {
    const TempFolder folder;
    if (shell(folder.path(), "command -v chromium").code != 0) {
        WARN("no chromium here: the page of differences is not tested");
        return;
    }
    writeWall(folder);
    folder.write("golden.json", kManifest);
    REQUIRE(shell(folder.path(), "stillframe golden record . --quiet").code == 0);
    writeTexture(folder.path() / "late.png", kOne);
    CHECK(shell(folder.path(), "stillframe golden verify .").code == 1);
    std::string page = contentsOf(folder.path() / "out/report.html");
    // Notes after each key what is seen: the name of the case and of its visible pictures.
    page.insert(page.rfind("</body>"), R"html(<script>
const notes = [];
const note = label => notes.push(label + "=" + $("#name").textContent + ":" +
  [...document.querySelectorAll("#picture img")].filter(image =>
    image.style.visibility === "visible").map(
    image => image.alt.split(" ")[0]).join("+"));
const press = key => {
  document.body.dispatchEvent(new KeyboardEvent("keydown", {key, bubbles: true}));
  note(key);
};
onload = () => {
  for (const key of ["e", " ", " ", "a", "d", "s", "j", "k", "k"]) press(key);
  $("[data-mode=actual]").click();
  note("click");
  press("z");
  notes.push("width=" + $("#picture").clientWidth);
  notes.push("outlines=" + document.querySelectorAll("#picture div.first").length);
  press("f");
  setTimeout(() => { note("later"); setTimeout(() => {
    note("still later");
    notes.push("wide=" + [...document.querySelectorAll("img")].map(i => i.naturalWidth).join());
    make("pre", document.body, notes.join(";")).id = "notes";
  }, 500); }, 500);
};
</script>)html");
    folder.write("page.html", page);
    const Ran ran =
        shell(folder.path(),
              "timeout 60 chromium --headless --no-sandbox --disable-gpu --dump-dom "
              "--user-data-dir=profile --virtual-time-budget=5000 page.html 2>/dev/null");
    const size_t at = ran.out.find("<pre id=\"notes\">");
    REQUIRE(at != std::string::npos);
    const std::string notes = ran.out.substr(at, ran.out.find("</pre>", at) - at);
    INFO(notes);
    CHECK(has(notes,
              ">e=wall:expected; =wall:actual; =wall:expected;a=wall:actual;d=wall:diff;"
              "s=wall:expected+actual;j=wall-variance:expected+actual;"
              "k=wall:expected+actual;k=wall-raw:expected+actual;click=wall-raw:actual;"
              "z=wall-raw:actual;width=384;outlines=1;"));
    CHECK(has(notes, ";wide=192,192,192"));
    // Flickering shows the two in turns.
    CHECK((has(notes, "later=wall-raw:expected;still later=wall-raw:actual") ||
           has(notes, "later=wall-raw:actual;still later=wall-raw:expected")));
}

TEST_CASE("golden: the first pixel is one of the first tile, if that has any", "[cli]") {
    const TempFolder folder;
    writeWall(folder);
    folder.write("golden.json", kManifest);
    REQUIRE(shell(folder.path(), "stillframe golden record . --quiet").code == 0);
    // The higher one lies in tile (2, 0).
    writeTexture(folder.path() / "late.png", {{2, 2}, {9, 1}});
    const Ran ran = shell(folder.path(), "stillframe golden verify . --only wall-raw --json");
    std::string text = ran.out;
    std::erase_if(text, [](char c) { return c == ' ' || c == '\n'; });
    INFO(text);
    CHECK(has(text, "\"tile\":[0,0],\"rectangle\":[0,0,64,64],\"tiles\":2,\"first_pixel\":["));
    const size_t at = text.find("\"first_pixel\":[") + sizeof("\"first_pixel\":[") - 1;
    CHECK(std::stoi(text.substr(at)) < 64);
    CHECK(has(text, "\"pixels\":"));
}

TEST_CASE("golden: verifying finds the same with any thread count and instruction set", "[cli]") {
    const TempFolder folder;
    writeWall(folder);
    folder.write("golden.json", kManifest);
    REQUIRE(shell(folder.path(), "stillframe golden record . --threads 1").code == 0);
    CHECK(shell(folder.path(), "stillframe golden verify . --threads 3 --simd scalar").code == 0);
}

TEST_CASE("golden: a case is what render makes with the same settings", "[cli]") {
    const TempFolder folder;
    folder.write("cameras.json", R"({"width": 8, "height": 8, "frames": [
        {"view": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,-5,1],
         "proj": [1,0,0,0, 0,1,0,0, 0,0,-1.02,-1, 0,0,-0.2,0]}]})");
    folder.write("scene.json", R"({"objects": [{"shape": "torus"}],
        "views": [{"name": "side", "eye": [9, 1, 0], "target": [0, 0, 0]}]})");
    const struct {
        std::string scene, keys, arguments;
    } cases[] = {
        {"builtin:cubes", R"("frames": 3, "orbit_deg": 20)", "--frames 3 --orbit 20"},
        {"builtin:zoo", R"("start": 2, "frames": 2, "anti_aliasing": "taa:variance",
            "taa": "sigma=2,jitter=r2")",
         "--start 2 --frames 2 --aa taa:variance --taa sigma=2,jitter=r2"},
        {"builtin:triangle", R"("cameras": "cameras.json")", "--cameras cameras.json"},
        {"scene.json", R"("tone_map": "reinhard")", "--tone-map reinhard"},
        {"scene.json", R"("view": "side", "anti_aliasing": "ssaa:5")", "--view side --aa ssaa:5"},
        {"scene.json", R"("samples": 3)", "--samples 3"},
    };
    for (const auto& c : cases) {
        INFO(c.scene << " " << c.keys);
        folder.write("golden.json",
                     R"({"cases": [{"name": "a", "resolution": [60, 40], "scene": ")" + c.scene +
                         "\", " + c.keys + "}]}");
        REQUIRE(shell(folder.path(), "stillframe golden record .").code == 0);
        // "0 depth HASH TILES" here, "frame 0 output HASH color HASH depth HASH …" there.
        const Ran recorded = shell(folder.path(),
                                   "grep -v '^st\\|^si\\|linear\\|motion\\|color' a.hashes | "
                                   "awk '{print $1, $2, $3}' | sort");
        const Ran rendered =
            shell(folder.path(), "stillframe render " + c.scene + " --resolution 60x40 --hash " +
                                     c.arguments +
                                     " | awk '{for (i = 3; i < NF; i += 2) print $2, $i, $(i + 1)}'"
                                     " | grep -v 'motion\\|color' | sort");
        CHECK(std::count(rendered.out.begin(), rendered.out.end(), '\n') >= 4);
        CHECK(recorded.out == rendered.out);
    }
}

TEST_CASE("golden: recording again writes the same bytes, and takes away only what it wrote",
          "[cli]") {
    const TempFolder folder;
    const std::string record = "stillframe golden record . --quiet";
    const auto manifest = [&](const std::string& cases) {
        folder.write("golden.json", "{\"cases\": [" + cases + "]}");
    };
    const std::string cubes =
        R"({"name": "cubes", "scene": "builtin:cubes", "resolution": [40, 30], "frames": )";
    const std::string triangle =
        R"(, {"name": "tri", "scene": "builtin:triangle", "resolution": [20, 10]})";
    manifest(cubes + "3}" + triangle);
    REQUIRE(shell(folder.path(), record).code == 0);
    const Names names = filesIn(folder.path());
    CHECK(names == Names{"cubes.0000.png", "cubes.0001.png", "cubes.0002.png", "cubes.hashes",
                         "golden.json", "tri.0000.png", "tri.hashes"});
    std::vector<std::string> bytes;
    for (const std::string& name : names) {
        bytes.push_back(contentsOf(folder.path() / name));
    }

    SECTION("from nothing, and over what is there") {
        for (const char* before : {"true", "rm *.png *.hashes", "rm tri.*", "echo > cubes.0001.png",
                                   "echo > cubes.hashes", "rm cubes.0002.png"}) {
            INFO(before);
            REQUIRE(shell(folder.path(), std::string(before) + "; " + record).code == 0);
            REQUIRE(filesIn(folder.path()) == names);
            for (size_t i = 0; i < names.size(); ++i) {
                CHECK(contentsOf(folder.path() / names[i]) == bytes[i]);
            }
        }
    }
    SECTION("frames and cases that are no more") {
        manifest(cubes + "[1, 2]}");
        folder.write("notes.hashes", "mine");
        folder.write("tri.0001.png", "mine, too");
        folder.write("other.png", "mine, too");
        const Ran ran = shell(folder.path(), "stillframe golden record .");
        CHECK(ran.out == "cubes: changed, 2 frames\ntri: removed\n");
        CHECK(filesIn(folder.path()) == Names{"cubes.0001.png", "cubes.0002.png", "cubes.hashes",
                                              "golden.json", "notes.hashes", "other.png",
                                              "tri.0001.png"});
    }
    SECTION("a picture that somebody has changed is not taken away") {
        manifest(cubes + "[1, 2]}");
        writeTexture(folder.path() / "cubes.0000.png", {});
        REQUIRE(shell(folder.path(), record).code == 0);
        CHECK(std::filesystem::exists(folder.path() / "cubes.0000.png"));
    }
    SECTION("--only leaves the rest alone") {
        manifest(cubes + "2}");
        CHECK(shell(folder.path(), record + " --only cubes").code == 0);
        CHECK(std::filesystem::exists(folder.path() / "tri.hashes"));
        CHECK_FALSE(std::filesystem::exists(folder.path() / "cubes.0002.png"));
    }
}

TEST_CASE("golden: what is not recorded fails, with the command that records it", "[cli]") {
    const TempFolder folder;
    folder.write("golden.json", kManifest);
    writeWall(folder);
    REQUIRE(shell(folder.path(), "stillframe golden record . --quiet").code == 0);
    REQUIRE(shell(folder.path(), "rm cubes.hashes").code == 0);
    const Ran ran = shell(folder.path(), "stillframe golden verify .");
    CHECK(ran.code == 1);
    CHECK(ran.out ==
          "cubes: ./cubes.hashes is not there\n4 cases: 3 equal, 1 not recorded\n"
          "accept with: stillframe golden record . --only cubes\n");
    CHECK_FALSE(std::filesystem::exists(folder.path() / "out"));
}

TEST_CASE("golden: a picture that is lost or exchanged does not hide the difference", "[cli]") {
    const TempFolder folder;
    writeWall(folder);
    folder.write("golden.json", kManifest);
    REQUIRE(shell(folder.path(), "stillframe golden record . --quiet").code == 0);
    writeTexture(folder.path() / "late.png", kOne);
    for (const char* change : {"rm wall.0003.png", "cp wall.0002.png wall.0003.png"}) {
        const Ran ran =
            shell(folder.path(), std::string(change) + "; stillframe golden verify . --only wall");
        INFO(ran.out);
        CHECK(ran.code == 1);
        CHECK(has(ran.out,
                  "in tile (1, 1), pixels 64,64 to 127,127; ./wall.0003.png is not there "
                  "or not as recorded, so no pixels are compared; 1 of 4"));
        CHECK(filesIn(folder.path() / "out") == Names{"report.html", "wall.actual.png"});
    }
}

TEST_CASE("golden: what cannot be meant is refused with code 2 and one line", "[cli]") {
    const TempFolder folder;
    folder.write("golden.json", kManifest);
    for (const char* arguments :
         {"golden", "golden verify", "golden record", "golden approve .",
          "golden verify . --shard 2", "golden verify . --shard 0/2", "golden verify . --shard 3/2",
          "golden verify . --shard a/b", "golden verify . --shard 1/2x",
          "golden verify . --only nobody", "golden verify . --threads 0",
          "golden verify . --simd abacus", "golden record . --output x"}) {
        const Ran ran = shell(folder.path(), std::string("stillframe ") + arguments);
        INFO(arguments << "\n" << ran.err);
        CHECK(ran.code == 2);
        CHECK(isOneErrorLine(ran.err));
        CHECK(ran.out.empty());
        CHECK(filesIn(folder.path()) == Names{"golden.json"});
    }
}

TEST_CASE("golden: what cannot be read is said in one line with code 3, after the other cases",
          "[cli]") {
    const TempFolder folder;
    for (const char* action : {"record", "verify"}) {
        const Ran ran = shell(folder.path(), std::string("stillframe golden ") + action + " .");
        CHECK(ran.code == 3);
        CHECK(isOneErrorLine(ran.err));
        CHECK(has(ran.err, "golden.json"));
    }
    writeWall(folder);
    folder.write("golden.json", kManifest);
    REQUIRE(shell(folder.path(), "stillframe golden record . --quiet").code == 0);
    writeTexture(folder.path() / "late.png", kOne);
    REQUIRE(shell(folder.path(), "echo 'stillframe golden 1' > wall.hashes").code == 0);
    const Ran ran = shell(folder.path(), "stillframe golden verify .");
    CHECK(ran.code == 3);
    CHECK(ran.err == "stillframe: wall: ./wall.hashes:2: expected size WIDTHxHEIGHT, found \"\"\n");
    CHECK(has(ran.out, "4 cases: 1 equal, 2 different, 1 with errors\n"));
    folder.write("wall.json", "{");
    const Ran broken = shell(folder.path(), "stillframe golden record . --only wall");
    CHECK(broken.code == 3);
    CHECK(isOneErrorLine(broken.err));
}

TEST_CASE("golden: warnings of manifest and scenes are told once, and not when quiet", "[cli]") {
    const TempFolder folder;
    folder.write("golden.json", R"({"cases": [{"name": "a", "scene": "scene.json",
        "resolution": [40, 30], "colour": 1}, {"name": "b", "scene": "scene.json",
        "resolution": [30, 40]}]})");
    folder.write("scene.json", R"({"objects": [{"shape": "torus"}], "sky": 2})");
    for (const char* action : {"record", "verify"}) {
        const std::string command = std::string("stillframe golden ") + action + " .";
        const Ran ran = shell(folder.path(), command);
        INFO(ran.err);
        CHECK(ran.code == 0);
        CHECK(std::count(ran.err.begin(), ran.err.end(), '\n') == 2);
        CHECK(has(ran.err, "stillframe: warning: ./golden.json: /cases/0/colour: unknown key"));
        CHECK(has(ran.err, "stillframe: warning: ./scene.json: /sky: unknown key"));
        CHECK(shell(folder.path(), command + " --quiet").err.empty());
    }
}

TEST_CASE("golden: a recording that is interrupted leaves nothing half-written", "[cli]") {
    const TempFolder folder;
    folder.write("golden.json", R"({"cases": [{"name": "c", "scene": "builtin:courtyard",
        "resolution": [640, 360], "frames": 200}]})");
    const Ran ran =
        shell(folder.path(), "timeout --signal=INT 0.4 " STILL_PROGRAM " golden record .");
    CHECK(ran.code == 124);
    CHECK(filesIn(folder.path()) == Names{"golden.json"});
}

TEST_CASE("golden: shards together do what one run does, whatever runs them", "[cli]") {
    const TempFolder folder;
    writeWall(folder);
    folder.write("golden.json", kManifest);
    REQUIRE(shell(folder.path(), "stillframe golden record . --quiet").code == 0);
    const Names all = filesIn(folder.path());
    const std::string whole = shell(folder.path(), "cat *.hashes").out;
    REQUIRE(shell(folder.path(), "rm *.hashes wall*.00*.png cubes*.png").code == 0);
    CHECK(shell(folder.path(),
                "for i in 1 2 3; do stillframe golden record . --quiet --shard $i/3 & done; wait")
              .code == 0);
    CHECK(filesIn(folder.path()) == all);
    CHECK(shell(folder.path(), "cat *.hashes").out == whole);
}

}  // namespace still::test
