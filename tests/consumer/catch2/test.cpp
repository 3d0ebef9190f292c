#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>
#include <engine/golden.h>

TEST_CASE("pictures are as recorded, bit for bit") {
    CHECK(still::golden::verify("golden"));
}
