#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>

#include "engine/internal/obj_text.h"

using namespace still;

TEST_CASE("number: short decimals are rounded correctly", "[unit][engine]") {
    // Up to 15 digits and powers of ten up to 22 are one correctly rounded operation.
    std::mt19937_64 random(1);
    for (int round = 0; round < 20000; ++round) {
        const double digits = double(random() % 1000000000000000u);
        char text[64];
        std::snprintf(text, sizeof text, "%.0fe%d", digits, int(random() % 45) - 22);
        INFO(text);
        CHECK(parseNumber(text) == std::strtod(text, nullptr));
        std::snprintf(text, sizeof text, "%.*f", int(random() % 9), digits / 1e9);
        INFO(text);
        CHECK(parseNumber(text) == std::strtod(text, nullptr));
    }
}

TEST_CASE("number: long ones come within a few units in the last place", "[unit][engine]") {
    for (const char* text : {"3.14159265358979323846264338327950288", "1e-300", "12345e280",
                             "0.000000000000000000000000000000000001234567890123456789"}) {
        INFO(text);
        REQUIRE(parseNumber(text));
        CHECK(*parseNumber(text) == Approx(std::strtod(text, nullptr)).epsilon(1e-14));
    }
    CHECK(parseNumber("1e-999999999999") == 0.0);
    CHECK(parseNumber("0e999999999999") == 0.0);
    CHECK(std::isinf(parseNumber("1e999999999999").value()));
}

TEST_CASE("number: every way to write one", "[unit][engine]") {
    CHECK(parseNumber("7") == 7.0);
    CHECK(parseNumber("+7.") == 7.0);
    CHECK(parseNumber("-.5") == -0.5);
    CHECK(parseNumber("1.5E+03") == 1500.0);
    CHECK(parseNumber("00012") == 12.0);
    CHECK(std::signbit(parseNumber("-0").value()));
    CHECK(std::isnan(parseNumber("nan").value()));
    CHECK(std::isnan(parseNumber("-nan(ind)").value()));
    CHECK(parseNumber("-Infinity") == -INFINITY);
    for (const char* text : {"", "-", ".", "e5", "1e", "1e+", "1.2.3", "1,5", "x", "1x", "--1"}) {
        INFO(text);
        CHECK_FALSE(parseNumber(text));
    }
}

TEST_CASE("lines: all line ends, continuations and byte-order marks", "[unit][engine]") {
    const auto normal = [](std::string text) {
        normaliseLines(text);
        return text;
    };
    CHECK(normal("a\r\nb\rc\nd") == "a \nb\nc\nd\n");
    CHECK(normal("f 1 \\\n2 3\n") == "f 1   2 3\n\n");
    CHECK(normal("f 1 \\\r\n2 3") == "f 1    2 3\n");
    CHECK(normal("\xEF\xBB\xBFv") == "   v\n");
    CHECK(normal("a\\b\\") == "a\\b\\\n");
    CHECK(normal("") == "\n");
}

TEST_CASE("shown text: is one line and short", "[unit][engine]") {
    CHECK(shownText("a\nb\tc") == "a?b?c");
    CHECK(shownText(std::string(1000, 'x')).size() < 100);
}
