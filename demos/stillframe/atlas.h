#pragma once
// stillframe atlas

#include "demos/stillframe/atlas_options.h"
#include "demos/stillframe/atlas_report.h"
#include "demos/stillframe/file_cache.h"
#include "demos/stillframe/interruption.h"
#include "demos/stillframe/mode.h"

namespace still::command {

/// Measures cases × ways of anti-aliasing on all cores, with a progress bar. References and
/// finished cells are kept in the cache.
Outcome<AtlasReport> measureAtlas(std::vector<const AtlasCase*> cases, std::vector<Mode> modes,
                                  Size resolution, FileCache cache, bool quiet = false);

/// measureAtlas() of the named ones; writes index.html, atlas.json and atlas.csv into the output
/// folder.
Outcome<void> atlas(const AtlasOptions& options, Interruption& interruption);

}  // namespace still::command
