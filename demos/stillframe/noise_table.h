#pragma once
// What is left of noise: the suite of noisy cases in one table.

#include <optional>
#include <string>
#include <vector>

#include "demos/stillframe/atlas_report.h"

namespace still::command {

/// One mode over one segment, beside the base, which shows the noise as it is.
struct NoiseRow {
    std::string scene, segment, preset;
    double ssim = 0;                 ///< of the worst frame
    double rmse = 0;                 ///< of the worst frame; 1 = black to white
    std::optional<double> flicker;   ///< as a share of the base's
    std::optional<double> residual;  ///< see SegmentMeasures
    std::optional<double> trail;     ///< codes
    std::optional<double> time;      ///< in units of the base's
    std::optional<EqualTime> equal_time;
    double equal_time_rms = 0;  ///< the mode's own over the frames of `equal_time`, codes
};

/// By case, segment and mode; the base has none. Empty without a base.
std::vector<NoiseRow> noiseTableOf(const AtlasReport& report);

/// A table for people.
std::string noiseLines(const std::vector<NoiseRow>& rows);

}  // namespace still::command
