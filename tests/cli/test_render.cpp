// `stillframe render`, as a whole.

#include <catch2/catch.hpp>

#include "engine/image_file.h"
#include "tests/cli/shell.h"
#include "tests/support/data_path.h"

namespace still::test {
namespace {

using Names = std::vector<std::string>;

const std::string kSmall = " --resolution 48x32 --threads 2 ";

Ran render(const TempFolder& folder, const std::string& arguments) {
    return shell(folder.path(), "stillframe render " + arguments);
}

}  // namespace

TEST_CASE("render: one frame becomes one picture of the wanted size, silently", "[cli]") {
    const TempFolder folder;
    const Ran ran = render(folder, "builtin:cubes --output shot.png --resolution 49,33");
    CHECK(ran.code == 0);
    CHECK(ran.out.empty());
    CHECK(ran.err.empty());
    CHECK(filesIn(folder.path()) == Names{"shot.png"});
    const auto image = readImageFile(folder.path() / "shot.png");
    REQUIRE(image.has_value());
    CHECK(image->width() == 49);
    CHECK(image->height() == 33);
}

TEST_CASE("render: several frames are numbered by themselves or by a pattern", "[cli]") {
    const TempFolder folder;
    CHECK(render(folder, "builtin:cubes -o a.png --frames 2 --start 9" + kSmall).code == 0);
    CHECK(render(folder, "builtin:cubes -o b.{frame}.png --frames 2 --start 9" + kSmall).code == 0);
    CHECK(render(folder, "builtin:cubes -o c{frame:3}.png --start 7" + kSmall).code == 0);
    CHECK(render(folder, "builtin:cubes -o d-%04d.png --frames 1" + kSmall).code == 0);
    CHECK(filesIn(folder.path()) ==
          Names{"a.0009.png", "a.0010.png", "b.10.png", "b.9.png", "c007.png", "d-0000.png"});
}

TEST_CASE("render: a frame has the same bytes alone as among others", "[cli]") {
    const TempFolder folder;
    CHECK(render(folder, "builtin:cubes -o many.%d.png --frames 4" + kSmall).code == 0);
    CHECK(render(folder, "builtin:cubes -o late.%d.png --start 2 --frames 2" + kSmall).code == 0);
    CHECK(contentsOf(folder.path() / "many.3.png") == contentsOf(folder.path() / "late.3.png"));
}

TEST_CASE("render: - streams the picture and nothing else", "[cli]") {
    const TempFolder folder;
    CHECK(render(folder, "builtin:triangle -o file.png" + kSmall).code == 0);
    const Ran ran = render(folder, "builtin:triangle -o -" + kSmall);
    CHECK(ran.code == 0);
    CHECK(ran.err.empty());
    CHECK(ran.out == contentsOf(folder.path() / "file.png"));
}

TEST_CASE("render: hashes do not depend on threads, SIMD, shading or the build's best", "[cli]") {
    const TempFolder folder;
    const std::string base = "builtin:zoo --hash --frames 2 --resolution 100x70 ";
    const Ran ran = render(folder, base);
    CHECK(ran.code == 0);
    CHECK(ran.out.starts_with("frame 0 output "));
    CHECK(std::count(ran.out.begin(), ran.out.end(), '\n') == 2);
    for (const char* other : {"--threads 1", "--threads 3", "--simd scalar", "--shading forward"}) {
        INFO(other);
        CHECK(render(folder, base + other).out == ran.out);
    }
}

TEST_CASE("render: a single picture of a still scene is finished, not raw", "[cli]") {
    const TempFolder folder;
    const std::string base = "builtin:triangle --hash --resolution 60x40 ";
    const std::string finished = render(folder, base).out;
    CHECK(finished == render(folder, base + "--samples 64").out);
    CHECK(finished != render(folder, base + "--samples 1").out);
    // The same samples one by one, as frames, end in the same picture.
    const std::string frames = render(folder, base + "--frames 64").out;
    const auto output = [](const std::string& line) {
        return line.substr(line.find("output"), sizeof "output 0123456789abcdef" - 1);
    };
    CHECK(output(finished) == output(frames.substr(frames.find("frame 63"))));
}

TEST_CASE("render: --json has the promised keys, and hashes when asked", "[cli]") {
    const TempFolder folder;
    const Ran ran = render(folder, "builtin:cubes --json --hash --frames 3 --simd scalar" + kSmall);
    CHECK(ran.code == 0);
    CHECK(ran.err.empty());
    size_t at = 0;
    for (const char* key :
         {"scene",  "triangles",     "width",          "height",    "frames", "threads", "simd",
          "stages", "transform_bin", "min_ms",         "median_ms", "p95_ms", "raster",  "taa",
          "output", "total",         "peak_rss_bytes", "hashes",    "frame",  "output",  "color",
          "depth",  "normal",        "motion",         "id"}) {
        INFO(key);
        at = ran.out.find('"' + std::string(key) + "\":", at);
        REQUIRE(at != std::string::npos);
    }
    CHECK(render(folder, "builtin:cubes --json" + kSmall).out.find("hashes") == std::string::npos);
}

TEST_CASE("render: --dump writes a picture of each plane beside the output", "[cli]") {
    const TempFolder folder;
    const std::string planes = "color,depth,normal,motion,id,confidence";
    CHECK(render(folder, "builtin:cubes -o x.png --dump " + planes + kSmall).code == 0);
    CHECK(filesIn(folder.path()) == Names{"x.color.png", "x.confidence.png", "x.depth.png",
                                          "x.id.png", "x.motion.png", "x.normal.png", "x.png"});
    CHECK(
        render(folder, "builtin:cubes -o y.gif --aa none --frames 2 --dump normal,motion" + kSmall)
            .code == 0);
    const Names names = filesIn(folder.path());
    CHECK(std::count(names.begin(), names.end(), "y.0001.motion.png") == 1);
    CHECK(std::count(names.begin(), names.end(), "y.gif") == 1);
}

TEST_CASE("render: a camera file brings its size and its number of frames", "[cli]") {
    const TempFolder folder;
    const std::string frame =
        R"({"view":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,-5,1],)"
        R"("proj":[1,0,0,0,0,1,0,0,0,0,-1.02,-1,0,0,-0.2,0],"jitter":[0.25,-0.25]})";
    folder.write("c.json", R"({"width":40,"height":20,"frames":[)" + frame + "," + frame + "]}");
    const std::string base = "builtin:triangle --cameras c.json --json ";
    const std::string own = render(folder, base).out;
    CHECK(own.find("\"width\": 40") != std::string::npos);
    CHECK(own.find("\"frames\": 2") != std::string::npos);
    const std::string typed = render(folder, base + "--resolution 64x64 --frames 1").out;
    CHECK(typed.find("\"width\": 64") != std::string::npos);
    CHECK(typed.find("\"frames\": 1") != std::string::npos);
}

TEST_CASE("render: an OBJ is framed for the wanted shape of picture", "[cli]") {
    const TempFolder folder;
    folder.write("quad.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n");
    for (const char* size : {"30x90", "90x30"}) {
        CHECK(render(folder, "quad.obj -o q.png --resolution " + std::string(size)).code == 0);
        const auto image = readImageFile(folder.path() / "q.png");
        REQUIRE(image.has_value());
        bool border = false;
        bool inside = false;
        for (int y = 0; y < image->height(); ++y) {
            for (int x = 0; x < image->width(); ++x) {
                const bool lit = image->at(x, y) != image->at(0, 0);
                const bool edge =
                    x == 0 || y == 0 || x == image->width() - 1 || y == image->height() - 1;
                border |= lit && edge;
                inside |= lit;
            }
        }
        CHECK(inside);
        CHECK_FALSE(border);
    }
}

TEST_CASE("render: an orbit moves the camera, and a full turn ends where it began", "[cli]") {
    const TempFolder folder;
    CHECK(
        render(folder, "builtin:cubes -o o.%d.png --orbit 90 --aa none --frames 3" + kSmall).code ==
        0);
    CHECK(contentsOf(folder.path() / "o.0.png") != contentsOf(folder.path() / "o.1.png"));
}

TEST_CASE("render: GIF and MP4 are whole files", "[cli]") {
    const TempFolder folder;
    CHECK(render(folder, "builtin:cubes -o a.gif --frames 3" + kSmall).code == 0);
    const std::string gif = contentsOf(folder.path() / "a.gif");
    CHECK(gif.starts_with("GIF89a"));
    CHECK(gif.ends_with(';'));
    if (shell(folder.path(), "command -v ffmpeg").code != 0) {
        WARN("no ffmpeg here: MP4 is not tested");
        return;
    }
    CHECK(render(folder, "builtin:cubes -o a.mp4 --frames 3 --resolution 49x33").code == 0);
    CHECK(contentsOf(folder.path() / "a.mp4").substr(4, 4) == "ftyp");
    CHECK(filesIn(folder.path()) == Names{"a.gif", "a.mp4"});
}

}  // namespace still::test
