#pragma once
// A way to make a frame: a column of the atlas, a point of the chart.

#include <string>
#include <vector>

#include "demos/stillframe/outcome.h"
#include "engine/frame_loop.h"
#include "postfx/policy.h"

namespace still::command {

struct Mode {
    std::string name;  ///< as parseModes() takes it
    AntiAliasing anti_aliasing = AntiAliasing::none;
    int ssaa_samples = 1;
    TaaPolicy policy{};  ///< with AntiAliasing::taa
    Denoise denoise = Denoise::svgf;

    bool temporal() const { return anti_aliasing == AntiAliasing::taa; }
    /// `view` with this way of anti-aliasing.
    FrameSettings settings(const FrameSettings& view) const;
};

/// raw, fxaa, then all presets in their own order.
std::vector<Mode> allModes();

/// Names with commas: raw, fxaa, ssaa:N, or a preset. A name may be followed by settings, each
/// after a colon: those of --taa for presets ("bicubic:ratio=2"), and denoise=off for all
/// ("raw:denoise= off"). Empty text means allModes(). Errors begin with `option`.
Outcome<std::vector<Mode>> parseModes(const std::string& text, const std::string& option);

/// Parts between commas; none in empty text.
std::vector<std::string> splitAtCommas(const std::string& text);

}  // namespace still::command
