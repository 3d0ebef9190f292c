#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "postfx/policy.h"

using namespace still;

namespace {

/// The choices in "a|b|c".
std::vector<std::string> choicesOf(std::string_view values) {
    std::vector<std::string> all{""};
    for (const char c : values) {
        if (c == '|') {
            all.emplace_back();
        } else {
            all.back() += c;
        }
    }
    return all;
}

TaaPolicy with(std::string_view key, std::string_view value) {
    TaaPolicy policy;
    INFO(key << "=" << value);
    CHECK(setPolicyKey(policy, key, value));
    return policy;
}

}  // namespace

TEST_CASE("policy: ours come first, names are unique and found", "[postfx][unit]") {
    const auto presets = taaPresets();
    REQUIRE(presets.size() == 17);
    CHECK(presets[0].name == "still");
    CHECK(presets[1].name == "fast");
    CHECK(presets[2].name == "tiny");
    std::set<std::string_view> names;
    for (const TaaPreset& preset : presets) {
        CHECK(names.insert(preset.name).second);
        CHECK_FALSE(preset.about.empty());
        REQUIRE(findPreset(preset.name) != nullptr);
        CHECK(findPreset(preset.name)->policy == preset.policy);
        const bool ours = names.size() <= 9;
        CHECK((preset.policy.method == Method::gather) == ours);
    }
    CHECK(findPreset("nothing") == nullptr);
    CHECK(findPreset("") == nullptr);
}

TEST_CASE("policy: the recipes hold their published constants", "[postfx][unit]") {
    CHECK(findPreset("basic")->policy.alpha_q15 == (32768 * 5 + 50) / 100);
    CHECK(findPreset("basic")->policy.rectification == Rectification::clamp);
    const TaaPolicy variance = findPreset("variance")->policy;
    CHECK(variance.alpha_q15 == 3277);
    CHECK(variance.sigma_fx8 == 256);
    CHECK(variance.rectification == Rectification::variance_clip);
    CHECK(variance.history == HistoryFilter::catmull_rom16);
    const TaaPolicy ema = findPreset("ema-consistent")->policy;
    CHECK(ema.alpha_q15 == (32768 * 2 + 5) / 10);
    CHECK(ema.history == HistoryFilter::validated);
    CHECK((ema.id_reject && ema.depth_reject_q15 > 0 && ema.normal_reject_q15 > 0));
}

TEST_CASE("policy: numbers are read exactly and rounded half up", "[postfx][unit]") {
    CHECK(with("alpha", "0.1").alpha_q15 == 3277);  // 3276.8
    CHECK(with("alpha", "1").alpha_q15 == 32768);
    CHECK(with("alpha", ".5").alpha_q15 == 16384);
    CHECK(with("alpha", "0.000015258").alpha_q15 == 0);  // just under half a unit
    CHECK(with("alpha", "0.000015259").alpha_q15 == 1);
    CHECK(with("sigma", "1.25").sigma_fx8 == 320);
    CHECK(with("depth_reject", "0.02").depth_reject_q15 == 655);
    CHECK(with("mip_bias", "-0.5").mip_bias_fx8 == -128);
    CHECK(with("mip_bias", "-0.001953125").mip_bias_fx8 == 0);  // −½ unit goes up
    CHECK(with("mip_bias", "-1.998046875").mip_bias_fx8 == -511);
    CHECK(with("mip_bias", "-0").mip_bias_fx8 == 0);
    CHECK(with("sharpness", "0.3").sharpness_q15 == 9830);
    CHECK(with("ring", "16").ring == 16);
    CHECK(with("count_cap", "32").count_cap == 32);
    CHECK(with("velocity_reject", "2.5").velocity_reject_fx8 == 640);
}

TEST_CASE("policy: wrong keys and values change nothing", "[postfx][unit]") {
    const TaaPolicy untouched;
    TaaPolicy policy;
    const std::pair<std::string_view, std::string_view> wrong[] = {
        {"alpha", "1.1"},
        {"alpha", "-0.1"},
        {"alpha", ""},
        {"alpha", "."},
        {"alpha", "0.1x"},
        {"alpha", "1e-1"},
        {"alpha", "+0.1"},
        {"alpha", "0.1 "},
        {"alpha", "--1"},
        {"alpha", "1.1.1"},
        {"alpha", "0.0000000001"},
        {"alpha", "0.2555555555555555555555"},
        {"ring", "25555555555555555555"},
        {"ring", "0"},
        {"ring", "17"},
        {"ring", "2.5"},
        {"ring", "4294967297"},
        {"nothing", "1"},
        {"", "1"},
        {"history", "cubic"},
        {"history", ""},
        {"dering", "yes"},
        {"history", "bilinear|validated"},
        {"alpha_q15", "1"}};
    for (const auto& [key, value] : wrong) {
        INFO(key << "=" << value);
        CHECK_FALSE(setPolicyKey(policy, key, value));
        CHECK(policy == untouched);
    }
}

TEST_CASE("policy: every listed choice is accepted, each gives another policy", "[postfx][unit]") {
    for (const TaaPolicyKey& key : taaPolicyKeys()) {
        if (key.values.find('|') == std::string_view::npos) {
            continue;
        }
        std::vector<TaaPolicy> seen;
        for (const std::string& value : choicesOf(key.values)) {
            const TaaPolicy policy = with(key.name, value);
            for (const TaaPolicy& other : seen) {
                INFO(key.name << "=" << value);
                CHECK_FALSE(policy == other);
            }
            seen.push_back(policy);
        }
    }
    CHECK(with("jitter", "blue-noise").jitter == JitterPattern::blue_noise);
    CHECK(with("history", "validated").history == HistoryFilter::validated);
    CHECK(with("sample", "lanczos2").sample == SampleFilter::lanczos2);
    CHECK(with("rectification", "rounded-clip").rectification == Rectification::rounded_clip);
    CHECK(with("anti_flicker", "luma-difference").anti_flicker == AntiFlicker::luma_difference);
    CHECK(with("blend", "velocity").blend == Blend::velocity);
    CHECK(with("dilation", "longest").dilation == Dilation::longest);
    CHECK(with("motion", "camera").motion == MotionSource::camera);
    CHECK(with("tone", "reinhard").tone == Tone::reinhard);
    CHECK(with("dering", "on").dering);
}

TEST_CASE("policy: every key's number is read back, held within its range", "[postfx][unit]") {
    for (const TaaPolicyKey& key : taaPolicyKeys()) {
        INFO(key.name);
        TaaPolicy policy;
        for (const int number : {key.low, key.high, (key.low + key.high) / 2}) {
            setPolicyNumber(policy, key, number);
            CHECK(policyNumber(policy, key) == number);
        }
        setPolicyNumber(policy, key, key.high + 1);
        CHECK(policyNumber(policy, key) == key.high);
        setPolicyNumber(policy, key, key.low - 1);
        CHECK(policyNumber(policy, key) == key.low);
        if (key.unit == 0) {
            const std::vector<std::string> choices = choicesOf(key.values);
            REQUIRE(int(choices.size()) == key.high + 1);
            for (int place = 0; place <= key.high; ++place) {
                CHECK(policyNumber(with(key.name, choices[size_t(place)]), key) == place);
            }
        }
    }
}

TEST_CASE("policy: frames are rounded up, and textures sharpened by the ratio", "[postfx][unit]") {
    CHECK(renderedSize(1920, kNativeRatio_fx8) == 1920);
    CHECK(renderedSize(1920, 384) == 1280);
    CHECK(renderedSize(1920, 512) == 960);
    CHECK(renderedSize(320, 384) == 214);  // 213.3
    CHECK(renderedSize(1, kMaxRatio_fx8) == 1);
    for (int ratio_fx8 = kNativeRatio_fx8; ratio_fx8 <= kMaxRatio_fx8; ++ratio_fx8) {
        TaaPolicy policy;
        policy.ratio_fx8 = ratio_fx8;
        policy.mip_bias_fx8 = -3;
        const double wanted = -3 - 256 * std::log2(ratio_fx8 / 256.0);
        CHECK(std::abs(mipBias_fx8(policy) - wanted) < 1);
    }
    CHECK(findPreset("performance")->policy.ratio_fx8 == 512);
    CHECK(mipBias_fx8(findPreset("performance")->policy) == -256);
    CHECK(mipBias_fx8({}) == 0);
    TaaPolicy policy = findPreset("quality")->policy;
    CHECK((upscales(policy) && upscalesInTime(policy)));
    policy.method = Method::recursive;
    CHECK((upscales(policy) && !upscalesInTime(policy)));
    CHECK_FALSE(upscalesInTime(findPreset("edge")->policy));
    CHECK_FALSE(upscales({}));
}
