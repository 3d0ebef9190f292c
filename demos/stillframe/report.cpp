#include "demos/stillframe/report.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "demos/stillframe/formatted.h"
#include "demos/stillframe/json_report.h"
#include "demos/stillframe/peak_memory.h"

namespace still::command {
namespace {

template <class Time>
Json statistics(const std::vector<RenderReport::Frame>& frames, Time&& time_of) {
    std::vector<double> times_ms;
    for (const RenderReport::Frame& frame : frames) {
        times_ms.push_back(time_of(frame));
    }
    return statisticsJson(times_ms);
}

Json stageStatistics(const std::vector<RenderReport::Frame>& frames, double StageTimes::*stage) {
    return statistics(frames,
                      [stage](const RenderReport::Frame& frame) { return frame.times.*stage; });
}

Json hashJson(const RenderReport::Frame& frame) {
    const FrameHashes& h = frame.hashes;
    return {{"frame", frame.frame},  {"output", hex(h.output)}, {"color", hex(h.color)},
            {"depth", hex(h.depth)}, {"normal", hex(h.normal)}, {"motion", hex(h.motion)},
            {"id", hex(h.id)}};
}

Json errorJson(const PixelError& error, double ssim) {
    Json json;
    json["psnr"] = error.identical() ? Json(nullptr) : Json(psnrDb(error));
    json["ssim"] = ssim;
    json["max_difference"] = error.max_difference;
    json["identical"] = error.identical();
    return json;
}

Json pixelJson(Rgb8 c) {
    return {c.r, c.g, c.b};
}

Json differencesJson(const std::vector<Difference>& differences) {
    Json json = Json::array();
    for (const Difference& d : differences) {
        json.push_back({{"frame", d.frame},
                        {"x", d.x},
                        {"y", d.y},
                        {"a", pixelJson(d.a)},
                        {"b", pixelJson(d.b)}});
    }
    return json;
}

std::string entryLine(std::string_view name, std::string_view what) {
    constexpr size_t kColumn = 17;
    std::string line = "  " + std::string(name);
    line.append(std::max(line.size(), kColumn) + 1 - line.size(), ' ');
    return line + std::string(what) + "\n";
}

std::string errorLine(const PixelError& error, double ssim) {
    if (error.identical()) {
        return "identical\n";
    }
    return formatted("psnr %.3f dB  ssim %.6f  max difference %d\n", psnrDb(error), ssim,
                     error.max_difference);
}

Json jsonOf(const CompareReport& report) {
    Json json = errorJson(report.error(), report.ssim());
    if (report.numbered) {
        json["frames"] = Json::array();
        for (const CompareReport::Frame& frame : report.frames) {
            Json entry{{"frame", frame.frame}};
            entry.update(errorJson(frame.error, frame.ssim));
            json["frames"].push_back(entry);
        }
    }
    if (report.with_differences) {
        json["first_differences"] = differencesJson(report.differences);
    }
    return json;
}

Json jsonOf(const RenderReport& report) {
    const auto& frames = report.frames;
    Json json;
    json["scene"] = report.scene;
    json["triangles"] = report.triangles;
    json["width"] = report.width;
    json["height"] = report.height;
    json["frames"] = frames.size();
    json["threads"] = report.threads;
    json["simd"] = name(report.simd);
    json["anti_aliasing"] = report.anti_aliasing;
    if (!report.preset.empty()) {
        json["preset"] = report.preset;
        json["taa"] = report.taa;
    }
    json["stages"] = {{"transform_bin", stageStatistics(frames, &StageTimes::transform_bin_ms)},
                      {"raster", stageStatistics(frames, &StageTimes::raster_ms)},
                      {"light", stageStatistics(frames, &StageTimes::light_ms)},
                      {"denoise", stageStatistics(frames, &StageTimes::denoise_ms)},
                      {"taa", stageStatistics(frames, &StageTimes::taa_ms)},
                      {"output", stageStatistics(frames, &StageTimes::output_ms)}};
    json["total"] =
        statistics(frames, [](const RenderReport::Frame& frame) { return frame.total_ms; });
    json["peak_rss_bytes"] = peakMemoryBytes();
    if (report.with_hashes) {
        json["hashes"] = Json::array();
        for (const RenderReport::Frame& frame : frames) {
            json["hashes"].push_back(hashJson(frame));
        }
    }
    if (report.reference) {
        json["reference"] = jsonOf(*report.reference);
    }
    return json;
}

/// Texts of the reports, with a heading each when there are several.
template <class Lines>
std::string underHeadings(const std::vector<RenderReport>& reports, Lines&& linesOf) {
    std::string all;
    for (const RenderReport& report : reports) {
        all += reports.size() > 1 ? "scene " + report.scene + "\n" : "";
        all += linesOf(report);
    }
    return all;
}

}  // namespace

std::string renderJson(const std::vector<RenderReport>& reports) {
    if (reports.size() == 1) {
        return text(jsonOf(reports[0]));
    }
    Json json;
    json["results"] = Json::array();
    for (const RenderReport& report : reports) {
        json["results"].push_back(jsonOf(report));
    }
    return text(json);
}

std::string hashLines(const std::vector<RenderReport>& reports) {
    return underHeadings(reports, [](const RenderReport& report) {
        std::string lines;
        for (const RenderReport::Frame& frame : report.frames) {
            const FrameHashes& h = frame.hashes;
            lines += "frame " + std::to_string(frame.frame) + " output " + hex(h.output) +
                     " color " + hex(h.color) + " depth " + hex(h.depth) + " normal " +
                     hex(h.normal) + " motion " + hex(h.motion) + " id " + hex(h.id) + "\n";
        }
        return lines;
    });
}

std::string referenceLines(const std::vector<RenderReport>& reports) {
    return underHeadings(
        reports, [](const RenderReport& report) { return compareLines(*report.reference); });
}

PixelError CompareReport::error() const {
    PixelError sum;
    for (const Frame& frame : frames) {
        sum += frame.error;
    }
    return sum;
}

double CompareReport::ssim() const {
    double sum = 0;
    for (const Frame& frame : frames) {
        sum += frame.ssim;
    }
    return sum / double(frames.size());
}

std::string compareJson(const CompareReport& report) {
    return text(jsonOf(report));
}

std::string compareLines(const CompareReport& report) {
    std::string lines;
    for (const CompareReport::Frame& frame : report.frames) {
        if (report.numbered) {
            lines += formatted("frame %d  ", frame.frame) + errorLine(frame.error, frame.ssim);
        }
    }
    lines += (report.numbered ? "all  " : "") + errorLine(report.error(), report.ssim());
    for (const Difference& d : report.differences) {
        lines += report.numbered ? formatted("frame %d  ", d.frame) : "";
        lines += formatted("x %d y %d: %d %d %d, %d %d %d\n", d.x, d.y, d.a.r, d.a.g, d.a.b, d.b.r,
                           d.b.g, d.b.b);
    }
    return lines;
}

std::string presetsJson() {
    Json json;
    json["presets"] = Json::array();
    for (const TaaPreset& preset : taaPresets()) {
        json["presets"].push_back({{"name", preset.name}, {"about", preset.about}});
    }
    json["settings"] = Json::array();
    for (const TaaPolicyKey& key : taaPolicyKeys()) {
        json["settings"].push_back({{"name", key.name}, {"values", key.values}});
    }
    return text(json);
}

std::string presetsLines() {
    std::string lines = "Presets, for --anti-aliasing taa:PRESET\n";
    for (const TaaPreset& preset : taaPresets()) {
        lines += entryLine(preset.name, preset.about);
    }
    return lines + "\nSettings, for --taa KEY=VALUE,KEY=VALUE,...\n" + taaSettingsLines();
}

std::string taaSettingsLines() {
    constexpr size_t kWidth = 58;
    std::string lines;
    for (const TaaPolicyKey& key : taaPolicyKeys()) {
        std::string_view name = key.name, values = key.values;
        while (values.size() > kWidth) {
            const size_t end = values.rfind('|', kWidth) + 1;
            lines += entryLine(name, values.substr(0, end));
            name = {};
            values.remove_prefix(end);
        }
        lines += entryLine(name, values);
    }
    return lines;
}

void printFailure(const Failure& failure) {
    std::string line = failure.message;
    std::replace_if(
        line.begin(), line.end(), [](unsigned char c) { return c < 32; }, '?');
    std::fprintf(stderr, "stillframe: %s\n", line.c_str());
}

Outcome<void> print(const std::string& text) {
    const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
    if (!written || std::fflush(stdout) != 0) {
        return fileError(std::string("standard output: cannot write: ") + std::strerror(errno));
    }
    return {};
}

}  // namespace still::command
