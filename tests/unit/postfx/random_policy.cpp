#include "random_policy.h"

#include <string>
#include <string_view>
#include <vector>

namespace random_frames {

using namespace still;

namespace {

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

}  // namespace

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

}  // namespace random_frames
