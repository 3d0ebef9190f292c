#include "engine/anti_aliasing.h"

#include <algorithm>
#include <charconv>

namespace still {
namespace {

constexpr int kMaxSsaaSamples = 65536;

/// "a, b, c" of the elements' names.
template <class Range>
std::string namesOf(const Range& range) {
    std::string list;
    for (const auto& element : range) {
        list += (list.empty() ? "" : ", ") + std::string(element.name);
    }
    return list;
}

/// The whole of `text` as a number from 1 to kMaxSsaaSamples, else 0.
int samplesFrom(std::string_view text) {
    int value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    const bool whole = error == std::errc() && stop == end;
    return whole && value >= 1 && value <= kMaxSsaaSamples ? value : 0;
}

Result<AntiAliasingChoice> presetChoice(std::string_view name) {
    if (const TaaPreset* preset = findPreset(name)) {
        return AntiAliasingChoice{AntiAliasing::taa, 1, std::string(name), preset->policy};
    }
    return fail("taa:" + std::string(name) + ": the presets are " + namesOf(taaPresets()));
}

/// Applies one "key=value".
Result<void> applySetting(std::string_view setting, TaaPolicy& policy) {
    const size_t equals = setting.find('=');
    const std::string_view name = setting.substr(0, equals);
    for (const TaaPolicyKey& key : taaPolicyKeys()) {
        if (key.name != name) {
            continue;
        }
        if (equals != std::string_view::npos &&
            setPolicyKey(policy, name, setting.substr(equals + 1))) {
            return {};
        }
        return fail(std::string(setting) + ": " + std::string(name) + " takes " +
                    std::string(key.values));
    }
    return fail(std::string(setting) + ": expected KEY=VALUE with a key of " +
                namesOf(taaPolicyKeys()));
}

}  // namespace

Result<AntiAliasingChoice> parseAntiAliasing(std::string_view text) {
    constexpr std::string_view kSsaa = "ssaa:", kTaa = "taa:";
    if (text == "none") {
        return AntiAliasingChoice{AntiAliasing::none, 1, {}, {}};
    }
    if (text == "fxaa") {
        return AntiAliasingChoice{AntiAliasing::fxaa, 1, {}, {}};
    }
    if (text == "taa") {
        return presetChoice("still");
    }
    if (text.starts_with(kTaa)) {
        return presetChoice(text.substr(kTaa.size()));
    }
    const int samples = text.starts_with(kSsaa) ? samplesFrom(text.substr(kSsaa.size())) : 0;
    if (samples > 0) {
        return AntiAliasingChoice{AntiAliasing::ssaa, samples, {}, {}};
    }
    return fail(std::string(text) +
                ": expected none, taa, taa:PRESET, fxaa or ssaa:N with N from 1 to " +
                std::to_string(kMaxSsaaSamples));
}

Result<TaaPolicy> parseTaaSettings(std::string_view text, TaaPolicy policy) {
    for (size_t begin = 0; begin < text.size();) {
        const size_t end = std::min(text.find(',', begin), text.size());
        if (auto applied = applySetting(text.substr(begin, end - begin), policy); !applied) {
            return tl::make_unexpected(applied.error());
        }
        begin = end + 1;
    }
    return policy;
}

}  // namespace still
