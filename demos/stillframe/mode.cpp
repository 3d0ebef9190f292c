#include "demos/stillframe/mode.h"

#include <algorithm>
#include <optional>

#include "demos/stillframe/options.h"

namespace still::command {
namespace {

std::vector<std::string> splitAt(const std::string& text, char separator) {
    std::vector<std::string> parts;
    for (size_t begin = 0; begin < text.size();) {
        const size_t end = std::min(text.find(separator, begin), text.size());
        parts.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return parts;
}

Mode presetMode(const TaaPreset& preset) {
    return {.name = std::string(preset.name),
            .anti_aliasing = AntiAliasing::taa,
            .policy = preset.policy};
}

std::optional<Mode> findMode(const std::string& name) {
    const std::vector<Mode> modes = allModes();
    const auto found = std::find_if(modes.begin(), modes.end(),
                                    [&](const Mode& mode) { return mode.name == name; });
    if (found != modes.end()) {
        return *found;
    }
    const auto choice = parseAntiAliasing(name);
    if (choice && choice->mode == AntiAliasing::ssaa) {
        return Mode{.name = name,
                    .anti_aliasing = AntiAliasing::ssaa,
                    .ssaa_samples = choice->ssaa_samples};
    }
    return std::nullopt;
}

std::string knownModes() {
    std::string names;
    for (const Mode& mode : allModes()) {
        names += mode.name + ", ";
    }
    return names + "ssaa:N";
}

/// Where the settings of "bicubic:ratio=2" begin; an N of "ssaa:N" is none.
size_t settingsAt(const std::string& text) {
    const size_t equals = text.find('=');
    return equals == std::string::npos ? text.size() : std::min(text.rfind(':', equals), equals);
}

/// One "KEY=VALUE" of a mode.
Outcome<void> applySetting(const std::string& setting, Mode& mode) {
    if (setting == "denoise=on" || setting == "denoise=off") {
        mode.denoise = setting == "denoise=on" ? Denoise::svgf : Denoise::off;
        return {};
    }
    if (!mode.temporal() || setting.starts_with("denoise=")) {
        return usageError(setting + ": expected denoise=on or denoise=off");
    }
    const auto policy = still::parseTaaSettings(setting, mode.policy);
    if (!policy) {
        return usageError(policy.error().message);
    }
    mode.policy = *policy;
    return {};
}

Outcome<Mode> modeFrom(const std::string& text) {
    const size_t end = settingsAt(text);
    auto mode = findMode(text.substr(0, end));
    if (!mode) {
        return usageError(text + ": expected names out of " + knownModes());
    }
    mode->name = text;
    for (const std::string& setting : splitAt(text.substr(std::min(end + 1, text.size())), ':')) {
        if (auto applied = applySetting(setting, *mode); !applied) {
            return usageError(text + ": " + applied.error().message);
        }
    }
    return *mode;
}

}  // namespace

FrameSettings Mode::settings(const FrameSettings& view) const {
    FrameSettings settings = view;
    settings.anti_aliasing = anti_aliasing;
    settings.ssaa_samples = ssaa_samples;
    settings.policy = policy;
    settings.denoise = denoise;
    return settings;
}

std::vector<Mode> allModes() {
    std::vector<Mode> modes{{.name = "raw", .anti_aliasing = AntiAliasing::none},
                            {.name = "fxaa", .anti_aliasing = AntiAliasing::fxaa}};
    for (const TaaPreset& preset : taaPresets()) {
        modes.push_back(presetMode(preset));
    }
    return modes;
}

Outcome<std::vector<Mode>> parseModes(const std::string& text, const std::string& option) {
    if (text.empty()) {
        return allModes();
    }
    std::vector<Mode> modes;
    for (const std::string& name : splitAtCommas(text)) {
        auto mode = modeFrom(name);
        if (!mode) {
            return usageError(option + ": " + mode.error().message);
        }
        modes.push_back(std::move(*mode));
    }
    return modes;
}

std::vector<std::string> splitAtCommas(const std::string& text) {
    return splitAt(text, ',');
}

}  // namespace still::command
