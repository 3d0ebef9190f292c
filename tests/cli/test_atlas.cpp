// `stillframe atlas`, as a whole, on two small cases.

#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>

#include "demos/stillframe/cell_store.h"
#include "demos/stillframe/error_crop.h"
#include "demos/stillframe/file_cache.h"
#include "demos/stillframe/segment_meter.h"
#include "rasterizer/workers.h"
#include "tests/cli/shell.h"
#include "tests/support/data_path.h"

namespace still::test {
namespace {

using Names = std::vector<std::string>;

const std::string kSmall =
    "stillframe atlas --scenes wires-still,disocclusion --presets raw,still --resolution 96x54 "
    "--cache cache --output out ";

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

int countOf(const std::string& text, const std::string& part) {
    int count = 0;
    for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
        ++count;
    }
    return count;
}

}  // namespace

TEST_CASE("atlas: a run writes a page, JSON and CSV, and prints the same JSON", "[cli]") {
    const TempFolder folder;
    const Ran ran = shell(folder.path(), kSmall + "--json");
    INFO(ran.err);
    REQUIRE(ran.code == 0);
    const auto out = folder.path() / "out";
    CHECK(filesIn(out) == Names{"atlas.csv", "atlas.json", "index.html"});
    CHECK(ran.out == contentsOf(out / "atlas.json"));
    // wires-still has two segments, disocclusion one; two ways each.
    CHECK(countOf(ran.out, "\"scene\":") == 6);
    for (const char* key : {"segment", "preset", "psnr", "ssim", "flip", "flicker", "ghost_area",
                            "recovery_frames", "sharpness", "ms"}) {
        INFO(key);
        CHECK(countOf(ran.out, std::string("\"") + key + "\":") >= 6);
    }
    CHECK_FALSE(has(ran.out, "nan"));
    CHECK_FALSE(has(ran.out, "inf"));
    CHECK(countOf(contentsOf(out / "atlas.csv"), "\n") == 7);
    const std::string page = contentsOf(out / "index.html");
    CHECK(page.starts_with("<!DOCTYPE html>"));
    CHECK(countOf(page, "data:image/png;base64,iVBOR") == 6);
    CHECK_FALSE(has(page, "http"));

    SECTION("a second run takes everything from the cache, times too") {
        const Names entries = filesIn(folder.path() / "cache");
        const Ran again = shell(folder.path(), kSmall + "--json");
        CHECK(again.out == ran.out);
        CHECK(filesIn(folder.path() / "cache") == entries);
    }
    SECTION("damaged entries are made again") {
        for (const std::string& name : filesIn(folder.path() / "cache")) {
            std::filesystem::resize_file(folder.path() / "cache" / name, 40);
        }
        const Ran again = shell(folder.path(), kSmall);
        INFO(again.err);
        CHECK(again.code == 0);
        CHECK(contentsOf(out / "atlas.csv").size() > 200);
    }
    SECTION("a part of the table comes from the same cache") {
        const Ran part = shell(folder.path(),
                               "stillframe atlas --scenes disocclusion --presets still "
                               "--resolution 96x54 --cache cache --output part --json");
        CHECK(countOf(part.out, "\"scene\":") == 1);
        CHECK(has(ran.out, part.out.substr(part.out.find("\"psnr\""), 60)));
    }
}

TEST_CASE("atlas: what cannot be meant is refused with code 2 and one line", "[cli]") {
    const TempFolder folder;
    for (const char* arguments :
         {"atlas", "atlas --output out --scenes nowhere", "atlas --output out --presets best",
          "atlas --output out --presets ssaa:0", "atlas --output out --resolution 5",
          "atlas --output out extra"}) {
        const Ran ran = shell(folder.path(), std::string("stillframe ") + arguments);
        INFO(arguments << "\n" << ran.err);
        CHECK(ran.code == 2);
        CHECK(isOneErrorLine(ran.err));
        CHECK(ran.out.empty());
        CHECK(filesIn(folder.path()).empty());
    }
}

TEST_CASE("atlas: a folder that cannot be written is refused with code 3 before the work",
          "[cli]") {
    const TempFolder folder;
    folder.write("file", "not a folder");
    for (const char* places : {"--output file --cache cache", "--output out --cache file",
                               "--output file/below --cache cache"}) {
        const Ran ran = shell(folder.path(), std::string("stillframe atlas ") + places);
        INFO(places << "\n" << ran.err);
        CHECK(ran.code == 3);
        CHECK(isOneErrorLine(ran.err));
    }
    CHECK(contentsOf(folder.path() / "file") == "not a folder");
}

TEST_CASE("atlas: an interrupted run leaves no files behind, and its cells are kept", "[cli]") {
    const TempFolder folder;
    const Ran ran = shell(folder.path(), kSmall +
                                             "& pid=$!; sleep 0.3; kill -INT $pid 2>/dev/null; "
                                             "kill -TERM $pid 2>/dev/null; wait $pid; ls out");
    CHECK(ran.out.empty());
    for (const std::string& name : filesIn(folder.path() / "cache")) {
        CHECK(name.ends_with(".entry"));
    }
}

TEST_CASE("file cache: what is stored is loaded, what is damaged is not there", "[cli]") {
    const TempFolder folder;
    command::Interruption interruption;
    const auto cache = command::FileCache::open((folder.path() / "a/b").string(), interruption);
    REQUIRE(cache.has_value());
    CHECK_FALSE(cache->load(7).has_value());
    REQUIRE(cache->store(7, "some bytes").has_value());
    CHECK(cache->load(7) == "some bytes");
    REQUIRE(cache->store(7, "").has_value());
    CHECK(cache->load(7) == "");
    REQUIRE(cache->store(7, "more bytes").has_value());
    const Names names = filesIn(folder.path() / "a/b");
    REQUIRE(names.size() == 1);
    std::filesystem::resize_file(folder.path() / "a/b" / names[0], 20);
    CHECK_FALSE(cache->load(7).has_value());
}

TEST_CASE("file cache: several threads may store at the same time", "[cli]") {
    const TempFolder folder;
    command::Interruption interruption;
    const auto cache = command::FileCache::open(folder.path().string(), interruption);
    REQUIRE(cache.has_value());
    constexpr int kStores = 200;
    std::vector<uint8_t> stored(kStores);
    Workers workers(4);
    workers.parallelFor(kStores, 1, [&](int begin, int, int) {
        stored[size_t(begin)] = cache->store(uint64_t(begin % 3), "bytes").has_value();
    });
    CHECK(std::count(stored.begin(), stored.end(), 1) == kStores);
    CHECK(filesIn(folder.path()).size() == 3);
}

TEST_CASE("cell store: measures come back as they went, also those that do not apply", "[cli]") {
    command::SegmentMeasures a, b;
    a.psnr = 1.0 / 3;
    a.flicker = 0.1;
    a.frames = {{3, 0.7, 0.9, 1e-9}, {4, 0, 1, 0}};
    a.trail = 3.5;
    a.crop_png = std::string("\0 1 - \n", 7);
    b.recovery_frames = 2;
    b.crop_x = -5;
    const std::string bytes = command::cellBytes({a, b});
    const auto back = command::cellFromBytes(bytes);
    REQUIRE(back.has_value());
    REQUIRE(back->size() == 2);
    const auto& [first, second] = std::pair((*back)[0], (*back)[1]);
    CHECK(first.psnr == a.psnr);
    CHECK(first.flicker == a.flicker);
    CHECK_FALSE(first.ghost_area.has_value());
    CHECK(first.frames.size() == 2);
    CHECK(first.frames[0].flip == 1e-9);
    CHECK(first.frames[0].ssim == 0.9);
    CHECK(first.trail == 3.5);
    CHECK_FALSE(first.residual.has_value());
    CHECK(first.crop_png == a.crop_png);
    CHECK(second.recovery_frames == b.recovery_frames);
    CHECK(second.crop_x == -5);
    CHECK_FALSE(command::cellFromBytes(bytes.substr(0, bytes.size() - 1)).has_value());
    CHECK_FALSE(command::cellFromBytes("x " + bytes).has_value());
}

TEST_CASE("coarse error: what alternates cancels, what is off everywhere stays", "[cli]") {
    Image<Rgb8> reference(21, 13), alternating(21, 13), brighter(21, 13);
    for (int y = 0; y < 13; ++y) {
        for (int x = 0; x < 21; ++x) {
            reference.at(x, y) = {100, 100, 100};
            const uint8_t value = (x + y) % 2 == 0 ? 110 : 90;
            alternating.at(x, y) = {value, value, value};
            brighter.at(x, y) = {105, 105, 105};
        }
    }
    const auto coarse = [&](const Image<Rgb8>& picture) {
        return command::coarseRms(picture.view(), std::as_const(reference).view());
    };
    CHECK(coarse(reference) == 0);
    CHECK(coarse(alternating) < 0.3);  // blocks at the border have an odd number of pixels
    CHECK(coarse(brighter) == Approx(5));
}

TEST_CASE("error crop: the worst window of all frames is cut out", "[cli]") {
    const Image<Rgb8> reference(100, 70);
    command::ErrorCrop crop;
    crop.look(4, reference.view(), reference.view());
    CHECK(crop.frame() == 4);
    Image<Rgb8> picture(100, 70);
    picture.at(80, 60) = {10, 200, 0};
    crop.look(5, std::as_const(picture).view(), reference.view());
    crop.look(6, reference.view(), reference.view());
    CHECK(crop.frame() == 5);
    CHECK(crop.strip().width == 3 * command::kCropSize);
    const int x = 80 - crop.x();
    const int y = 60 - crop.y();
    REQUIRE((x >= 0 && x < command::kCropSize && y >= 0 && y < command::kCropSize));
    CHECK(crop.strip().at(x, y) == Rgb8{10, 200, 0});
    CHECK(crop.strip().at(x + command::kCropSize, y) == Rgb8{});
    CHECK(crop.strip().at(x + 2 * command::kCropSize, y) == Rgb8{40, 255, 0});
}

}  // namespace still::test
