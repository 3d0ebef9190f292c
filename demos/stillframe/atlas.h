#pragma once
// stillframe atlas

#include "demos/stillframe/atlas_options.h"
#include "demos/stillframe/atlas_report.h"
#include "demos/stillframe/file_cache.h"
#include "demos/stillframe/interruption.h"
#include "demos/stillframe/mode.h"

namespace still::command {

struct AtlasPlan {
    std::vector<const AtlasCase*> cases{};
    std::vector<Mode> modes{};
    std::optional<size_t> versus{};  ///< the mode that the others are held against
    Size resolution{320, 180};
    Size time_resolution{320, 180};
    int samples = kMaxSamples;  ///< at most so many of a reference
    bool noise = false;         ///< the suite of noise: what time buys is measured, too
    bool quiet = false;

    static constexpr int kMaxSamples = 65536;
};

/// Measures cases × ways of anti-aliasing on all cores, with a progress bar. References and
/// finished cells are kept in the cache.
Outcome<AtlasReport> measureAtlas(AtlasPlan plan, FileCache cache);

/// measureAtlas() of the named ones; writes index.html, atlas.json and atlas.csv into the output
/// folder, and prints the summary when one is asked for.
Outcome<void> atlas(const AtlasOptions& options, Interruption& interruption);

}  // namespace still::command
