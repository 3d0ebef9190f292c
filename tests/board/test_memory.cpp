// What a caller without a heap relies on: arenas, the sizes that are computed for them, and that
// frames within the limits take no memory.

#include <array>
#include <catch2/catch.hpp>
#include <cstring>

#include "postfx/laboratory.h"
#include "postfx/limits.h"
#include "postfx/taa.h"
#include "rasterizer/arena.h"
#include "rasterizer/limits.h"
#include "tests/board/counted_memory.h"
#include "tests/support/busy_scene.h"

using namespace still;
using namespace still::test;

namespace {

constexpr size_t kMegabyte = size_t{1} << 20;

/// Enough for any way in which the triangles of the scene may lie.
RasterLimits worstCase(const DrawList& list, const FrameView& view, int threads) {
    RasterLimits limits{.width = view.width, .height = view.height, .threads = threads};
    size_t triangles = 0, largest = 0;
    for (const Instance& instance : list.instances) {
        const Mesh& mesh = list.meshes[instance.mesh];
        ++limits.instances;
        limits.surfaces += mesh.parts.size();
        limits.vertices += mesh.x.size();
        for (const MeshPart& part : mesh.parts) {
            limits.chunks += (part.triangle_count + kChunkTriangles - 1) / kChunkTriangles;
            triangles += part.triangle_count;
            largest = std::max<size_t>(largest, std::min(part.triangle_count, kChunkTriangles));
        }
    }
    constexpr size_t kPieces = 6;  // of a clipped triangle
    limits.chunk_wide = largest * kPieces;
    limits.chunk_records = largest * kPieces * internal::tileCount(view.width, view.height);
    limits.tile_triangles = triangles * kPieces;
    return limits;
}

struct Size {
    int width, height;
};
// Planes of more than 256 KB come from the system and not from operator new.
constexpr Size kSizes[] = {{1, 1}, {63, 65}, {64, 64}, {160, 120}, {200, 150}};

/// `used` is at most `computed`, and not much less: gaps before aligned pieces, sizes of structs.
void checkBound(size_t used, size_t computed) {
    CHECK(used <= computed);
    CHECK(used + used / 50 + 2048 > computed);
}

}  // namespace

TEST_CASE("arena: pieces are aligned, apart, and end with the memory", "[board]") {
    alignas(64) std::array<std::byte, 1024> memory{};
    Arena arena(memory);
    CHECK(arena.size() == 1024);
    Random random(1);
    const std::byte* end = memory.data();
    size_t pieces = 0;
    for (;; ++pieces) {
        const size_t bytes = size_t(random.integer(0, 100));
        const size_t alignment = size_t{1} << random.integer(0, 6);
        const size_t before = arena.used();
        auto* const piece = static_cast<std::byte*>(arena.allocate(bytes, alignment));
        if (piece == nullptr) {
            CHECK(arena.used() == before);
            CHECK(before + arenaBytes(bytes, alignment) > 1024);
            break;
        }
        CHECK(reinterpret_cast<uintptr_t>(piece) % alignment == 0);
        CHECK(reinterpret_cast<uintptr_t>(piece) % kArenaAlignment == 0);
        CHECK(piece >= end);
        end = piece + bytes;
        CHECK(end <= memory.data() + memory.size());
        CHECK(arena.used() - before <= arenaBytes(bytes, alignment));
    }
    CHECK(pieces >= 5);
}

TEST_CASE("arena: a sealed one gives nothing, and a size near 2^64 is not a small one", "[board]") {
    alignas(64) std::array<std::byte, 256> memory{};
    Arena arena(memory);
    CHECK(arena.allocate(SIZE_MAX, 1) == nullptr);
    CHECK(arena.allocate(SIZE_MAX - 64, 64) == nullptr);
    CHECK(arena.allocate(256, 64) == memory.data());
    CHECK(arena.allocate(1, 1) == nullptr);
    Arena other(memory);
    other.seal();
    CHECK(other.allocate(1, 1) == nullptr);
}

TEST_CASE("limits: a G-buffer takes what gbufferBytes() says", "[board]") {
    for (const Size& size : kSizes) {
        for (int bits = 0; bits < 8; ++bits) {
            const PlaneSet planes{
                .normal = (bits & 1) != 0, .motion = (bits & 2) != 0, .albedo = (bits & 4) != 0};
            size_t used = 0;
            {
                GBuffer gbuffer;
                ArenaInUse arena(8 * kMegabyte);
                gbuffer.resize(size.width, size.height, planes);
                used = arena.used();
            }
            CAPTURE(size.width, size.height, bits);
            checkBound(used, gbufferBytes(size.width, size.height, planes));
        }
    }
}

TEST_CASE("limits: a rasterizer takes what rasterizerBytes() says", "[board]") {
    Random random(2);
    for (int round = 0; round < 50; ++round) {
        const auto upTo = [&](int most) { return size_t(random.integer(0, most)); };
        const RasterLimits limits{.width = random.integer(1, 500),
                                  .height = random.integer(1, 500),
                                  .threads = random.integer(1, 4),
                                  .instances = upTo(20),
                                  .surfaces = upTo(50),
                                  .vertices = upTo(20000),
                                  .chunks = upTo(10),
                                  .chunk_records = upTo(3000),
                                  .chunk_wide = upTo(100),
                                  .tile_triangles = upTo(2000)};
        size_t used = 0;
        {
            ArenaInUse arena(60 * kMegabyte);
            Rasterizer rasterizer;
            rasterizer.reserve(limits);
            used = arena.used();
        }
        CAPTURE(round);
        checkBound(used, rasterizerBytes(limits));
    }
}

TEST_CASE("limits: a laboratory takes what laboratoryBytes() says, whatever its policy",
          "[board]") {
    for (const TaaPreset& preset : taaPresets()) {
        if (preset.policy.method != Method::recursive) {
            continue;
        }
        for (const Size& size : kSizes) {
            size_t used = 0;
            {
                ArenaInUse arena(16 * kMegabyte);
                Laboratory laboratory;
                laboratory.reserve(size.width, size.height, preset.policy);
                used = arena.used();
            }
            CAPTURE(preset.name, size.width, size.height);
            checkBound(used, laboratoryBytes(size.width, size.height, preset.policy));
        }
    }
}

TEST_CASE("limits: a Taa takes what taaBytes() says", "[board]") {
    for (const Size& size : kSizes) {
        for (const int ring : {1, 2, 8, kMaxRing}) {
            size_t used = 0;
            {
                ArenaInUse arena(60 * kMegabyte);
                Taa taa;
                taa.reserve(size.width, size.height, {.ring = ring});
                used = arena.used();
            }
            CAPTURE(size.width, size.height, ring);
            checkBound(used, taaBytes(size.width, size.height, ring));
        }
    }
}

TEST_CASE("limits: a Taa asks for no memory while things start, turn, change and rest", "[board]") {
    const int threads = GENERATE(1, 3);
    TestScene scene = busyScene(2);
    const FrameView view = busyView(2);
    const TaaSettings settings{.sample_cap = 8, .ring = 4};
    const std::vector<uint64_t> some_surfaces((size_t(kSurfaceMask) + 1) / 64, 5);
    Rasterizer rasterizer;
    GBuffer gbuffer;
    Workers workers(threads);
    size_t unmet = 1;
    {
        ArenaInUse arena(taaBytes(view.width, view.height, settings.ring));
        Taa taa;
        taa.reserve(view.width, view.height, settings);
        for (int frame = 0; frame < 30; ++frame) {
            arena.pause();
            const bool rests = frame >= 12 && frame < 24;
            FrameView now = view;
            if (rests) {
                now.view_projection_before = now.view_projection;
            }
            for (Instance& instance : scene.instances) {
                instance.moved = !rests && frame % 3 != 0;
            }
            const DrawList list = scene.list();
            TaaFrame taa_frame{.reset = frame == 0 || frame == 27,
                               .shading_changed = frame == 5 || frame == 20};
            if (frame % 4 == 1 && !rests) {
                taa_frame.changed_surfaces = some_surfaces;
                taa_frame.turning_surfaces = some_surfaces;
            }
            rasterizer.transformAndBin(list, now, {.planes = kAllPlanes}, workers);
            rasterizer.rasterize(gbuffer, workers);
            arena.goOn();
            arena.seal();
            taa.plan(view.width, view.height, gbuffer.tiles, taa_frame, settings);
            taa.resolve(gbuffer, taa_frame, settings, workers);
        }
        unmet = arena.unmet();
        arena.pause();
    }
    CHECK(unmet == 0);
}

TEST_CASE("limits: frames within them ask for no memory, on any SIMD target and thread",
          "[board]") {
    const int threads = GENERATE(1, 3);
    const uint64_t seed = GENERATE(range<uint64_t>(1, 4));
    TestScene scene = busyScene(seed);
    const DrawList list = scene.list();
    const FrameView view = busyView(seed);
    const RasterLimits limits = worstCase(list, view, threads);
    const TaaPolicy policy = findPreset("ema-consistent")->policy;
    for (const SimdTarget simd : availableSimdTargets()) {
        size_t unmet_before = 1, unmet = 1;
        {
            Workers workers(threads);
            ArenaInUse arena(rasterizerBytes(limits) +
                             gbufferBytes(view.width, view.height, kAllPlanes) +
                             laboratoryBytes(view.width, view.height, policy) + 64);
            Rasterizer rasterizer;
            rasterizer.reserve(limits);
            GBuffer gbuffer;
            gbuffer.resize(view.width, view.height, kAllPlanes);
            Laboratory laboratory;
            laboratory.reserve(view.width, view.height, policy);
            unmet_before = arena.unmet();
            arena.seal();
            for (int frame = 0; frame < 4; ++frame) {
                FrameView now = view;
                now.jitter_x_fx8 = frame * 31 - 60;
                rasterizer.transformAndBin(list, now, {.simd = simd, .planes = kAllPlanes},
                                           workers);
                rasterizer.rasterize(gbuffer, workers);
                laboratory.resolve(gbuffer, {.reset = frame == 0}, policy, simd, workers);
            }
            unmet = arena.unmet();
        }
        CAPTURE(name(simd), threads, seed);
        CHECK(unmet_before == 0);
        CHECK(unmet == 0);
    }
}

TEST_CASE("limits: the counting of requests sees a frame beyond them", "[board]") {
    TestScene scene = busyScene(1);
    const DrawList list = scene.list();
    const FrameView view = busyView(1);
    RasterLimits limits = worstCase(list, view, 1);
    limits.tile_triangles = 1;
    size_t unmet = 0;
    {
        Workers workers(1);
        GBuffer gbuffer;
        ArenaInUse arena(60 * kMegabyte);
        Rasterizer rasterizer;
        rasterizer.reserve(limits);
        gbuffer.resize(view.width, view.height, kAllPlanes);
        arena.seal();
        rasterizer.transformAndBin(list, view, {.planes = kAllPlanes}, workers);
        rasterizer.rasterize(gbuffer, workers);
        unmet = arena.unmet();
    }
    CHECK(unmet > 0);
}
