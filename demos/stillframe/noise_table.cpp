#include "demos/stillframe/noise_table.h"

#include <algorithm>
#include <cmath>

#include "demos/stillframe/formatted.h"

namespace still::command {
namespace {

/// Over the first `count` frames.
double rmsOver(const std::vector<FrameError>& frames, size_t count) {
    double squares = 0;
    for (size_t i = 0; i < count; ++i) {
        squares += frames[i].rms * frames[i].rms;
    }
    return std::sqrt(squares / double(count));
}

NoiseRow rowOf(const AtlasResult& cell, const AtlasResult& base) {
    const SegmentMeasures& m = cell.measures;
    NoiseRow row{.scene = cell.scene,
                 .segment = cell.segment,
                 .preset = cell.preset,
                 .ssim = m.frames.front().ssim,
                 .rmse = 0,
                 .flicker = {},
                 .residual = m.residual,
                 .trail = m.trail,
                 .time = cell.time_share,
                 .equal_time = cell.equal_time,
                 .equal_time_rms = 0};
    for (const FrameError& frame : m.frames) {
        row.ssim = std::min(row.ssim, frame.ssim);
        row.rmse = std::max(row.rmse, frame.rms / 255);
    }
    if (m.flicker && base.measures.flicker && *base.measures.flicker > 0) {
        row.flicker = *m.flicker / *base.measures.flicker;
    }
    if (cell.equal_time) {
        row.equal_time_rms = rmsOver(m.frames, size_t(cell.equal_time->frames));
    }
    return row;
}

std::string cellText(const char* format, const std::optional<double>& value) {
    return value ? formatted(format, *value) : "       –";
}

}  // namespace

std::vector<NoiseRow> noiseTableOf(const AtlasReport& report) {
    std::vector<NoiseRow> rows;
    for (const AtlasResult& cell : report.results) {
        const AtlasResult* base = findBase(report, cell);
        if (base != nullptr && base != &cell) {
            rows.push_back(rowOf(cell, *base));
        }
    }
    return rows;
}

std::string noiseLines(const std::vector<NoiseRow>& rows) {
    std::string lines = formatted("%-14s %-8s %-20s %7s %7s %8s %8s %8s %8s %8s %8s %8s %8s\n",
                                  "scene", "segment", "preset", "SSIM", "RMSE", "flicker",
                                  "residual", "trail", "time", "samples", "SSIM", "RMSE", "own");
    for (const NoiseRow& row : rows) {
        lines += formatted("%-14s %-8s %-20s %7.4f %7.4f ", row.scene.c_str(), row.segment.c_str(),
                           row.preset.c_str(), row.ssim, row.rmse) +
                 cellText("%8.3f", row.flicker) + " " + cellText("%8.4f", row.residual) + " " +
                 cellText("%8.1f", row.trail) + " " + cellText("%8.2f", row.time);
        if (row.equal_time) {
            const bool beaten = row.equal_time_rms < row.equal_time->rms;
            lines += formatted(" %8d %8.4f %8.4f %8.4f %s", row.equal_time->samples,
                               row.equal_time->ssim, row.equal_time->rms / 255,
                               row.equal_time_rms / 255, beaten ? "beaten" : "better");
        }
        lines += "\n";
    }
    return lines +
           "SSIM and RMSE: of the worst frame. Flicker and time: 1 is that of one sample a pixel.\n"
           "Samples: what the time buys, their SSIM and RMSE, and the preset's own RMSE over the "
           "same frames.\n";
}

}  // namespace still::command
