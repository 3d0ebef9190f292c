// The laboratory's SIMD kernels against the scalar truth, and one thread against many.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "postfx/laboratory.h"
#include "random_frames.h"

namespace {

using namespace still;
using random_frames::Options;
using random_frames::Random;

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

/// One of the values that a key allows.
std::string randomValue(Random& random, std::string_view values) {
    std::vector<std::string> choices{""};
    for (const char c : values) {
        if (c == '|') {
            choices.emplace_back();
        } else {
            choices.back() += c;
        }
    }
    return choices[size_t(random.below(int(choices.size())))];
}

/// Any combination of everything, with thresholds that random frames sometimes pass.
TaaPolicy randomPolicy(Random& random) {
    TaaPolicy policy;
    for (const TaaPolicyKey& key : taaPolicyKeys()) {
        if (key.values.find('|') != std::string_view::npos) {
            setPolicyKey(policy, key.name, randomValue(random, key.values));
        }
    }
    const auto sometimes = [&](int range) {
        return random.chance(50) ? 0 : 1 + random.below(range);
    };
    policy.method = Method::recursive;
    policy.alpha_q15 = random.below(32769);
    policy.count_cap = 1 + random.below(255);
    policy.velocity_alpha_q15 = random.below(8000);
    policy.steady_share_q15 = random.below(32769);
    policy.sigma_fx8 = random.below(1025);
    policy.sigma_still_fx8 = sometimes(1024);
    policy.sigma_speed = 1 + random.below(random.chance(50) ? 20 : 1000);
    policy.depth_reject_q15 = sometimes(4000);
    policy.normal_reject_q15 = sometimes(32768);
    policy.velocity_reject_fx8 = sometimes(32512);
    policy.luma_reject_q15 = sometimes(32768);
    return policy;
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
