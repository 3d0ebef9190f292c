#include "demos/stillframe/options.h"

#include <algorithm>
#include <charconv>
#include <string_view>

namespace still::command {
namespace {

constexpr int kMaxSsaaSamples = 65536;

/// The whole of `text` as a decimal number without sign.
std::optional<int> wholeNumber(std::string_view text) {
    int value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || stop != end || text.starts_with('-')) {
        return std::nullopt;
    }
    return value;
}

/// "a, b, c" of what `nameOf` makes of the elements.
template <class Range, class NameOf>
std::string listed(const Range& range, NameOf&& nameOf) {
    std::string list;
    for (const auto& element : range) {
        list += (list.empty() ? "" : ", ") + std::string(nameOf(element));
    }
    return list;
}

Outcome<AntiAliasingChoice> presetChoice(const std::string& name) {
    if (const TaaPreset* preset = findPreset(name)) {
        return AntiAliasingChoice{AntiAliasing::taa, 1, name, preset->policy};
    }
    return usageError("--anti-aliasing: taa:" + name + ": the presets are " +
                      listed(taaPresets(), [](const TaaPreset& preset) { return preset.name; }));
}

/// Applies one "key=value".
Outcome<void> applyTaaSetting(std::string_view setting, TaaPolicy& policy) {
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
        return usageError("--taa: " + std::string(setting) + ": " + std::string(name) + " takes " +
                          std::string(key.values));
    }
    return usageError("--taa: " + std::string(setting) + ": expected KEY=VALUE with a key of " +
                      listed(taaPolicyKeys(), [](const TaaPolicyKey& key) { return key.name; }));
}

constexpr DumpPlane kDumpPlanes[] = {DumpPlane::color,  DumpPlane::depth, DumpPlane::normal,
                                     DumpPlane::motion, DumpPlane::id,    DumpPlane::confidence};

std::optional<DumpPlane> dumpPlane(std::string_view text) {
    for (DumpPlane plane : kDumpPlanes) {
        if (dumpName(plane) == text) {
            return plane;
        }
    }
    return std::nullopt;
}

}  // namespace

Outcome<Size> parseResolution(const std::string& text) {
    const size_t separator = text.find_first_of("x,");
    if (separator != std::string::npos) {
        const auto width = wholeNumber(std::string_view(text).substr(0, separator));
        const auto height = wholeNumber(std::string_view(text).substr(separator + 1));
        const auto fits = [](std::optional<int> n) { return n && *n >= 1 && *n <= kMaxTargetSize; };
        if (fits(width) && fits(height)) {
            return Size{*width, *height};
        }
    }
    return usageError("--resolution: " + text + ": expected WIDTHxHEIGHT, each from 1 to " +
                      std::to_string(kMaxTargetSize));
}

Outcome<AntiAliasingChoice> parseAntiAliasing(const std::string& text) {
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
    if (text.starts_with(kSsaa)) {
        const auto samples = wholeNumber(std::string_view(text).substr(kSsaa.size()));
        if (samples && *samples >= 1 && *samples <= kMaxSsaaSamples) {
            return AntiAliasingChoice{AntiAliasing::ssaa, *samples, {}, {}};
        }
    }
    return usageError("--anti-aliasing: " + text +
                      ": expected none, taa, taa:PRESET, fxaa or ssaa:N with N from 1 to " +
                      std::to_string(kMaxSsaaSamples));
}

Outcome<TaaPolicy> parseTaaSettings(const std::string& text, TaaPolicy policy) {
    for (size_t begin = 0; begin < text.size();) {
        const size_t end = std::min(text.find(',', begin), text.size());
        const auto setting = std::string_view(text).substr(begin, end - begin);
        if (auto applied = applyTaaSetting(setting, policy); !applied) {
            return tl::make_unexpected(applied.error());
        }
        begin = end + 1;
    }
    return policy;
}

std::string dumpName(DumpPlane plane) {
    switch (plane) {
        case DumpPlane::color:
            return "color";
        case DumpPlane::depth:
            return "depth";
        case DumpPlane::normal:
            return "normal";
        case DumpPlane::motion:
            return "motion";
        case DumpPlane::id:
            return "id";
        case DumpPlane::confidence:
            return "confidence";
    }
    return {};
}

Outcome<std::vector<DumpPlane>> parseDump(const std::string& text) {
    std::vector<DumpPlane> planes;
    for (size_t begin = 0; begin < text.size();) {
        const size_t end = std::min(text.find(',', begin), text.size());
        const auto plane = dumpPlane(std::string_view(text).substr(begin, end - begin));
        if (!plane) {
            return usageError("--dump: " + text.substr(begin, end - begin) +
                              ": expected planes out of color,depth,normal,motion,id,confidence");
        }
        planes.push_back(*plane);
        begin = end + 1;
    }
    return planes;
}

Outcome<SimdTarget> parseSimd(const std::string& text) {
    if (text.empty()) {
        return bestSimdTarget();
    }
    const auto targets = availableSimdTargets();
    for (SimdTarget target : targets) {
        if (name(target) == text) {
            return target;
        }
    }
    return usageError("--simd: " + text + ": this machine and build have " +
                      listed(targets, [](SimdTarget target) { return name(target); }));
}

}  // namespace still::command
