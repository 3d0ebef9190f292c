#pragma once
// stillframe info: what a scene holds, and which code it makes run.

#include <string>

#include "demos/stillframe/limits.h"
#include "demos/stillframe/outcome.h"

namespace still::command {

struct InfoOptions {
    std::string scene;  ///< FILE.obj, FILE.json, builtin:NAME or -
    bool json = false;
    bool quiet = false;
    bool no_cache = false;
    Limits limits;
};

/// Loads the scene and prints.
Outcome<void> info(const InfoOptions& options);

}  // namespace still::command
