#pragma once
// stillframe atlas

#include "demos/stillframe/atlas_options.h"
#include "demos/stillframe/interruption.h"

namespace still::command {

/// Measures cases × ways of anti-aliasing and writes index.html, atlas.json and atlas.csv into the
/// output folder. References and finished cells are kept in the cache.
Outcome<void> atlas(const AtlasOptions& options, Interruption& interruption);

}  // namespace still::command
