// The laboratory's SIMD kernels against the scalar truth, and one thread against many.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "postfx/laboratory.h"
#include "random_frames.h"
#include "random_policy.h"

namespace {

using namespace still;
using random_frames::Options;
using random_frames::Random;
using random_frames::randomPolicy;

struct Run {
    SimdTarget simd = SimdTarget::scalar;
    int threads = 1;
    Schedule schedule = Schedule::serial;
};

template <class T>
void append(std::vector<uint16_t>& values, ImageView<const T> plane) {
    for (int y = 0; y < plane.height; ++y) {
        values.insert(values.end(), plane.row(y), plane.row(y) + plane.width);
    }
}

/// Everything a caller can see of a run over random frames, including resets.
std::vector<uint16_t> resolveRandom(const Options& base, const TaaPolicy& policy, uint64_t seed,
                                    int frames, const Run& run) {
    Random random(seed);
    Workers workers(run.threads, run.schedule, seed);
    Laboratory laboratory;
    GBuffer gbuffer;
    std::vector<uint16_t> seen;
    for (int frame = 0; frame < frames; ++frame) {
        Options options = base;
        options.camera_moved = random.chance(60);
        options.patch = 3 + random.below(40);
        random_frames::fill(options, random, gbuffer);
        const LaboratoryFrame info{.reset = random.chance(5),
                                   .jitter_x_fx8 = random.below(256) - 128,
                                   .jitter_y_fx8 = random.below(256) - 128};
        laboratory.resolve(gbuffer, info, policy, run.simd, workers);
        append(seen, laboratory.colour().red);
        append(seen, laboratory.colour().green);
        append(seen, laboratory.colour().blue);
        append(seen, laboratory.confidence());
    }
    return seen;
}

void checkTargets(const Options& options, const TaaPolicy& policy, uint64_t seed, int frames) {
    const auto wanted = resolveRandom(options, policy, seed, frames, {});
    for (SimdTarget target : availableSimdTargets()) {
        if (target == SimdTarget::scalar) {
            continue;
        }
        INFO(name(target) << " " << options.width << "x" << options.height << " seed " << seed);
        const auto got = resolveRandom(options, policy, seed, frames, {.simd = target});
        const auto at = std::mismatch(got.begin(), got.end(), wanted.begin());
        INFO("first difference at value " << at.first - got.begin());
        CHECK(got == wanted);
    }
}

const Options kSizes[] = {{.width = 1, .height = 1},    {.width = 3, .height = 100},
                          {.width = 65, .height = 63},  {.width = 150, .height = 3},
                          {.width = 100, .height = 70}, {.width = 16, .height = 16}};

}  // namespace

TEST_CASE("lab: every SIMD target equals the scalar twin with every preset", "[postfx][unit]") {
    for (const TaaPreset& preset : taaPresets()) {
        if (preset.policy.method != Method::recursive) {
            continue;
        }
        for (const Options& size : kSizes) {
            INFO(preset.name);
            checkTargets(size, preset.policy, 1, 8);
            checkTargets(size, preset.policy, 2, 3);
        }
    }
}

TEST_CASE("lab: a preset compiled for itself equals the same policy read at run time",
          "[postfx][unit]") {
    // One unit of a threshold that no frame meets makes another policy, with the same result.
    const Options options{.width = 100, .height = 70};
    for (const TaaPreset& preset : taaPresets()) {
        TaaPolicy other = preset.policy;
        if (other.method != Method::recursive || other.sigma_still_fx8 != 0) {
            continue;
        }
        ++other.sigma_speed;
        INFO(preset.name);
        CHECK(resolveRandom(options, other, 5, 6, {.simd = bestSimdTarget()}) ==
              resolveRandom(options, preset.policy, 5, 6, {.simd = bestSimdTarget()}));
    }
}

TEST_CASE("lab: every SIMD target equals the scalar twin with random policies", "[postfx][unit]") {
    Random random(99);
    for (uint64_t seed = 1; seed <= 120; ++seed) {
        const TaaPolicy policy = randomPolicy(random);
        INFO("policy " << seed);
        checkTargets(kSizes[seed % std::size(kSizes)], policy, seed, 4);
    }
}

TEST_CASE("lab: threads and schedules do not change a bit", "[postfx][determinism]") {
    const Options options{.width = 300, .height = 150};
    for (const char* preset : {"basic", "fsr-like", "ema-consistent"}) {
        const TaaPolicy& policy = findPreset(preset)->policy;
        const SimdTarget simd = bestSimdTarget();
        const auto wanted = resolveRandom(options, policy, 7, 6, {.simd = simd});
        for (int threads : {2, 5}) {
            CHECK(resolveRandom(options, policy, 7, 6, {simd, threads, Schedule::pooled}) ==
                  wanted);
        }
        CHECK(resolveRandom(options, policy, 7, 6, {simd, 1, Schedule::shuffled}) == wanted);
        CHECK(resolveRandom(options, policy, 7, 6, {SimdTarget::scalar, 2, Schedule::pooled}) ==
              wanted);
    }
}
