// `stillframe compare`, as a whole.

#include <catch2/catch.hpp>

#include "demos/stillframe/png.h"
#include "engine/image_file.h"
#include "tests/cli/shell.h"
#include "tests/support/data_path.h"

namespace still::test {
namespace {

/// A ramp with `changed` pixels of the first row brighter by `by`.
void writeRamp(const std::filesystem::path& file, int changed = 0, int by = 0, int width = 32) {
    Image<Rgb8> image(width, 16);
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) {
            const int add = y == 0 && x < changed ? by : 0;
            image.at(x, y) = {uint8_t(5 * x + add), uint8_t(10 * y), 90};
        }
    }
    command::Interruption interruption;
    REQUIRE(command::savePng(file, std::as_const(image).view(), interruption).has_value());
}

Ran compare(const TempFolder& folder, const std::string& arguments) {
    return shell(folder.path(), "stillframe compare " + arguments);
}

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("compare: identical pictures have no PSNR and code 0", "[cli]") {
    const TempFolder folder;
    writeRamp(folder.path() / "a.png");
    const Ran plain = compare(folder, "a.png a.png");
    CHECK(plain.code == 0);
    CHECK(plain.out == "identical\n");
    const Ran json = compare(folder, "a.png a.png --json");
    CHECK(json.code == 0);
    CHECK(has(json.out, "\"psnr\": null"));
    CHECK(has(json.out, "\"ssim\": 1.0"));
    CHECK(has(json.out, "\"max_difference\": 0"));
    CHECK(has(json.out, "\"identical\": true"));
    CHECK_FALSE(has(json.out, "frames"));
}

TEST_CASE("compare: one pixel that is off by one is found", "[cli]") {
    const TempFolder folder;
    writeRamp(folder.path() / "a.png");
    writeRamp(folder.path() / "b.png", 1, 1);
    const Ran json = compare(folder, "a.png b.png --json");
    CHECK(json.code == 1);
    CHECK(has(json.out, "\"psnr\": 79.9"));  // 10 log10(255² · 1536)
    CHECK(has(json.out, "\"max_difference\": 1,"));
    CHECK(has(json.out, "\"identical\": false"));
    const Ran exact = compare(folder, "a.png b.png --exact");
    CHECK(exact.code == 1);
    CHECK(has(exact.out, "x 0 y 0: 0 0 90, 1 0 90\n"));
}

TEST_CASE("compare: --exact lists the first twenty pixels", "[cli]") {
    const TempFolder folder;
    writeRamp(folder.path() / "a.png");
    writeRamp(folder.path() / "b.png", 30, 7);
    const Ran ran = compare(folder, "a.png b.png --exact");
    CHECK(std::count(ran.out.begin(), ran.out.end(), '\n') == 1 + 20);
    CHECK(has(ran.out, "x 19 y 0: 95 0 90, 102 0 90\n"));
}

TEST_CASE("compare: --diff shows where", "[cli]") {
    const TempFolder folder;
    writeRamp(folder.path() / "a.png");
    writeRamp(folder.path() / "b.png", 2, 20);
    CHECK(compare(folder, "a.png b.png --diff d.png").code == 1);
    const auto diff = readImageFile(folder.path() / "d.png");
    REQUIRE(diff.has_value());
    CHECK(diff->at(1, 0) == Rgb8{255, 80, 0});
    CHECK(diff->at(2, 0).r == diff->at(2, 0).b);
}

TEST_CASE("compare: pictures of different sizes differ", "[cli]") {
    const TempFolder folder;
    writeRamp(folder.path() / "a.png");
    writeRamp(folder.path() / "b.png", 0, 0, 31);
    const Ran ran = compare(folder, "a.png b.png");
    CHECK(ran.code == 1);
    CHECK(isOneErrorLine(ran.err));
    CHECK(has(ran.err, "31x16"));
}

TEST_CASE("compare: frame patterns are compared frame by frame", "[cli]") {
    const TempFolder folder;
    for (int frame : {7, 8, 10}) {
        writeRamp(folder.path() / ("a." + std::to_string(frame) + ".png"));
        writeRamp(folder.path() / ("b-000" + std::to_string(frame) + ".png"), frame == 8 ? 3 : 0,
                  9);
    }
    std::filesystem::rename(folder.path() / "b-00010.png", folder.path() / "b-0010.png");
    const Ran ran = compare(folder, "a.{frame}.png b-%04d.png");
    CHECK(ran.code == 1);
    CHECK(has(ran.out, "frame 7  identical\nframe 8  psnr "));
    CHECK(has(ran.out, "frame 10  identical\nall  psnr "));
    const Ran json = compare(folder, "a.{frame}.png b-{frame:4}.png --json --diff d.png");
    CHECK(has(json.out, "\"frame\": 10"));
    CHECK(std::filesystem::exists(folder.path() / "d.0008.png"));

    std::filesystem::remove(folder.path() / "b-0010.png");
    const Ran missing = compare(folder, "a.{frame}.png b-%04d.png");
    CHECK(missing.code == 3);
    CHECK(has(missing.err, "b-0010.png"));
}

}  // namespace still::test
