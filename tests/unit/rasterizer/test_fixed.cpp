// The rounding rule, log depth, octahedral normals, names of targets.

#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "rasterizer/fixed.h"
#include "rasterizer/gbuffer.h"
#include "rasterizer/internal/kernels.h"
#include "rasterizer/simd.h"

using namespace still;

TEST_CASE("fixed: rounding goes to the nearest, ties up, for either sign", "[fixed]") {
    CHECK(roundShift(3, 1) == 2);
    CHECK(roundShift(-3, 1) == -1);
    CHECK(roundShift(-5, 2) == -1);
    CHECK(roundShift(-6, 2) == -1);
    CHECK(roundShift(-7, 2) == -2);
    CHECK(roundToInt(2.5f) == 3);
    CHECK(roundToInt(-2.5f) == -2);
    CHECK(roundToInt(-2.51f) == -3);
    for (int v = -4000; v <= 4000; ++v) {
        for (int shift = 1; shift < 10; ++shift) {
            REQUIRE(roundShift(v, shift) == int(std::floor(double(v) / (1 << shift) + 0.5)));
        }
        REQUIRE(roundToInt(float(v) / 16) == int(std::floor(v / 16.0 + 0.5)));
    }
}

TEST_CASE("fixed: division rounds down", "[fixed]") {
    for (int a = -300; a <= 300; ++a) {
        for (int b = 1; b < 20; ++b) {
            REQUIRE(floorDiv(a, b) == int(std::floor(double(a) / b)));
        }
    }
}

TEST_CASE("fixed: log depth keeps the order and a relative step", "[fixed]") {
    CHECK(logDepth16(std::bit_cast<uint32_t>(1.0f)) == 65535);
    CHECK(logDepth16(0) == 0);
    CHECK(logDepth16(std::bit_cast<uint32_t>(0x1p-40f)) == 0);
    int previous = 0;
    for (float depth = 0x1p-31f; depth <= 1.0f; depth *= 1.0005f) {
        const int code = logDepth16(std::bit_cast<uint32_t>(depth));
        REQUIRE(code > previous);
        REQUIRE((previous == 0 || code - previous <= 3));
        previous = code;
    }
}

TEST_CASE("gbuffer: octahedral codes of the axes decode to the axes", "[fixed]") {
    const auto pack = [](int x, int y) { return uint32_t(uint16_t(x)) | uint32_t(y) << 16; };
    CHECK(decodeOctahedral(pack(32767, 0)).x == 1.0f);
    CHECK(decodeOctahedral(pack(-32767, 0)).x == -1.0f);
    CHECK(decodeOctahedral(pack(0, 32767)).y == 1.0f);
    CHECK(decodeOctahedral(pack(0, 0)).z == 1.0f);
    CHECK(decodeOctahedral(pack(32767, 32767)).z == -1.0f);
}

TEST_CASE("simd: scalar is always there and first, the best one is last, names differ", "[simd]") {
    const std::vector<SimdTarget> targets = availableSimdTargets();
    REQUIRE_FALSE(targets.empty());
    CHECK(targets.front() == SimdTarget::scalar);
    CHECK(targets.back() == bestSimdTarget());
    std::set<std::string_view> names;
    for (SimdTarget target : targets) {
        names.insert(name(target));
    }
    CHECK(names.size() == targets.size());
    CHECK(name(SimdTarget::scalar) == "scalar");
    CHECK(name(SimdTarget::avx512) == "avx512");
}

TEST_CASE("simd: every available target has a full table of kernels", "[simd]") {
    CHECK(&internal::kernelsFor(SimdTarget::scalar) == &internal::referenceKernels());
    for (SimdTarget target : availableSimdTargets()) {
        CAPTURE(name(target));
        const internal::RasterKernels& kernels = internal::kernelsFor(target);
        CHECK(kernels.rasterizeTile != nullptr);
        CHECK(kernels.shadeTile != nullptr);
        const internal::RasterKernels& scalar = internal::referenceKernels();
        CHECK((target == SimdTarget::scalar) == (kernels.shadeTile == scalar.shadeTile));
        const internal::GeometryKernels& geometry = internal::geometryFor(target);
        CHECK(geometry.transformVertices != nullptr);
        CHECK(geometry.cullTriangles != nullptr);
        CHECK((target == SimdTarget::scalar) ==
              (geometry.transformVertices == internal::referenceGeometry().transformVertices));
    }
}
