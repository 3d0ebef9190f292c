#include "demos/stillframe/atlas_summary.h"

#include <algorithm>
#include <cmath>

#include "demos/stillframe/formatted.h"

namespace still::command {
namespace {

constexpr const char* kAll = "all";

/// Sums over cells that one row is made of.
class RowSums {
  public:
    void add(const AtlasResult& cell, const AtlasResult& base) {
        const double db = shownDb(cell) - shownDb(base);
        if (cells_ == 0 || db < worst_db_) {
            worst_db_ = db;
            worst_scene_ = cell.scene;
        }
        psnr_db_ += db;
        log_flip_ += std::log(shownFlip(cell) / shownFlip(base));
        ++cells_;
        if (cell.time_share) {
            log_time_ += std::log(*cell.time_share);
            ++timed_;
        }
    }
    SummaryRow row(const std::string& segment, const std::string& preset) const {
        SummaryRow row{.segment = segment,
                       .preset = preset,
                       .cells = cells_,
                       .psnr_db = psnr_db_ / cells_,
                       .flip = std::exp(log_flip_ / cells_),
                       .time = {},
                       .worst_scene = worst_scene_,
                       .worst_db = worst_db_};
        if (timed_ > 0) {
            row.time = std::exp(log_time_ / timed_);
        }
        return row;
    }
    bool empty() const { return cells_ == 0; }

  private:
    static double shownDb(const AtlasResult& cell) {
        return std::min(cell.measures.psnr, kSummaryBestPsnrDb);
    }
    static double shownFlip(const AtlasResult& cell) {
        return std::max(cell.measures.flip, kSummaryBestFlip);
    }

    int cells_ = 0, timed_ = 0;
    double psnr_db_ = 0, log_flip_ = 0, log_time_ = 0, worst_db_ = 0;
    std::string worst_scene_;
};

RowSums sumsOf(const AtlasReport& report, const std::string& segment, const std::string& preset) {
    RowSums sums;
    for (const AtlasResult& cell : report.results) {
        const bool belongs = segment == kAll || cell.segment == segment;
        const AtlasResult* base =
            belongs && cell.preset == preset ? findBase(report, cell) : nullptr;
        if (base != nullptr) {
            sums.add(cell, *base);
        }
    }
    return sums;
}

/// The report's kinds of segments, then all of them together.
std::vector<std::string> segmentsOf(const AtlasReport& report) {
    std::vector<std::string> names;
    for (const AtlasResult& cell : report.results) {
        if (std::find(names.begin(), names.end(), cell.segment) == names.end()) {
            names.push_back(cell.segment);
        }
    }
    names.emplace_back(kAll);
    return names;
}

}  // namespace

std::vector<SummaryRow> summaryOf(const AtlasReport& report) {
    std::vector<SummaryRow> rows;
    if (report.versus.empty()) {
        return rows;
    }
    for (const std::string& segment : segmentsOf(report)) {
        for (const std::string& preset : report.modes) {
            const RowSums sums = sumsOf(report, segment, preset);
            if (!sums.empty()) {
                rows.push_back(sums.row(segment, preset));
            }
        }
    }
    return rows;
}

std::string summaryLines(const std::vector<SummaryRow>& rows, const std::string& base) {
    std::string lines = "against " + base + ", geometric means\n" +
                        formatted("%-8s %-28s %5s %8s %7s %7s  %s\n", "segment", "preset", "cells",
                                  "PSNR dB", "FLIP", "time", "worst PSNR");
    for (const SummaryRow& row : rows) {
        lines += formatted("%-8s %-28s %5d %+8.2f %7.3f ", row.segment.c_str(), row.preset.c_str(),
                           row.cells, row.psnr_db, row.flip) +
                 (row.time ? formatted("%7.3f", *row.time) : std::string(6, ' ') + "–") +
                 formatted("  %+.2f %s\n", row.worst_db, row.worst_scene.c_str());
    }
    return lines;
}

}  // namespace still::command
