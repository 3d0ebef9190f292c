// Whose motion a pixel follows, when a sample shows it and when it must be inferred.

#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <utility>

#include "postfx/internal/kernels.h"
#include "postfx/internal/rules.h"
#include "random_frames.h"

namespace {

using namespace still;
using taa::Job;
using taa::Owner;

constexpr int kSize = 12;
constexpr int kGround = 1, kWire = 2;

uint32_t depthBits(float depth) {
    return std::bit_cast<uint32_t>(depth);
}

/// Planes of one kept frame, in the order of SlotPointers, and the hints last.
struct Slot {
    static constexpr int kPlanes = 11;
    enum Plane { kOwnerDepth = 5, kOwner = 6, kMotionX = 7, kMotionY = 8, kNormal = 9 };
    Image<int16_t> planes[kPlanes];

    void resize(int width, int height) {
        for (Image<int16_t>& plane : planes) {
            plane.resize(width, height);
        }
    }
    template <class Pointers>
    Pointers pointers() {
        const auto of = [&](int plane) { return planes[plane].view().data; };
        return {{of(0), of(1), of(2)}, of(3), of(4), of(5), of(6), {of(7), of(8)}, of(9)};
    }
    taa::SlotOut out() { return pointers<taa::SlotOut>(); }
    taa::SlotIn in() { return pointers<taa::SlotIn>(); }
    int16_t* hints() { return planes[kPlanes - 1].view().data; }
};

void pointAt(const GBuffer& gbuffer, Job& job) {
    job.width = gbuffer.width();
    job.height = gbuffer.height();
    job.stride = gbuffer.red.view().stride;
    job.now = {
        .colour = {gbuffer.red.view().data, gbuffer.green.view().data, gbuffer.blue.view().data},
        .depth = gbuffer.depth.view().data,
        .id = gbuffer.id.view().data,
        .normal = gbuffer.planes.normal ? gbuffer.normal.view().data : nullptr,
        .motion = gbuffer.motion.view().data,
        .depth_before = gbuffer.depth_before.view().data};
}

/// A wire over a ground, both going `motion` a frame (where they were minus where they are). In the
/// frame before the wire was the owner of columns 4 … 6; this frame's samples miss it.
struct Scene {
    Motion motion{};
    uint16_t wire_depth = logDepth16(depthBits(0.3f));
    GBuffer gbuffer;
    Slot now, before;
    Job job;

    explicit Scene(Motion m = {}) : motion(m) {
        gbuffer.resize(kSize, kSize, {.normal = true, .motion = true});
        now.resize(kSize, kSize);
        before.resize(kSize, kSize);
        for (int y = 0; y < kSize; ++y) {
            for (int x = 0; x < kSize; ++x) {
                setSample(x, y, kGround, 0.1f);
                const bool wire = x >= 4 && x <= 6;
                setBefore(x, y, wire ? kWire : kGround,
                          wire ? wire_depth : logDepth16(depthBits(0.1f)));
            }
        }
        pointAt(gbuffer, job);
        job.frames = 2;
        job.record = now.out();
        job.slot[0] = now.in();
        job.slot[1] = before.in();
    }
    void setSample(int x, int y, int surface, float depth) {
        gbuffer.id.at(x, y) = uint16_t(surface);
        gbuffer.depth.at(x, y) = depthBits(depth);
        gbuffer.depth_before.at(x, y) = logDepth16(depthBits(depth));
        gbuffer.motion.at(x, y) = motion;
    }
    void setBefore(int x, int y, int owner, uint16_t depth) {
        before.planes[Slot::kOwnerDepth].at(x, y) = taa::lessOffset(depth);
        before.planes[Slot::kMotionX].at(x, y) = motion.x_fx8;
        before.planes[Slot::kMotionY].at(x, y) = motion.y_fx8;
        before.planes[Slot::kOwner].at(x, y) = int16_t(owner);
        before.planes[Slot::kNormal].at(x, y) = 77;
    }
    Owner ownerOf(int x, int y) const {
        return taa::inferOwner(job, x, y, taa::seenOwner(job, x, y));
    }
};

}  // namespace

TEST_CASE("taa owner: the nearest sample of the window, ties to the middle, the top, the left",
          "[postfx][unit]") {
    Scene s;
    CHECK(taa::seenOwner(s.job, 5, 5).surface == kGround);
    s.setSample(6, 6, 7, 0.2f);
    CHECK(taa::seenOwner(s.job, 5, 5).surface == 7);
    s.setSample(6, 4, 8, 0.2f);
    CHECK(taa::seenOwner(s.job, 5, 5).surface == 8);
    s.setSample(4, 6, 9, 0.2f);
    CHECK(taa::seenOwner(s.job, 5, 5).surface == 9);
    s.setSample(5, 6, 10, 0.2f);
    CHECK(taa::seenOwner(s.job, 5, 5).surface == 10);
    CHECK(taa::seenOwner(s.job, 0, 0).surface == kGround);
    CHECK(taa::seenOwner(s.job, 11, 11).surface == kGround);
}

TEST_CASE("taa owner: a wire missed by a window is inferred where its way leads",
          "[postfx][unit]") {
    Scene rest;
    for (int x = 0; x < kSize; ++x) {
        const Owner owner = rest.ownerOf(x, 5);
        INFO(x);
        CHECK(owner.inferred == (x >= 4 && x <= 6));
        CHECK(owner.surface == (owner.inferred ? kWire : kGround));
        CHECK(owner.depth == (owner.inferred ? rest.wire_depth : logDepth16(depthBits(0.1f))));
        CHECK(owner.normal == (owner.inferred ? 77u : 0u));
    }
    const Scene moving({512, -256});  // two to the left, one down
    for (int x = 0; x + 2 < kSize; ++x) {
        INFO(x);
        CHECK(moving.ownerOf(x, 5).inferred == (x >= 2 && x <= 4));
    }
}

TEST_CASE("taa owner: nothing is inferred twice, from behind, from outside or without history",
          "[postfx][unit]") {
    Scene twice;
    for (int y = 0; y < kSize; ++y) {
        int16_t& owner = twice.before.planes[Slot::kOwner].at(5, y);
        owner = int16_t(owner | taa::kInferredBit);
    }
    CHECK_FALSE(twice.ownerOf(5, 5).inferred);
    CHECK(twice.ownerOf(4, 5).inferred);

    Scene behind;
    for (int y = 0; y < kSize; ++y) {
        behind.setBefore(5, y, kWire, uint16_t(logDepth16(depthBits(0.1f)) + taa::kDepthTolerance));
    }
    CHECK_FALSE(behind.ownerOf(5, 5).inferred);

    const Scene outside({int16_t(-6 * 256), 0});
    CHECK_FALSE(outside.ownerOf(5, 5).inferred);
    CHECK(outside.ownerOf(10, 5).inferred);

    const Scene none({kNoHistory, 0});
    CHECK_FALSE(none.ownerOf(5, 5).inferred);

    Scene first;
    first.job.frames = 1;
    CHECK_FALSE(first.ownerOf(5, 5).inferred);
}

TEST_CASE("taa owner: a wire that goes elsewhere, or is seen, is not inferred", "[postfx][unit]") {
    Scene away;
    for (int y = 0; y < kSize; ++y) {
        away.before.planes[Slot::kMotionX].at(5, y) = 1024;  // came from the right
    }
    CHECK_FALSE(away.ownerOf(5, 5).inferred);
    Scene seen;
    seen.setSample(5, 5, kWire, 0.3f);
    const Owner owner = seen.ownerOf(5, 5);
    CHECK_FALSE(owner.inferred);
    CHECK(owner.surface == kWire);
}

TEST_CASE("taa owner: every SIMD target records what the scalar twin records", "[postfx][unit]") {
    for (uint64_t seed = 1; seed <= 40; ++seed) {
        random_frames::Random random(seed);
        const int width = 1 + random.below(70), height = 1 + random.below(20);
        random_frames::Film film(width, height, seed % 2 == 0, seed);
        GBuffer gbuffer;
        Slot before;
        before.resize(width, height);
        for (int frame = 0; frame < 6; ++frame) {
            film.next(gbuffer);
            Job job;
            pointAt(gbuffer, job);
            job.frames = frame == 0 ? 1 : 2;
            Slot wanted;
            wanted.resize(width, height);
            job.record = wanted.out();
            job.hint = wanted.hints();
            job.slot[0] = wanted.in();
            job.slot[1] = before.in();
            const taa::TileRect all{0, 0, std::min(width, kTileSize), height};
            taa::recordTileReference(job, all);
            for (const SimdTarget target : availableSimdTargets()) {
                Slot got;
                got.resize(width, height);
                job.record = got.out();
                job.hint = got.hints();
                job.slot[0] = got.in();
                taa::tileKernels(target).record(job, all);
                int wrong = 0;
                for (int p = 0; p < Slot::kPlanes; ++p) {
                    for (int y = all.y0; y < all.y1; ++y) {
                        for (int x = all.x0; x < all.x1; ++x) {
                            wrong += got.planes[p].at(x, y) == wanted.planes[p].at(x, y) ? 0 : 1;
                        }
                    }
                }
                INFO(name(target) << " seed " << seed << " frame " << frame);
                CHECK(wrong == 0);
            }
            before = std::move(wanted);
        }
    }
}
