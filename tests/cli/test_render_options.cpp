// `stillframe render`: cameras, backgrounds, inputs and outputs.

#include <catch2/catch.hpp>
#include <cmath>

#include "engine/image_file.h"
#include "engine/internal/image_load.h"
#include "tests/cli/shell.h"
#include "tests/support/data_path.h"

namespace still::test {
namespace {

using Names = std::vector<std::string>;

const std::string kSmall = " --resolution 64x36 --threads 2 ";
const std::string kTetrahedron =
    "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

/// Standard output; the run must be silent and succeed.
std::string render(const TempFolder& folder, const std::string& arguments) {
    const Ran ran = shell(folder.path(), "stillframe render " + arguments);
    INFO(arguments << "\n" << ran.err);
    CHECK(ran.code == 0);
    CHECK(ran.err.empty());
    return ran.out;
}

Image<Rgb8> picture(const TempFolder& folder, const std::string& name) {
    auto image = readImageFile(folder.path() / name);
    REQUIRE(image.has_value());
    return std::move(*image);
}

Image<Rgba8> pictureWithAlpha(const TempFolder& folder, const std::string& name) {
    auto image = loadImage(folder.path() / name);
    REQUIRE(image.has_value());
    return std::move(*image);
}

bool hasFfmpeg(const TempFolder& folder) {
    if (shell(folder.path(), "command -v ffmpeg").code == 0) {
        return true;
    }
    WARN("no ffmpeg here: not compared with its decoder");
    return false;
}

double linear(int code) {
    const double s = code / 255.0;
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

}  // namespace

TEST_CASE("render: the background has the colour that was typed, either way", "[cli]") {
    const TempFolder folder;
    folder.write("t.obj", kTetrahedron);
    for (const char* colour : {"'#1f80e0'", "0.12156862745,0.50196078431,0.87843137254"}) {
        render(folder, "t.obj -o b.png --background-color " + std::string(colour) + kSmall);
        CHECK(picture(folder, "b.png").at(0, 0) == Rgb8{0x1f, 0x80, 0xe0});
    }
}

TEST_CASE("render: alpha over a background is the picture with that background", "[cli]") {
    const TempFolder folder;
    folder.write("t.obj", kTetrahedron);
    render(folder, "t.obj -o alpha.png --no-background" + kSmall);
    render(folder, "t.obj -o over.png --background-color '#3060c0'" + kSmall);
    const Image<Rgba8> alpha = pictureWithAlpha(folder, "alpha.png");
    const Image<Rgb8> over = picture(folder, "over.png");
    int partly = 0, whole = 0;
    double worst = 0;
    for (int y = 0; y < over.height(); ++y) {
        for (int x = 0; x < over.width(); ++x) {
            const Rgba8 p = alpha.at(x, y);
            const Rgb8 q = over.at(x, y);
            const double a = p.a / 255.0;
            whole += p.a == 255 ? 1 : 0;
            partly += p.a > 0 && p.a < 255 ? 1 : 0;
            const double wanted[3] = {linear(q.r), linear(q.g), linear(q.b)};
            const double composed[3] = {a * linear(p.r) + (1 - a) * linear(0x30),
                                        a * linear(p.g) + (1 - a) * linear(0x60),
                                        a * linear(p.b) + (1 - a) * linear(0xc0)};
            for (int k = 0; k < 3; ++k) {
                worst = std::max(worst, std::abs(wanted[k] - composed[k]));
            }
        }
    }
    CHECK(partly > 30);    // edges
    CHECK(worst < 0.008);  // 8-bit alpha and colour
    CHECK(alpha.at(0, 0).a == 0);
    CHECK(whole > 100);
}

TEST_CASE("render: colours under alpha are those of the surface, also at edges", "[cli]") {
    const TempFolder folder;
    // One white face that is lit evenly: every pixel that shows some of it has its colour.
    folder.write("f.obj", "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n");
    render(folder, "f.obj -o f.png --no-background" + kSmall);
    const Image<Rgba8> alpha = pictureWithAlpha(folder, "f.png");
    const Rgba8 inside = alpha.at(32, 20);
    REQUIRE(inside.a == 255);
    for (int y = 0; y < alpha.height(); ++y) {
        for (int x = 0; x < alpha.width(); ++x) {
            const Rgba8 p = alpha.at(x, y);
            if (p.a >= 16) {  // fewer samples leave fewer bits of colour
                CHECK(std::abs(p.r - inside.r) <= 2);
            }
        }
    }
}

TEST_CASE("render: --lights takes light and background of a scene file, and nothing else of it",
          "[cli]") {
    const TempFolder folder;
    folder.write("t.obj", kTetrahedron);
    const std::string light = R"("lights": {"ambient": {"colour": [0.5, 0.25, 0]}},
                                 "background": {"srgb": [0, 0, 1]})";
    folder.write("whole.json", R"({"obj": "t.obj", )" + light + "}");
    folder.write("light.json", R"({"obj": "no such file", )" + light + "}");
    render(folder, "whole.json -o a.png" + kSmall);
    render(folder, "t.obj --lights light.json -o b.png" + kSmall);
    CHECK(shell(folder.path(), "stillframe compare a.png b.png --exact").code == 0);
    CHECK(picture(folder, "b.png").at(0, 0) == Rgb8{0, 0, 255});

    const Ran missing = shell(folder.path(), "stillframe render t.obj --lights none.json --hash");
    CHECK(missing.code == 3);
    CHECK(missing.err == "stillframe: none.json: no such file\n");
    folder.write("dark.json", "{}");
    const Ran dark = shell(folder.path(), "stillframe render t.obj --lights dark.json --hash");
    CHECK(dark.code == 3);
    CHECK(dark.err ==
          "stillframe: dark.json: /: expected an object with \"light\" or \"lights\"\n");
}

TEST_CASE("render: --denoise off leaves the noise of sampled light, and other scenes as they are",
          "[cli]") {
    const TempFolder folder;
    const auto hashes = [&](const std::string& scene, const std::string& denoise) {
        return render(folder, scene + " --aa none --hash --denoise " + denoise + kSmall);
    };
    CHECK(hashes("builtin:cornell", "on") != hashes("builtin:cornell", "off"));
    CHECK(hashes("builtin:cubes", "on") == hashes("builtin:cubes", "off"));
    CHECK(shell(folder.path(), "stillframe render builtin:cornell --hash --denoise maybe").code ==
          2);
}

TEST_CASE("render: a zoom by 2 shows twice the size, orthographic or not", "[cli]") {
    const TempFolder folder;
    folder.write("q.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n");
    const std::string front = "--camera-position 0,0,9 --camera-focal-point 0,0,0 ";
    for (const char* projection : {"", "--camera-orthographic "}) {
        double widths[2] = {};
        for (const int zoom : {1, 2}) {
            render(folder,
                   "q.obj -o q.png --background-color 0,0,0 --resolution 200x200 --aa none " +
                       front + projection + "--camera-view-angle 40 --camera-zoom-factor " +
                       std::to_string(zoom));
            const Image<Rgb8> image = picture(folder, "q.png");
            for (int x = 0; x < 200; ++x) {
                widths[zoom - 1] += image.at(x, 100).r > 0 ? 1 : 0;
            }
        }
        INFO(projection << widths[0] << " " << widths[1]);
        CHECK(widths[0] > 50);
        CHECK(std::abs(widths[1] - 2 * widths[0]) <= 2);
    }
}

TEST_CASE("render: an orthographic eye within a scene does not see what is behind it", "[cli]") {
    const TempFolder folder;
    // A red wall behind the eye, a green one before it.
    folder.write("m.mtl", "newmtl r\nKd 1 0 0\nnewmtl g\nKd 0 1 0\n");
    folder.write("w.obj",
                 "mtllib m.mtl\nv -9 -9 5\nv 9 -9 5\nv 9 9 5\nv -9 9 5\nv -9 -9 -5\nv 9 -9 -5\n"
                 "v 9 9 -5\nv -9 9 -5\nusemtl r\nf 1 2 3 4\nusemtl g\nf 5 6 7 8\n");
    const std::string base = "w.obj --aa none -o w.png --camera-orthographic ";
    render(folder, base + "--camera-position 0,0,1 --camera-focal-point 0,0,-5" + kSmall);
    CHECK(picture(folder, "w.png").at(32, 18).g > 0);
    CHECK(picture(folder, "w.png").at(32, 18).r == 0);
    // An automatic camera stands outside, wherever a narrow angle puts its eye.
    render(folder, base + "--camera-view-angle 120" + kSmall);
    const Image<Rgb8> all = picture(folder, "w.png");
    int red = 0, green = 0;
    for (int y = 0; y < 36; ++y) {
        for (int x = 0; x < 64; ++x) {
            red += all.at(x, y).r > 0 ? 1 : 0;
            green += all.at(x, y).g > 0 ? 1 : 0;
        }
    }
    INFO(red << " red, " << green << " green");
    CHECK(red > 2 * green);  // the nearer one hides much of the other
    CHECK(green > 0);
}

TEST_CASE("render: azimuth and orbit by the same angle show the same", "[cli]") {
    const TempFolder folder;
    folder.write("t.obj", kTetrahedron);
    // An orbit of 120° over 4 frames has turned by 30° in frame 1.
    render(folder, "t.obj -o o.png --orbit 120 --frames 4 --aa none" + kSmall);
    render(folder, "t.obj -o a.png --camera-azimuth-angle 30 --aa none" + kSmall);
    const Image<Rgb8> orbit = picture(folder, "o.0001.png"), azimuth = picture(folder, "a.png");
    int different = 0;
    for (int y = 0; y < 36; ++y) {
        for (int x = 0; x < 64; ++x) {
            different += orbit.at(x, y) != azimuth.at(x, y) ? 1 : 0;
        }
    }
    CHECK(different <= 4);  // the clip planes are others
}

TEST_CASE("render: a turntable has 60 frames and ends where it began", "[cli]") {
    const TempFolder folder;
    const std::string json =
        render(folder, "builtin:triangle --turntable --json --aa none --resolution 8x8");
    CHECK(json.find("\"frames\": 60") != std::string::npos);
    CHECK(json.find("\"anti_aliasing\": \"none\"") != std::string::npos);
    const std::string short_one =
        render(folder, "builtin:triangle --turntable --frames 2 --json --resolution 8x8");
    CHECK(short_one.find("\"anti_aliasing\": \"ssaa:16\"") != std::string::npos);
    render(folder, "builtin:triangle --turntable --frames 4 --aa none -o t.png" + kSmall);
    render(folder,
           "builtin:triangle --orbit 90 --orbit-frames 1 --start 4 --aa none -o e.png" + kSmall);
    CHECK(contentsOf(folder.path() / "t.0000.png") == contentsOf(folder.path() / "e.png"));
    CHECK(contentsOf(folder.path() / "t.0001.png") != contentsOf(folder.path() / "t.0000.png"));
}

TEST_CASE("render: scenes come from standard input, too", "[cli]") {
    const TempFolder folder;
    folder.write("t.obj", kTetrahedron);
    folder.write("t.json", R"({"obj": "t.obj"})");
    const std::string wanted = render(folder, "t.obj --hash" + kSmall);
    for (const char* file : {"t.obj", "t.json"}) {
        const Ran ran = shell(folder.path(), "stillframe render - --hash" + kSmall + "<" + file);
        CHECK(ran.code == 0);
        CHECK(ran.out == wanted);
    }
    const Ran empty = shell(folder.path(), "stillframe render - --hash");
    CHECK(empty.code == 3);
    CHECK(isOneErrorLine(empty.err));
    CHECK(empty.err.find("standard input") != std::string::npos);
}

TEST_CASE("render: many scenes in one run become files by their names", "[cli]") {
    const TempFolder folder;
    folder.write("a%d.obj", kTetrahedron);
    render(folder, "builtin:triangle builtin:cubes a%d.obj -o {model}.png" + kSmall);
    CHECK(filesIn(folder.path()) == Names{"a%d.obj", "a%d.png", "cubes.png", "triangle.png"});
    const std::string alone = render(folder, "builtin:cubes -o -" + kSmall);
    CHECK(alone == contentsOf(folder.path() / "cubes.png"));
    const std::string json = render(folder, "builtin:triangle builtin:cubes --json" + kSmall);
    CHECK(json.find("\"results\": [") != std::string::npos);
    render(folder, "builtin:triangle builtin:cubes --frames 2 -o {model}.{frame:2}.png" + kSmall);
    CHECK(std::filesystem::exists(folder.path() / "cubes.01.png"));
}

TEST_CASE("render: one scene that is missing does not keep the others from being rendered",
          "[cli]") {
    const TempFolder folder;
    const Ran ran =
        shell(folder.path(), "stillframe render none.obj builtin:cubes -o {model}.png" + kSmall);
    CHECK(ran.code == 3);
    CHECK(isOneErrorLine(ran.err));
    CHECK(filesIn(folder.path()) == Names{"cubes.png"});
}

TEST_CASE("render: an APNG has the frames of the PNGs, to the bit", "[cli]") {
    const TempFolder folder;
    render(folder, "builtin:cubes --frames 3 -o f.png" + kSmall);
    render(folder, "builtin:cubes --frames 3 --fps 25 -o a.apng" + kSmall);
    const std::string apng = contentsOf(folder.path() / "a.apng");
    CHECK(apng.starts_with("\x89PNG"));
    if (!hasFfmpeg(folder)) {
        return;
    }
    REQUIRE(shell(folder.path(), "ffmpeg -loglevel error -i a.apng g.%04d.png").code == 0);
    for (int i = 0; i < 3; ++i) {
        const Image<Rgb8> a = picture(folder, "f.000" + std::to_string(i) + ".png");
        const Image<Rgb8> b = picture(folder, "g.000" + std::to_string(i + 1) + ".png");
        for (int y = 0; y < a.height(); ++y) {
            for (int x = 0; x < a.width(); ++x) {
                REQUIRE(a.at(x, y) == b.at(x, y));
            }
        }
    }
}

TEST_CASE("render: several frames go down a pipe as Y4M, which ffmpeg shows in the right colours",
          "[cli]") {
    const TempFolder folder;
    render(folder, "builtin:cubes --frames 3 -o f.png" + kSmall);
    render(folder, "builtin:cubes --frames 3 -o v.y4m" + kSmall);
    const std::string piped = render(folder, "builtin:cubes --frames 3 -o -" + kSmall);
    CHECK(piped == contentsOf(folder.path() / "v.y4m"));
    if (!hasFfmpeg(folder)) {
        return;
    }
    REQUIRE(shell(folder.path(), "stillframe render builtin:cubes --frames 3 -o -" + kSmall +
                                     "| ffmpeg -loglevel error -i - g.%04d.png")
                .code == 0);
    const Image<Rgb8> a = picture(folder, "f.0002.png"), b = picture(folder, "g.0003.png");
    int worst = 0;
    for (int y = 0; y < a.height(); ++y) {
        for (int x = 0; x < a.width(); ++x) {
            worst = std::max({worst, std::abs(a.at(x, y).r - b.at(x, y).r),
                              std::abs(a.at(x, y).g - b.at(x, y).g),
                              std::abs(a.at(x, y).b - b.at(x, y).b)});
        }
    }
    CHECK(worst <= 5);
}

TEST_CASE("render: --reference keeps the output only where it differs, with exit code 1", "[cli]") {
    const TempFolder folder;
    render(folder, "builtin:cubes --frames 3 -o r.png" + kSmall);
    const std::string base =
        "stillframe render builtin:cubes --frames 3 --reference r.{frame:4}.png -o o.png" + kSmall;
    const Ran same = shell(folder.path(), base);
    CHECK(same.code == 0);
    CHECK(same.out.find("all  identical") != std::string::npos);
    CHECK(filesIn(folder.path()) == Names{"r.0000.png", "r.0001.png", "r.0002.png"});
    std::filesystem::copy_file(folder.path() / "r.0000.png", folder.path() / "r.0001.png",
                               std::filesystem::copy_options::overwrite_existing);
    const Ran other = shell(folder.path(), base + "--json");
    CHECK(other.code == 1);
    CHECK(other.err.empty());
    CHECK(other.out.find("\"reference\":") != std::string::npos);
    CHECK(filesIn(folder.path()) ==
          Names{"o.0001.diff.png", "o.0001.png", "r.0000.png", "r.0001.png", "r.0002.png"});
    CHECK(shell(folder.path(), base + "--quiet").out.empty());
    const Ran large = shell(
        folder.path(), "stillframe render builtin:cubes --reference r.0000.png --resolution 9x9");
    CHECK(large.code == 1);
    CHECK(isOneErrorLine(large.err));
    const Ran missing =
        shell(folder.path(), "stillframe render builtin:cubes --reference none.png" + kSmall);
    CHECK(missing.code == 3);
    CHECK(isOneErrorLine(missing.err));
}

TEST_CASE("render: --watch renders again when a file has changed, and survives broken ones",
          "[cli]") {
    const TempFolder folder;
    folder.write("s.obj", "mtllib m.mtl\nusemtl m\n" + kTetrahedron);
    folder.write("m.mtl", "newmtl m\nKd 1 0 0\n");
    // Waits until the log has so many lines of the wanted kind.
    // TERM, not INT: shells start programs in the background with INT ignored.
    const Ran ran = shell(folder.path(), R"(
        await() { i=0; while [ $(grep -c "$1" log) -lt $2 ] && [ $i -lt 100 ]; do sleep 0.1; i=$((i + 1)); done; }
)" STILL_PROGRAM R"( render s.obj -o o.png --watch --resolution 64x36 2>log & pid=$!
        touch log; await watching 1; cp o.png red.png
        printf 'newmtl m\nKd 0 1 0\n' > m.new; mv m.new m.mtl; await watching 2; cp o.png green.png
        cp s.obj good; echo 'f 1 2 99' >> s.obj; await s.obj: 1
        cp good s.obj; await watching 3
        kill -TERM $pid; wait $pid; echo $?)");
    INFO(contentsOf(folder.path() / "log"));
    CHECK(ran.out == "143\n");
    const Rgb8 red = picture(folder, "red.png").at(30, 20);
    const Rgb8 green = picture(folder, "green.png").at(30, 20);
    CHECK(red.r > red.g);
    CHECK(green.g > green.r);
    CHECK(contentsOf(folder.path() / "o.png") == contentsOf(folder.path() / "green.png"));
}

}  // namespace still::test
