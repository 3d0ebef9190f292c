// nlohmann/json is included here and in report.cpp, and nowhere else among the programs: it is slow
// to compile.

#include "demos/stillframe/atlas_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "demos/stillframe/atlas_summary.h"
#include "demos/stillframe/noise_table.h"
#include "demos/stillframe/page_parts.h"

namespace still::command {
namespace {

using Json = nlohmann::ordered_json;

Json orNull(const std::optional<double>& value) {
    return value ? Json(*value) : Json(nullptr);
}

/// Six figures are plenty for people and for tests of thresholds.
double shortened(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return std::strtod(text, nullptr);
}

Json measuresJson(const SegmentMeasures& m) {
    return {{"psnr", m.psnr},
            {"ssim", m.ssim},
            {"flip", m.flip},
            {"flicker", orNull(m.flicker)},
            {"ghost_area", orNull(m.ghost_area)},
            {"recovery_frames", orNull(m.recovery_frames)},
            {"sharpness", orNull(m.sharpness)},
            {"residual", orNull(m.residual)},
            {"trail", orNull(m.trail)},
            {"ms", m.ms}};
}

Json resultJson(const AtlasResult& result, bool timed) {
    Json json{{"scene", result.scene}, {"segment", result.segment}, {"preset", result.preset}};
    json.update(measuresJson(result.measures));
    if (timed) {
        json["time_share"] = orNull(result.time_share);
    }
    json["frames"] = Json::array();
    for (const FrameError& frame : result.measures.frames) {
        json["frames"].push_back({{"frame", frame.frame},
                                  {"rms", shortened(frame.rms)},
                                  {"ssim", shortened(frame.ssim)},
                                  {"flip", shortened(frame.flip)}});
    }
    return json;
}

Json rowJson(const SummaryRow& row) {
    return {{"segment", row.segment},
            {"preset", row.preset},
            {"cells", row.cells},
            {"psnr_db", shortened(row.psnr_db)},
            {"flip", shortened(row.flip)},
            {"time", orNull(row.time)},
            {"worst_scene", row.worst_scene},
            {"worst_db", shortened(row.worst_db)}};
}

Json rowJson(const NoiseRow& row) {
    Json json{{"scene", row.scene},
              {"segment", row.segment},
              {"preset", row.preset},
              {"ssim", shortened(row.ssim)},
              {"rmse", shortened(row.rmse)},
              {"flicker", orNull(row.flicker)},
              {"residual", orNull(row.residual)},
              {"trail", orNull(row.trail)},
              {"time", orNull(row.time)},
              {"equal_time", nullptr}};
    if (row.equal_time) {
        json["equal_time"] = {{"samples", row.equal_time->samples},
                              {"ssim", shortened(row.equal_time->ssim)},
                              {"rmse", shortened(row.equal_time->rms / 255)},
                              {"own_rmse", shortened(row.equal_time_rms / 255)}};
    }
    return json;
}

template <class Row>
std::string rowsJson(const char* name, const std::vector<Row>& rows) {
    std::string text = std::string(",\n\"") + name + "\": [";
    const char* separator = "\n";
    for (const Row& row : rows) {
        text += separator + rowJson(row).dump();
        separator = ",\n";
    }
    return text + "\n]";
}

/// What stands after the results when there is a base.
std::string summaryJson(const AtlasReport& report) {
    return ",\n\"versus\": " + Json(report.versus).dump() +
           (report.noise ? rowsJson("noise", noiseTableOf(report))
                         : rowsJson("summary", summaryOf(report)));
}

Json caseJson(const AtlasCase& atlas_case) {
    Json json{{"name", atlas_case.name},
              {"failure", atlas_case.failure},
              {"measure", atlas_case.measure}};
    json["event"] = atlas_case.event_frame ? Json(*atlas_case.event_frame) : Json(nullptr);
    return json;
}

/// A result as the page wants it: frames as lists of numbers, and the crop.
Json cellJson(const AtlasResult& result) {
    const SegmentMeasures& m = result.measures;
    Json json{{"scene", result.scene}, {"segment", result.segment}, {"preset", result.preset}};
    const Json measures = measuresJson(m);
    for (const auto& [key, value] : measures.items()) {
        json[key] = value.is_null() ? value : Json(shortened(value.get<double>()));
    }
    for (const char* key : {"number", "rms", "frame_flip"}) {
        json[key] = Json::array();
    }
    for (const FrameError& frame : m.frames) {
        json["number"].push_back(frame.frame);
        json["rms"].push_back(std::round(frame.rms * 100) / 100);
        json["frame_flip"].push_back(std::round(frame.flip * 10000) / 10000);
    }
    json["crop"] = pngDataUri(m.crop_png);
    json["crop_at"] = {m.crop_frame, m.crop_x, m.crop_y};
    return json;
}

/// A number, or nothing.
std::string field(const std::optional<double>& value) {
    char text[40] = "";
    if (value) {
        std::snprintf(text, sizeof text, ",%.10g", *value);
        return text;
    }
    return ",";
}

}  // namespace

const AtlasResult* findBase(const AtlasReport& report, const AtlasResult& cell) {
    const auto found =
        std::find_if(report.results.begin(), report.results.end(), [&](const AtlasResult& each) {
            return each.scene == cell.scene && each.segment == cell.segment &&
                   each.preset == report.versus;
        });
    return found == report.results.end() ? nullptr : &*found;
}

std::string atlasJson(const AtlasReport& report) {
    std::string text = "{\"width\": " + std::to_string(report.width) +
                       ", \"height\": " + std::to_string(report.height) + ", \"results\": [";
    const char* separator = "\n";
    for (const AtlasResult& result : report.results) {
        text += separator + resultJson(result, !report.versus.empty()).dump();
        separator = ",\n";
    }
    return text + "\n]" + (report.versus.empty() ? "" : summaryJson(report)) + "}\n";
}

std::string atlasCsv(const AtlasReport& report) {
    std::string text =
        "scene,segment,preset,psnr,ssim,flip,flicker,ghost_area,recovery_frames,sharpness,"
        "residual,trail,ms\n";
    for (const AtlasResult& result : report.results) {
        const SegmentMeasures& m = result.measures;
        text += result.scene + "," + result.segment + "," + result.preset;
        const std::optional<double> values[] = {
            m.psnr,      m.ssim,     m.flip,  m.flicker, m.ghost_area, m.recovery_frames,
            m.sharpness, m.residual, m.trail, m.ms};
        for (const std::optional<double>& value : values) {
            text += field(value);
        }
        text += "\n";
    }
    return text;
}

std::string atlasPageData(const AtlasReport& report) {
    Json json{{"width", report.width}, {"height", report.height}};
    json["modes"] = report.modes;
    json["cases"] = Json::array();
    for (const AtlasCase* atlas_case : report.cases) {
        json["cases"].push_back(caseJson(*atlas_case));
    }
    json["results"] = Json::array();
    for (const AtlasResult& result : report.results) {
        json["results"].push_back(cellJson(result));
    }
    return scriptText(json.dump());
}

}  // namespace still::command
