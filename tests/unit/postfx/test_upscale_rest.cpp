// Upscaling: tiles of the frame that rest while others move keep samples of other offsets.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <vector>

#include "postfx/upscale.h"
#include "synthetic.h"
#include "taa_runs.h"

namespace {

using namespace still;
using synthetic::Pose;
using synthetic::World;
using taa_runs::backdrop;
using taa_runs::square;

constexpr int kWidth = 200, kHeight = 140;  ///< of the frames: 4 × 3 tiles
constexpr int kStart = 44;                  ///< when the camera sets off

/// A square that never stops in the upper left; from frame kStart on the camera moves.
World busyCorner(int frame) {
    World world{kWidth, kHeight, frame >= kStart, {backdrop()}};
    const auto panned = [](int f) { return std::max(f - kStart + 1, 0); };
    world.layers[0].pose = [=](int f) { return Pose{{0.73 * panned(f), 0.41 * panned(f)}}; };
    world.layers.push_back(square(7, [=](int f) {
        return Pose{{25 + 6 * std::sin(0.5 * f) + 0.73 * panned(f), 25 + 0.41 * panned(f)}};
    }));
    world.layers[1].moves = true;
    return world;
}

struct Run {
    TemporalUpscaler upscaler;
    UpscaleSettings settings{.width = 300, .height = 210, .sample_cap = 16, .ring = 8};

    void resolve(const GBuffer& gbuffer, int frame, bool reset, bool looked_at, Workers& workers) {
        const auto [x_fx8, y_fx8] = synthetic::jitter(frame);
        upscaler.resolve(
            gbuffer,
            {.reset = reset, .jitter_x_fx8 = x_fx8, .jitter_y_fx8 = y_fx8, .looked_at = looked_at},
            settings, workers);
    }
    std::vector<uint16_t> shown() const {
        std::vector<uint16_t> all;
        const ColourPlanes colour = upscaler.colour();
        for (const auto& plane : {colour.red, colour.green, colour.blue}) {
            const std::vector<uint16_t> copy = taa_runs::copyOf(plane);
            all.insert(all.end(), copy.begin(), copy.end());
        }
        return all;
    }
};

}  // namespace

TEST_CASE("upscale: tiles away from what moves need no samples once they are finished",
          "[postfx][unit]") {
    Run run;
    Workers workers(1);
    GBuffer gbuffer;
    size_t least = 12;
    for (int frame = 0; frame < kStart; ++frame) {
        synthetic::render(busyCorner(frame), frame, gbuffer);
        const auto wanted =
            run.upscaler.plan(kWidth, kHeight, gbuffer.tiles, {.reset = frame == 0}, run.settings);
        const size_t asked = size_t(std::count(wanted.begin(), wanted.end(), 1));
        CHECK(asked >= 1);
        CHECK((frame > 0 || asked == 12));
        least = std::min(least, asked);
        run.resolve(gbuffer, frame, frame == 0, true, workers);
    }
    CHECK(least <= 4);
    // Of the image, 5 × 4 tiles: the corner is at work, the other end rests.
    const std::vector<TileWork> work = run.upscaler.tileWork();
    REQUIRE(work.size() == 5 * 4);
    CHECK((work.front().drawn && work.front().recorded && work.front().resolved));
    CHECK_FALSE((work.back().drawn || work.back().recorded || work.back().summed));
    CHECK_FALSE(work.back().resolved);
    CHECK(work.back().finished);
}

TEST_CASE("upscale: every SIMD target gathers from tiles that rest apart as the scalar twin does",
          "[postfx][unit]") {
    std::vector<std::unique_ptr<Run>> runs;
    for (const SimdTarget target : availableSimdTargets()) {
        runs.push_back(std::make_unique<Run>());
        runs.back()->settings.simd = target;
    }
    Workers workers(1);
    GBuffer gbuffer;
    for (int frame = 0; frame < kStart + 3; ++frame) {
        synthetic::render(busyCorner(frame), frame, gbuffer);
        std::vector<uint16_t> expected;
        for (const auto& run : runs) {
            run->resolve(gbuffer, frame, frame == 0, frame >= kStart, workers);
            if (frame >= kStart) {
                const std::vector<uint16_t> found = run->shown();
                expected = expected.empty() ? found : expected;
                INFO("frame " << frame << " with " << name(run->settings.simd));
                REQUIRE((found == expected));
            }
        }
    }
}

TEST_CASE("upscale: tiles that wake up look as if they had never rested", "[postfx][unit]") {
    Run rested, young;
    Workers workers(1);
    GBuffer gbuffer;
    for (int frame = 0; frame <= kStart + 1; ++frame) {
        synthetic::render(busyCorner(frame), frame, gbuffer);
        rested.resolve(gbuffer, frame, frame == 0, frame >= kStart, workers);
        if (frame >= kStart - 9) {  // a full ring, but no time to rest
            young.resolve(gbuffer, frame, frame == kStart - 9, true, workers);
        }
    }
    World large = busyCorner(kStart + 1);
    large.width = young.settings.width;
    large.height = young.settings.height;
    for (synthetic::Layer& layer : large.layers) {
        const auto pose = layer.pose;
        layer.pose = [pose](int frame) {
            Pose p = pose(frame);
            p.offset = {(p.offset.x + 0.5) * 1.5 - 0.5, (p.offset.y + 0.5) * 1.5 - 0.5};
            p.scale *= 1.5;
            return p;
        };
    }
    const auto wanted = synthetic::reference(large, kStart + 1, 6);
    const auto errorOf = [&](const Run& run) {
        const ColourPlanes colour = run.upscaler.colour();
        return synthetic::psnr(colour.red, colour.green, colour.blue, wanted, 8);
    };
    INFO(errorOf(rested) << " dB rested, " << errorOf(young) << " dB young");
    CHECK(errorOf(rested) > errorOf(young) - 1);
}
