#include <catch2/catch.hpp>

#include "demos/stillframe/name_pattern.h"
#include "tests/support/data_path.h"

namespace still::command {
namespace {

NamePattern pattern(const std::string& text) {
    auto parsed = NamePattern::parse(text);
    REQUIRE(parsed.has_value());
    return *parsed;
}

}  // namespace

TEST_CASE("name pattern: each way to write the number", "[cli]") {
    CHECK(pattern("a/b.{frame}.png").at(12) == "a/b.12.png");
    CHECK(pattern("a/b.{frame:4}.png").at(12) == "a/b.0012.png");
    CHECK(pattern("b%04d.png").at(12345) == "b12345.png");
    CHECK(pattern("b%d.png").at(0) == "b0.png");
    CHECK(pattern("b.png").at(3) == "b.png");
    CHECK(pattern("100%.png").at(3) == "100%.png");
}

TEST_CASE("name pattern: a number is added before the extension, once", "[cli]") {
    CHECK(pattern("x/b.c.png").withNumber().at(3) == "x/b.c.0003.png");
    CHECK(pattern("b%d.png").withNumber().at(3) == "b3.png");
}

TEST_CASE("name pattern: planes stand beside the picture", "[cli]") {
    CHECK(pattern("x/b.png").planeAt(3, "depth") == "x/b.depth.png");
    CHECK(pattern("b.mp4").withNumber().planeAt(3, "id") == "b.0003.id.png");
}

TEST_CASE("name pattern: only names that it would write are found", "[cli]") {
    const TempFolder folder;
    for (const char* name : {"a.7.png", "a.07.png", "a.12.png", "a.x.png", "a..png", "a.1.png.bak",
                             "b.1.png", "a.-3.png", "a.99999999999.png"}) {
        folder.write(name, "");
    }
    const std::string base = (folder.path() / "a.").string();
    CHECK(pattern(base + "{frame}.png").existing() == std::vector<int>{7, 12});
    CHECK(pattern(base + "%02d.png").existing() == std::vector<int>{7, 12});
    CHECK(pattern((folder.path() / "none" / "%d.png").string()).existing().empty());
}

TEST_CASE("name pattern: what cannot be meant is refused", "[cli]") {
    for (const char* text : {"", "folder/", "%d/x.png", "a.%d.{frame}.png"}) {
        INFO(text);
        CHECK_FALSE(NamePattern::parse(text).has_value());
    }
}

}  // namespace still::command
