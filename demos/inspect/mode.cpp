#include "demos/inspect/mode.h"

#include "engine/anti_aliasing.h"

namespace still::inspect {

constexpr std::string_view kNoisy = ":denoise=off";

bool operator==(const Mode& a, const Mode& b) {
    return a.anti_aliasing == b.anti_aliasing &&
           (a.anti_aliasing != AntiAliasing::taa || a.policy == b.policy) &&
           (a.anti_aliasing == AntiAliasing::ssaa ? a.ssaa_samples == b.ssaa_samples
                                                  : a.denoise == b.denoise);
}

std::optional<Mode> modeNamed(std::string_view name) {
    if (name.ends_with(kNoisy)) {
        std::optional<Mode> mode = modeNamed(name.substr(0, name.size() - kNoisy.size()));
        if (!mode || mode->anti_aliasing == AntiAliasing::ssaa) {
            return std::nullopt;
        }
        mode->denoise = Denoise::off;
        return mode;
    }
    if (name == "raw") {
        return Mode{.anti_aliasing = AntiAliasing::none};
    }
    if (const TaaPreset* preset = findPreset(name)) {
        return Mode{.anti_aliasing = AntiAliasing::taa, .policy = preset->policy};
    }
    if (name == "fxaa" || name.starts_with("ssaa:")) {
        if (const auto choice = parseAntiAliasing(name)) {
            return Mode{.anti_aliasing = choice->mode, .ssaa_samples = choice->ssaa_samples};
        }
    }
    return std::nullopt;
}

std::string nameOf(const Mode& mode) {
    if (mode.denoise == Denoise::off && mode.anti_aliasing != AntiAliasing::ssaa) {
        Mode denoised = mode;
        denoised.denoise = Denoise::svgf;
        return nameOf(denoised) + std::string(kNoisy);
    }
    switch (mode.anti_aliasing) {
        case AntiAliasing::none:
            return "raw";
        case AntiAliasing::fxaa:
            return "fxaa";
        case AntiAliasing::ssaa:
            return "ssaa:" + std::to_string(mode.ssaa_samples);
        case AntiAliasing::taa:
            break;
    }
    for (const TaaPreset& preset : taaPresets()) {
        if (preset.policy == mode.policy) {
            return std::string(preset.name);
        }
    }
    return "custom";
}

std::vector<std::string> modeNames() {
    std::vector<std::string> names{"raw", "fxaa"};
    for (const TaaPreset& preset : taaPresets()) {
        names.emplace_back(preset.name);
    }
    names.emplace_back("ssaa:64");
    return names;
}

}  // namespace still::inspect
