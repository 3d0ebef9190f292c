#pragma once
// How a pane makes its picture, by name and by value.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/frame_loop.h"
#include "postfx/policy.h"

namespace still::inspect {

struct Mode {
    AntiAliasing anti_aliasing = AntiAliasing::taa;
    TaaPolicy policy{};               ///< with AntiAliasing::taa
    int ssaa_samples = 64;            ///< with AntiAliasing::ssaa: 1 … 65536
    Denoise denoise = Denoise::svgf;  ///< not with AntiAliasing::ssaa

    /// Equal pictures: what the way of anti-aliasing does not use is not compared.
    friend bool operator==(const Mode& a, const Mode& b);
};

/// "raw", "fxaa", "ssaa:N", or a preset's name, the latter also with ":denoise=off" behind it;
/// nothing for any other text.
std::optional<Mode> modeNamed(std::string_view name);

/// The name that modeNamed() takes. A policy that is no preset's is "custom".
std::string nameOf(const Mode& mode);

/// raw, fxaa, all presets in their own order, ssaa:64.
std::vector<std::string> modeNames();

}  // namespace still::inspect
