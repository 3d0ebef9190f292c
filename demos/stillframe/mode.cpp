#include "demos/stillframe/mode.h"

#include <algorithm>
#include <optional>

#include "demos/stillframe/options.h"

namespace still::command {
namespace {

Mode presetMode(const TaaPreset& preset) {
    return {std::string(preset.name), AntiAliasing::taa, 1, preset.policy};
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
        return Mode{name, AntiAliasing::ssaa, choice->ssaa_samples, {}};
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

}  // namespace

FrameSettings Mode::settings(const FrameSettings& view) const {
    FrameSettings settings = view;
    settings.anti_aliasing = anti_aliasing;
    settings.ssaa_samples = ssaa_samples;
    settings.policy = policy;
    return settings;
}

std::vector<Mode> allModes() {
    std::vector<Mode> modes{{"raw", AntiAliasing::none, 1, {}},
                            {"fxaa", AntiAliasing::fxaa, 1, {}}};
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
        const auto mode = findMode(name);
        if (!mode) {
            return usageError(option + ": " + name + ": expected names out of " + knownModes());
        }
        modes.push_back(*mode);
    }
    return modes;
}

std::vector<std::string> splitAtCommas(const std::string& text) {
    std::vector<std::string> parts;
    for (size_t begin = 0; begin < text.size();) {
        const size_t end = std::min(text.find(',', begin), text.size());
        parts.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return parts;
}

}  // namespace still::command
