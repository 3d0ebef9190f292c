#pragma once
// Ways of anti-aliasing as people write them, on the command line and in manifests.

#include <string>
#include <string_view>

#include "engine/frame_loop.h"
#include "engine/result.h"

namespace still {

struct AntiAliasingChoice {
    AntiAliasing mode = AntiAliasing::taa;
    int ssaa_samples = 1;
    std::string preset;  ///< with AntiAliasing::taa
    TaaPolicy policy;    ///< the preset's
};

/// "none", "taa" (which is "taa:still"), "taa:PRESET", "fxaa" or "ssaa:N" with N = 1 … 65536. The
/// error says what was expected.
Result<AntiAliasingChoice> parseAntiAliasing(std::string_view text);

/// `policy` with the settings "key=value,key=value" of taaPolicyKeys(); empty text changes nothing.
Result<TaaPolicy> parseTaaSettings(std::string_view text, TaaPolicy policy);

}  // namespace still
