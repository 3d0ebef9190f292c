#pragma once
// All cells of the atlas in a few numbers: every way of anti-aliasing held against one of them.

#include <optional>
#include <string>
#include <vector>

#include "demos/stillframe/atlas_report.h"

namespace still::command {

/// One way of anti-aliasing over the cells of one kind of segment, against the base's cells.
struct SummaryRow {
    std::string segment;  ///< "still", "moving" …, or "all"
    std::string preset;
    int cells = 0;
    double psnr_db = 0;          ///< mean of the differences: 10 log10 of a geometric mean
    double flip = 1;             ///< geometric mean of the ratios
    std::optional<double> time;  ///< the same; nothing when no cell was timed
    std::string worst_scene;     ///< where the difference of PSNR is lowest
    double worst_db = 0;
};

/// Errors below these are equal: nobody sees them.
constexpr double kSummaryBestPsnrDb = 60;  ///< a quarter of a code
constexpr double kSummaryBestFlip = 0.001;

/// By segment in the order of the report, "all" last, then by mode. Empty without a base.
std::vector<SummaryRow> summaryOf(const AtlasReport& report);

/// A table for people.
std::string summaryLines(const std::vector<SummaryRow>& rows, const std::string& base);

}  // namespace still::command
