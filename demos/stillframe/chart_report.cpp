#include "demos/stillframe/chart_report.h"

#include <cstdio>

namespace still::command {
namespace {

/// All numbers are finite and all names plain, so that they stand in JSON as they are.
std::string number(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.10g", value);
    return text;
}

const char* word(bool value) {
    return value ? "true" : "false";
}

PointKind kindOf(const std::string& preset) {
    if (preset == "raw" || preset.starts_with("ssaa:")) {
        return PointKind::supersampled;
    }
    return preset == "fxaa" ? PointKind::spatial : PointKind::temporal;
}

PlotPanel panelOf(const ChartReport& report, const std::string& scene, int threads,
                  const std::string& segment, bool psnr) {
    PlotPanel panel{.title = segment == "still" ? "still camera and scene" : "moving",
                    .measure = psnr ? "PSNR, dB" : "FLIP",
                    .larger_is_better = psnr,
                    .points = {}};
    for (const ChartPoint& point : report.points) {
        if (point.scene == scene && point.threads == threads && point.segment == segment) {
            panel.points.push_back({point.preset, kindOf(point.preset), point.ms,
                                    psnr ? point.psnr : point.flip,
                                    psnr ? point.psnr_front : point.flip_front});
        }
    }
    return panel;
}

}  // namespace

std::string chartJson(const ChartReport& report) {
    std::string text = "{\n \"width\": " + std::to_string(report.width) +
                       ",\n \"height\": " + std::to_string(report.height) +
                       ",\n \"frames\": " + std::to_string(report.frames) + ",\n \"results\": [";
    const char* separator = "\n  ";
    for (const ChartPoint& point : report.points) {
        text += separator;
        text += "{\"scene\": \"" + point.scene + "\", \"segment\": \"" + point.segment +
                "\", \"threads\": " + std::to_string(point.threads) + ", \"preset\": \"" +
                point.preset + "\", \"ms\": " + number(point.ms) +
                ", \"psnr\": " + number(point.psnr) + ", \"flip\": " + number(point.flip) +
                ", \"psnr_front\": " + word(point.psnr_front) +
                ", \"flip_front\": " + word(point.flip_front) + "}";
        separator = ",\n  ";
    }
    return text + "\n ]\n}\n";
}

std::string chartCsv(const ChartReport& report) {
    std::string text = "scene,segment,threads,preset,ms,psnr,flip,psnr_front,flip_front\n";
    for (const ChartPoint& point : report.points) {
        text += point.scene + "," + point.segment + "," + std::to_string(point.threads) + "," +
                point.preset + "," + number(point.ms) + "," + number(point.psnr) + "," +
                number(point.flip) + "," + word(point.psnr_front) + "," + word(point.flip_front) +
                "\n";
    }
    return text;
}

Plot chartPlot(const ChartReport& report, const std::string& scene, int threads) {
    Plot plot{.title = scene + ", " + std::to_string(report.width) + "×" +
                       std::to_string(report.height) + ", " + std::to_string(threads) +
                       (threads == 1 ? " thread" : " threads"),
              .panels = {}};
    for (bool psnr : {true, false}) {
        for (const char* segment : {"moving", "still"}) {
            plot.panels.push_back(panelOf(report, scene, threads, segment, psnr));
        }
    }
    return plot;
}

}  // namespace still::command
