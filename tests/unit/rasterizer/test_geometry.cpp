// The kernels of the vertex and triangle stages on every target against the scalar ones.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstring>
#include <memory>
#include <vector>

#include "rasterizer/internal/geometry.h"
#include "tests/support/test_scene.h"

using namespace still;
using namespace still::internal;
using test::Random;

namespace {

constexpr int kWidth = 300, kHeight = 200;

/// Around the picture, now and then without a position.
ScreenVertex randomVertex(Random& random, int spread_px) {
    if (random.integer(0, 15) == 0) {
        return {kNoPosition, 1 << random.integer(0, 7), 0.0f, 0.0f};
    }
    return {random.integer(-spread_px * 256, (kWidth + spread_px) * 256),
            random.integer(-spread_px * 256, (kHeight + spread_px) * 256),
            float(random.real(-0.1, 1.0)), float(random.real(0.01, 10.0))};
}

/// Triangles of all sizes from nothing to many tiles; the corners of most are close together.
struct RandomChunk {
    std::vector<ScreenVertex> vertices;
    std::vector<uint32_t> indices;

    RandomChunk(Random& random, uint32_t triangles) {
        for (uint32_t t = 0; t < triangles; ++t) {
            const ScreenVertex first = randomVertex(random, 40);
            const int size_fx8 = 1 << random.integer(2, 16);
            for (int k = 0; k < 3; ++k) {
                ScreenVertex v = randomVertex(random, 40);
                if (first.placed() && v.placed()) {
                    v.x_fx8 = first.x_fx8 + random.integer(-size_fx8, size_fx8);
                    v.y_fx8 = first.y_fx8 + random.integer(-size_fx8, size_fx8);
                }
                indices.push_back(uint32_t(vertices.size()));
                vertices.push_back(v);
            }
            if (random.integer(0, 7) == 0) {
                indices.back() = indices[indices.size() - 2];  // without area
            }
        }
    }
};

bool sameRecord(const TileTriangle& a, const TileTriangle& b) {
    if ((a.id & kWide) != 0) {
        return a.id == b.id;
    }
    return std::memcmp(&a, &b, sizeof(TileTriangle)) == 0;
}

}  // namespace

TEST_CASE("geometry: every target leaves the same triangles with the same records", "[geometry]") {
    Random random(41);
    const auto expected = std::make_unique<TriangleBatch>();
    const auto got = std::make_unique<TriangleBatch>();
    for (int round = 0; round < 60; ++round) {
        const uint32_t count = uint32_t(random.integer(1, int(kChunkTriangles)));
        const RandomChunk chunk(random, count);
        const TriangleJob job{.indices = chunk.indices.data(),
                              .vertices = chunk.vertices.data(),
                              .count = count,
                              .sample_x_fx8 = random.integer(0, 255),
                              .sample_y_fx8 = random.integer(0, 255),
                              .width = kWidth,
                              .height = kHeight};
        referenceGeometry().cullTriangles(job, *expected);
        for (SimdTarget target : availableSimdTargets()) {
            CAPTURE(round, count, name(target));
            geometryFor(target).cullTriangles(job, *got);
            REQUIRE(got->count == expected->count);
            REQUIRE(got->flags == expected->flags);
            REQUIRE(got->tile_x0 == expected->tile_x0);
            REQUIRE(got->tile_y0 == expected->tile_y0);
            REQUIRE(got->tile_x1 == expected->tile_x1);
            REQUIRE(got->tile_y1 == expected->tile_y1);
            for (uint32_t i = 0; i < expected->count; ++i) {
                CAPTURE(i);
                REQUIRE(got->place[i] == expected->place[i]);
                REQUIRE(sameRecord(got->records[i], expected->records[i]));
            }
        }
    }
}

TEST_CASE("geometry: every target finds the bounds of any range of vertices", "[geometry]") {
    Random random(42);
    std::vector<float> axes[3];
    for (auto& axis : axes) {
        for (int i = 0; i < 100; ++i) {
            axis.push_back(float(random.real(-1e6, 1e6)));
        }
    }
    for (int round = 0; round < 300; ++round) {
        const int begin = random.integer(0, 98), end = random.integer(begin + 1, 100);
        for (SimdTarget target : availableSimdTargets()) {
            CAPTURE(begin, end, name(target));
            const PositionBox box =
                geometryFor(target).boundVertices(axes[0].data() + begin, axes[1].data() + begin,
                                                  axes[2].data() + begin, size_t(end - begin));
            for (int axis = 0; axis < 3; ++axis) {
                float low = axes[axis][size_t(begin)], high = low;
                for (int i = begin; i < end; ++i) {
                    low = std::min(low, axes[axis][size_t(i)]);
                    high = std::max(high, axes[axis][size_t(i)]);
                }
                REQUIRE(box.low[axis] == low);
                REQUIRE(box.high[axis] == high);
            }
        }
    }
}
