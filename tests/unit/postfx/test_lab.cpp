// The laboratory's rules on small worlds and single pixels with known answers: blends, history,
// tests of history.

#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "lab_bench.h"
#include "synthetic.h"

using namespace lab_bench;
using synthetic::Colour;
using synthetic::Layer;
using synthetic::Point;
using synthetic::World;

namespace {

/// What red 1000 becomes after one frame of 2000.
int afterStep(const TaaPolicy& policy) {
    Bench bench(1000);
    bench.show(policy);
    bench.fill(2000);
    bench.show(policy);
    return bench.red();
}

}  // namespace

TEST_CASE("lab: a mean without rectification is the exact mean of its samples", "[postfx][unit]") {
    World world{70, 66, false, {}};
    Layer disc;
    disc.surface = 1;
    disc.colour = [](Point p) {
        return std::hypot(p.x - 30, p.y - 30) < 17.3 ? Colour{0.9, 0.4, 11.0}
                                                     : synthetic::noise(p, 3);
    };
    world.layers.push_back(disc);
    TaaPolicy policy = plain();
    policy.blend = Blend::mean;
    policy.count_cap = 255;
    Laboratory laboratory;
    Workers workers(1, Schedule::serial);
    GBuffer gbuffer;
    std::vector<uint64_t> sum(size_t(world.width * world.height));
    for (int frame = 0; frame < 255; ++frame) {
        synthetic::render(world, 0, synthetic::jitter(frame), gbuffer, false);
        laboratory.resolve(gbuffer, {.reset = frame == 0}, policy, bestSimdTarget(), workers);
        const auto n = uint64_t(frame + 1);
        int wrong = 0;
        for (int y = 0; y < world.height; ++y) {
            for (int x = 0; x < world.width; ++x) {
                uint64_t& s = sum[size_t(y * world.width + x)];
                s += gbuffer.blue.at(x, y);
                wrong += laboratory.colour().blue.at(x, y) == (2 * s + n) / (2 * n) ? 0 : 1;
            }
        }
        REQUIRE(wrong == 0);
    }
}

TEST_CASE("lab: a fixed share converges, however small", "[postfx][unit]") {
    for (const int alpha : {328, 1638, 3277, 16384, 32768}) {
        for (const int target : {0, 1, 700, 65535}) {
            Bench bench(target > 0 ? 0 : 5000);
            TaaPolicy policy = plain();
            policy.alpha_q15 = alpha;
            bench.show(policy);
            bench.fill(target);
            for (int frame = 0; frame < 16 * 32768 / alpha; ++frame) {
                bench.show(policy);
            }
            INFO("alpha " << alpha << " to " << target);
            CHECK(bench.red() == target);
        }
    }
    CHECK(afterStep(plain()) == 1250);
}

TEST_CASE("lab: blends take the share they say", "[postfx][unit]") {
    TaaPolicy policy = plain();
    policy.blend = Blend::mean;
    CHECK(afterStep(policy) == 1500);
    policy.count_cap = 1;
    CHECK(afterStep(policy) == 2000);
    policy = plain();
    policy.blend = Blend::confidence;  // a third after one frame: 1 − 0.75 / 3
    CHECK(afterStep(policy) == 1750);
    policy = plain();
    policy.blend = Blend::velocity;
    policy.velocity_alpha_q15 = 4096;
    CHECK(afterStep(policy) == 1250);
    Bench bench(1000);
    bench.show(policy);
    bench.fill(2000);
    bench.setMotion(0, 512);  // two pixels: 0.25 + 2 / 8, the length known to 2 %
    bench.show(policy);
    CHECK(std::abs(bench.red() - 1500) <= 5);
}

TEST_CASE("lab: confidence grows by thirds and starts anew where history ends", "[postfx][unit]") {
    Bench bench;
    TaaPolicy policy = plain();
    policy.blend = Blend::confidence;
    policy.alpha_q15 = 1638;
    for (const int wanted : {0, 85, 170, 255, 255}) {
        bench.show(policy);
        CHECK(bench.confidence() == wanted);
    }
    bench.setMotion(kWidth * 256, 0);
    bench.show(policy);
    CHECK(bench.confidence() == 0);
    policy.blend = Blend::mean;
    policy.count_cap = 4;
    bench.setMotion(0, 0);
    for (const int wanted : {0, 85, 170, 255, 255}) {
        bench.show(policy);
        CHECK(bench.confidence() == wanted);
    }
}

TEST_CASE("lab: every test rejects what it must and lets the rest pass", "[postfx][unit]") {
    const auto red = [](TaaPolicy policy, auto&& change) {
        Bench bench(1000);
        bench.show(policy);
        bench.fill(2000);
        change(bench);
        bench.show(policy);
        return bench.red();
    };
    for (const HistoryFilter filter : {HistoryFilter::bilinear, HistoryFilter::validated}) {
        TaaPolicy p = plain();
        p.history = filter;
        p.depth_reject_q15 = 655;
        CHECK(red(p, [](Bench& b) { b.setDepth(0.25f, 0.25f * 1.015f); }) == 1250);
        CHECK(red(p, [](Bench& b) { b.setDepth(0.25f, 0.25f * 1.025f); }) == 2000);
        CHECK(red(p, [](Bench& b) { b.setDepth(0.25f, 0.25f * 0.985f); }) == 1250);
        CHECK(red(p, [](Bench& b) { b.setDepth(0.25f, 0.25f * 0.975f); }) == 2000);
        CHECK(red(p, [](Bench& b) { b.setDepth(0.25f, 0.001f); }) == 2000);
        p.depth_reject_q15 = 0;
        p.normal_reject_q15 = 29491;                                     // 0.9: 25.8°
        CHECK(red(p, [](Bench& b) { b.setNormal(8000, 0); }) == 1250);   // 17°
        CHECK(red(p, [](Bench& b) { b.setNormal(13000, 0); }) == 2000);  // 33°
        p.normal_reject_q15 = 0;
        p.id_reject = true;
        CHECK(red(p, [](Bench& b) { b.setId(1 | kMovedBit); }) == 1250);
        CHECK(red(p, [](Bench& b) { b.setId(2); }) == 2000);
    }
    TaaPolicy p = plain();
    p.velocity_reject_fx8 = 640;
    CHECK(red(p, [](Bench& b) { b.setMotion(256 * 2, 256); }) == 1250);
    CHECK(red(p, [](Bench& b) { b.setMotion(256 * 2, 512); }) == 2000);
    p = plain();
    p.luma_reject_q15 = 20000;
    CHECK(red(p, [](Bench&) {}) == 1250);
    p.luma_reject_q15 = 16000;
    CHECK(red(p, [](Bench&) {}) == 2000);
    p = plain();
    CHECK(red(p, [](Bench& b) { b.setMotion(kNoHistory, 0); }) == 2000);
    CHECK(red(p, [](Bench& b) { b.setMotion(-10 * 256 - 128, 0); }) == 1250);
    CHECK(red(p, [](Bench& b) { b.setMotion(-10 * 256 - 129, 0); }) == 2000);
    CHECK(red(p, [](Bench& b) { b.setMotion(0, (kHeight - 11) * 256 + 127); }) == 1250);
    CHECK(red(p, [](Bench& b) { b.setMotion(0, (kHeight - 11) * 256 + 128); }) == 2000);
}

TEST_CASE("lab: a failed test halves history when rejection is partial", "[postfx][unit]") {
    TaaPolicy policy = plain();
    policy.partial = true;
    policy.id_reject = true;
    Bench bench(1000);
    bench.show(policy);
    bench.fill(2000);
    bench.setId(2);
    bench.show(policy);
    CHECK(bench.red() == 1000 + 625);  // 1 − 0.75 / 2
    CHECK(bench.confidence() == 128);
}

TEST_CASE("lab: validated taps come from their own surface only", "[postfx][unit]") {
    Bench bench;
    TaaPolicy policy = plain();
    policy.alpha_q15 = 0;
    policy.history = HistoryFilter::validated;
    policy.id_reject = true;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const bool right = x >= 10;
            bench.gbuffer.id.at(x, y) = right ? 2 : 1;
            bench.set(x, y, right ? 4000 : 1000, 0, 0);
        }
    }
    bench.show(policy);
    bench.setMotion(-64, 32);
    bench.fill(9);
    bench.show(policy);
    CHECK(bench.red(10) == 4000);  // ¼ of its taps belongs to the other surface
    CHECK(bench.red(9) == 1000);
    bench.show(policy, true);
    for (int y = 0; y < kHeight; ++y) {  // a column of surface 3, one pixel beside its history
        bench.gbuffer.id.at(12, y) = 3;
    }
    bench.setMotion(0, 0);
    bench.fill(700);
    bench.show(policy, true);
    bench.setId(3);
    bench.fill(9);
    bench.show(policy);
    CHECK(bench.red(12) == 700);
    CHECK(bench.red(13) == 700);  // 3×3
    CHECK(bench.red(14) == 9);    // nothing
}

TEST_CASE("lab: the guide's motion is used", "[postfx][unit]") {
    const auto history = [](Dilation dilation) {
        TaaPolicy policy = plain();
        policy.alpha_q15 = 0;
        policy.dilation = dilation;
        Bench bench;
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                bench.set(x, y, 100 * x, 0, 0);
            }
        }
        bench.show(policy);
        bench.gbuffer.depth.at(11, 11) = std::bit_cast<uint32_t>(0.5f);
        bench.gbuffer.motion.at(11, 11) = {-256, 0};
        bench.gbuffer.motion.at(9, 9) = {512, 256};
        bench.gbuffer.motion.at(10, 9) = {kNoHistory, 0};
        bench.show(policy);
        return bench.red() / 100;
    };
    CHECK(history(Dilation::centre) == 10);
    CHECK(history(Dilation::nearest_depth) == 9);
    CHECK(history(Dilation::longest) == 12);
}

TEST_CASE("lab: history filters interpolate, and dering keeps within the inner taps",
          "[postfx][unit]") {
    const auto atHalf = [](HistoryFilter filter, bool dering, const std::vector<int>& columns) {
        TaaPolicy policy = plain();
        policy.alpha_q15 = 0;
        policy.history = filter;
        policy.dering = dering;
        Bench bench;
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                const size_t i = size_t(std::clamp(x - 9, 0, 3));
                bench.set(x, y, columns[i], columns[i], columns[i]);
            }
        }
        bench.show(policy);
        bench.setMotion(128, 0);
        bench.show(policy);
        return bench.red();
    };
    const std::vector<int> edge{1000, 1000, 3000, 3000}, bar{0, 3200, 3200, 0};
    CHECK(atHalf(HistoryFilter::nearest, false, edge) == 3000);
    CHECK(atHalf(HistoryFilter::bilinear, false, edge) == 2000);
    for (const HistoryFilter filter : {HistoryFilter::catmull_rom5, HistoryFilter::catmull_rom16}) {
        CHECK(atHalf(filter, false, edge) == 2000);
        CHECK(atHalf(filter, false, {0, 3200, 3200, 0}) == 3600);  // 9/16 · 2 · 3200
        CHECK(atHalf(filter, true, bar) == 3200);
        CHECK(atHalf(filter, false, {3200, 0, 0, 3200}) == 0);
    }
}

TEST_CASE("lab: anti-flicker weights follow their formulas", "[postfx][unit]") {
    TaaPolicy policy = plain();
    policy.alpha_q15 = 16384;
    policy.anti_flicker = AntiFlicker::inverse_luminance;
    const auto blended = [&](int history, int sample) {
        Bench bench(history);
        bench.show(policy);
        bench.fill(sample);
        bench.show(policy);
        return bench.red();
    };
    CHECK(std::abs(blended(0, 12288) - 12288 / 5) <= 4);  // weights 1 and 1/4
    CHECK(std::abs(blended(12288, 0) - 12288 / 5) <= 4);
    policy.anti_flicker = AntiFlicker::inverse_log;
    CHECK(std::abs(blended(0, 12288) - 12288 / 4) <= 4);  // 1 + log2(1 + 3) = 3
    policy.anti_flicker = AntiFlicker::luma_difference;
    policy.steady_share_q15 = 8192;
    CHECK(blended(1000, 1000) == 1000);
    CHECK(std::abs(blended(0, 4000) - 2000) <= 4);  // (1 − 1)² = 0: the whole alpha
    // (1 − 1/2)² = 1/4: alpha · (1 − ¾ · ¼)
    CHECK(std::abs(blended(2000, 4000) - (2000 + 813)) <= 4);
}

TEST_CASE("lab: tone-mapped blending hides what is far brighter", "[postfx][unit]") {
    TaaPolicy policy = plain();
    policy.alpha_q15 = 16384;
    policy.tone = Tone::reinhard;
    Bench bench(0);
    bench.show(policy);
    bench.fill(12288);  // 3 ↦ 3/4; the mean, 3/8, ↦ 3/5
    bench.show(policy);
    CHECK(std::abs(bench.red() - 2458) <= 2);
    for (const int grey : {0, 1, 100, 4096, 65535}) {
        bench.fill(grey, grey / 2, grey / 3);
        bench.show(policy, true);
        INFO(grey);
        CHECK(std::abs(bench.red() - grey) <= grey / 100);
        CHECK(std::abs(bench.green() - grey / 2) <= grey / 100);
    }
}

TEST_CASE("lab: reset, another size and another policy start anew", "[postfx][unit]") {
    Bench bench(1000);
    bench.show(plain());
    bench.fill(2000);
    bench.show(plain(), true);
    CHECK(bench.red() == 2000);
    TaaPolicy other = plain();
    other.alpha_q15 = 16384;
    bench.fill(3000);
    bench.show(other);
    CHECK(bench.red() == 3000);
    other.jitter = JitterPattern::none;  // nothing that the resolve reads
    bench.fill(5000);
    bench.show(other);
    CHECK(bench.red() == 4000);
    bench.gbuffer.resize(kWidth + 1, kHeight, bench.gbuffer.planes);
    bench.fill(100);
    bench.show(other);
    CHECK(bench.red() == 100);
    CHECK(bench.laboratory.colour().red.width == kWidth + 1);
}
