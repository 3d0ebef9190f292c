#pragma once
// A scene on the page: a session, its picture in a canvas's format, and what the page says about
// it.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "demos/inspect/session.h"
#include "engine/result.h"

namespace still::web {

constexpr int kPlotSide = 160;

class Stage {
  public:
    /// `workers` must outlive the stage. Sizes are 1 … kMaxTargetSize.
    Stage(Scene scene, int width, int height, Workers& workers);

    /// What is to be shown, as the page's steps.json has it: {"left": PANE, "right": PANE, "split":
    /// true, "divider": 0.5, "playing": true, "magnifier": null | {"x":, "y":, "factor":},
    /// "overlays": ["edges", …]} with PANE = {"aa": "taa:basic", "taa": "alpha=0.1", "view":
    /// "picture"}. What is absent stays. The error names the value and what was expected.
    Result<void> configure(const nlohmann::json& wish);

    /// Moves the camera: "orbit" by x and y turns, "dolly" by the factor x, "reset". False for
    /// others.
    bool move(const std::string& kind, double x, double y);
    void scrub(int frame) { session_.scrub(frame); }

    /// The next picture; false when it is the one before.
    bool draw();
    /// RGBA, row by row, without gaps.
    const std::vector<uint8_t>& pixels() const { return pixels_; }
    nlohmann::json report() const;
    /// Remembers the pixel of the canvas; its story is told by story() from now on.
    void pick(int x, int y) { session_.pick(x, y); }
    /// Of the picked pixel: {"pane":, "x":, "y":, "lines": [{"heading":, "text":, "swatch": [r, g,
    /// b]}]}; null when none is picked. Also makes the plot.
    nlohmann::json story();
    /// RGBA, twice kPlotSide wide and kPlotSide high.
    const std::vector<uint8_t>& plot() const { return plot_; }

  private:
    inspect::Session session_;
    std::vector<uint8_t> pixels_, plot_;
};

}  // namespace still::web
