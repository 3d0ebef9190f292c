#pragma once
// What the chart found, as text for programs and as plots for people.

#include <string>
#include <vector>

#include "demos/stillframe/chart_run.h"
#include "demos/stillframe/plot.h"

namespace still::command {

struct ChartReport {
    int width = 0, height = 0, frames = 0;
    std::vector<ChartPoint> points;
};

/// {"width", "height", "frames", "results": [{"scene", "segment", "threads", "preset", "ms",
/// "psnr", "flip", "psnr_front", "flip_front"} …]}; the last two say whether the point lies on the
/// Pareto front of its measure.
std::string chartJson(const ChartReport& report);
std::string chartCsv(const ChartReport& report);

/// Both measures of both segments of one scene with one number of threads.
Plot chartPlot(const ChartReport& report, const std::string& scene, int threads);

}  // namespace still::command
