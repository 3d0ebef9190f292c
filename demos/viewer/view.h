#pragma once
// stillframe view

#include <string>

#include "demos/stillframe/interruption.h"
#include "demos/stillframe/options.h"
#include "demos/stillframe/outcome.h"

namespace still::viewer {

struct ViewOptions {
    std::string scene;  ///< FILE.obj, FILE.json or builtin:NAME
    command::Size resolution{1280, 720};
    std::string anti_aliasing = "taa";
    std::string taa;  ///< comma-separated settings over the preset's
    std::string tone_map = "none";
    std::string lights;  ///< scene file; empty: the scenes' own
    int threads = 0;     ///< 0: all cores
    std::string script;  ///< empty: people
    bool no_cache = false;
    command::Limits limits;
};

/// Opens the window and stays until it is closed, or until the script has ended.
command::Outcome<void> view(const ViewOptions& options, command::Interruption& interruption);

}  // namespace still::viewer
