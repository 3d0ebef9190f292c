#pragma once
// What the atlas found, as text for programs.

#include <string>
#include <vector>

#include "demos/stillframe/cell.h"
#include "demos/stillframe/equal_time.h"

namespace still::command {

/// One cell: a row of the results.
struct AtlasResult {
    std::string scene, segment, preset;
    SegmentMeasures measures;
    /// Of the base's processor time for the same frames, see race.h; nothing when it was not
    /// measured.
    std::optional<double> time_share{};
    std::optional<EqualTime> equal_time{};  ///< in the suite of noise
};

struct AtlasReport {
    int width = 0, height = 0;
    std::vector<const AtlasCase*> cases;
    std::vector<std::string> modes;
    std::vector<AtlasResult> results;  ///< by case, segment, mode
    bool noise = false;                ///< the suite of noise, which has its own table
    std::string versus;                ///< the mode that is the base of a summary; empty: none
};

/// The base's result for the same frames; null without a base.
const AtlasResult* findBase(const AtlasReport& report, const AtlasResult& cell);

/// {"width", "height", "results": [{"scene", "segment", "preset", "psnr", "ssim", "flip",
/// "flicker", "ghost_area", "recovery_frames", "sharpness", "residual", "trail", "ms", "frames":
/// [{"frame", "rms", "flip"} …]} …]}, one result a line; null where a measure does not apply. With
/// a base, results have "time_share" too, and at the end "versus" and "summary": [{"segment",
/// "preset", "cells", "psnr_db", "flip", "time", "worst_scene", "worst_db"} …] stand.
std::string atlasJson(const AtlasReport& report);

/// The same without frames; an empty field is null.
std::string atlasCsv(const AtlasReport& report);

/// The page's data: the results, cases with their texts, and crops as data URIs, safe inside a
/// script element.
std::string atlasPageData(const AtlasReport& report);

}  // namespace still::command
