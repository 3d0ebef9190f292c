#pragma once
// Prices against errors, drawn: panels of points with their Pareto front. Drawn with cairo, whose
// header stays in plot.cpp.

#include <string>
#include <vector>

#include "demos/stillframe/outcome.h"

namespace still::command {

enum class PointKind { supersampled, spatial, temporal };

struct PlotPoint {
    std::string name;
    PointKind kind = PointKind::temporal;
    double ms = 0;     ///< > 0, drawn on a logarithmic axis
    double value = 0;  ///< of the measure
    bool on_front = false;
};

/// Better is always to the left and up.
struct PlotPanel {
    std::string title;
    std::string measure;  ///< the axis' name
    bool larger_is_better = true;
    std::vector<PlotPoint> points;
};

struct Plot {
    std::string title;
    std::vector<PlotPanel> panels;  ///< two in a row
};

struct PlotFiles {
    std::string svg, png;  ///< whole files
};

Outcome<PlotFiles> drawPlot(const Plot& plot);

}  // namespace still::command
