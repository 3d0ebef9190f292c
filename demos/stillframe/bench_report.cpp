#include "demos/stillframe/bench_report.h"

#include "demos/stillframe/formatted.h"
#include "demos/stillframe/json_report.h"
#include "engine/hash.h"

namespace still::command {
namespace {

struct LimitColumn {
    const char* name;
    double MachineLimits::*value;
    const char* label;
};
constexpr LimitColumn kLimits[] = {
    {"copy_gb_s", &MachineLimits::copy, "memory copy"},
    {"stream_gb_s", &MachineLimits::stream, "with streaming stores"},
    {"l3_copy_gb_s", &MachineLimits::l3_copy, "L3 copy"},
    {"l2_copy_gb_s", &MachineLimits::l2_copy, "L2 copy"},
    {"mul_high_g_s", &MachineLimits::mul_high, "16-bit multiply-high"},
    {"add_g_s", &MachineLimits::add, "16-bit add"},
    {"divide_g_s", &MachineLimits::divide, "float divide"},
    {"gather_g_s", &MachineLimits::gather, "gathered texels"},
};

struct CounterColumn {
    const char* name;
    uint64_t RasterCounters::*value;
};
constexpr CounterColumn kCounters[] = {
    {"triangles", &RasterCounters::triangles},
    {"clipped", &RasterCounters::clipped},
    {"binned", &RasterCounters::binned},
    {"tile_refs", &RasterCounters::tile_refs},
    {"tiles", &RasterCounters::tiles},
    {"tiles_empty", &RasterCounters::tiles_empty},
    {"blocks_hidden", &RasterCounters::blocks_hidden},
    {"blocks_outside", &RasterCounters::blocks_outside},
    {"pixels_shaded", &RasterCounters::pixels_shaded},
};

std::vector<double> timesOf(const BenchResult& result, double StageTimes::*stage) {
    std::vector<double> times_ms;
    for (const BenchResult::Frame& frame : result.frames) {
        times_ms.push_back(frame.times.*stage);
    }
    return times_ms;
}

std::vector<double> totalsOf(const BenchResult& result) {
    std::vector<double> times_ms;
    for (const BenchResult::Frame& frame : result.frames) {
        times_ms.push_back(frame.total_ms);
    }
    return times_ms;
}

const MachineLimits& limitsOf(const BenchReport& report, int threads) {
    for (const MachineLimits& limits : report.machine) {
        if (limits.threads == threads) {
            return limits;
        }
    }
    return report.machine.back();
}

double gbPerSecond(double bytes, double time_ms) {
    return time_ms > 0 ? bytes / time_ms * 1e-6 : 0.0;
}

Json stagesJson(const BenchResult& result) {
    Json json;
    for (const StageColumn& stage : kStageColumns) {
        json[stage.name] = statisticsJson(timesOf(result, stage.time_ms));
    }
    return json;
}

Json trafficJson(const BenchResult& result, const MachineLimits& limits) {
    Json json;
    for (size_t i = 0; i < kStageColumns.size(); ++i) {
        const double median_ms = statisticsOf(timesOf(result, kStageColumns[i].time_ms)).median;
        const double rate = gbPerSecond(result.bytes[i], median_ms);
        json[kStageColumns[i].name] = {{"bytes", uint64_t(result.bytes[i])},
                                       {"gb_s", rate},
                                       {"share_of_copy", rate / limits.copy}};
    }
    return json;
}

Json countersJson(const BenchResult& result) {
    Json json;
    for (const CounterColumn& counter : kCounters) {
        json[counter.name] = result.counters.*counter.value;
    }
    json["tiles_skipped"] = result.tiles_skipped;
    json["history_taps"] = result.history_taps;
    return json;
}

Json scalingJson(const Scaling& scaling) {
    Json json{{"work_ms", scaling.work_ms},
              {"span_ms", scaling.span_ms},
              {"serial_ms", scaling.serial_ms},
              {"simulated", Json::array()}};
    for (const auto& [workers, time_ms] : scaling.simulated_ms) {
        json["simulated"].push_back(
            {{"workers", workers}, {"ms", time_ms}, {"speedup", scaling.work_ms / time_ms}});
    }
    return json;
}

Json resultJson(const BenchResult& result, const MachineLimits& limits) {
    Json json;
    json["scene"] = result.scene;
    json["motion"] = result.motion;
    json["triangles"] = result.triangles;
    json["width"] = result.settings.width;
    json["height"] = result.settings.height;
    json["frames"] = result.frames.size();
    json["threads"] = result.threads;
    json["simd"] = name(result.settings.simd);
    json["anti_aliasing"] = "taa";
    json["preset"] = "still";
    json["stages"] = stagesJson(result);
    json["total"] = statisticsJson(totalsOf(result));
    if (result.peak_bytes > 0) {
        json["peak_rss_bytes"] = result.peak_bytes;
    }
    json["counters"] = countersJson(result);
    json["traffic"] = trafficJson(result, limits);
    if (result.scaling) {
        json["scaling"] = scalingJson(*result.scaling);
    }
    json["hashes"] = Json::array();
    for (const BenchResult::Frame& frame : result.frames) {
        json["hashes"].push_back({{"frame", frame.frame}, {"output", hex(frame.hash)}});
    }
    return json;
}

std::string timesLine(const char* name, const std::vector<double>& times_ms) {
    const Statistics s = statisticsOf(times_ms);
    return formatted("  %-11s %9.3f %9.3f %9.3f", name, s.min, s.median, s.p95);
}

bool isOfLight(const StageColumn& stage) {
    return stage.time_ms == &StageTimes::light_ms || stage.time_ms == &StageTimes::denoise_ms;
}

/// Stages of sampled light stand where there is some.
std::string stageLines(const BenchResult& result, const MachineLimits& limits) {
    std::string lines = formatted("  %-11s %9s %9s %9s %9s %8s %8s\n", "ms", "min", "median", "p95",
                                  "MB", "GB/s", "of copy");
    for (size_t i = 0; i < kStageColumns.size(); ++i) {
        const std::vector<double> times_ms = timesOf(result, kStageColumns[i].time_ms);
        if (isOfLight(kStageColumns[i]) && statisticsOf(times_ms).p95 == 0) {
            continue;
        }
        lines += timesLine(kStageColumns[i].name, times_ms);
        const double rate = gbPerSecond(result.bytes[i], statisticsOf(times_ms).median);
        if (rate > 0) {
            lines += formatted(" %9.2f %8.2f %6.0f %%", result.bytes[i] * 1e-6, rate,
                               100 * rate / limits.copy);
        }
        lines += "\n";
    }
    return lines + timesLine("frame", totalsOf(result)) + "\n";
}

std::string counterLines(const BenchResult& result) {
    std::string line = " ";
    for (const CounterColumn& counter : kCounters) {
        line += formatted(" %s %llu", counter.name,
                          static_cast<unsigned long long>(result.counters.*counter.value));
    }
    return line + formatted(" tiles_skipped %llu history_taps %llu\n",
                            static_cast<unsigned long long>(result.tiles_skipped),
                            static_cast<unsigned long long>(result.history_taps));
}

std::string scalingLine(const Scaling& scaling) {
    std::string line = formatted(
        "  work %.2f ms, span %.2f ms, serial %.2f ms (%.1f %%); simulated", scaling.work_ms,
        scaling.span_ms, scaling.serial_ms, 100 * scaling.serial_ms / scaling.work_ms);
    for (const auto& [workers, time_ms] : scaling.simulated_ms) {
        line += formatted(" %d: %.2fx", workers, scaling.work_ms / time_ms);
    }
    return line + "\n";
}

/// How much faster than with one thread, where that was measured, too.
std::string speedupOf(const BenchReport& report, const BenchResult& result) {
    for (const BenchResult& other : report.results) {
        if (result.threads > 1 && other.threads == 1 && other.scene == result.scene &&
            other.motion == result.motion) {
            return formatted(", %.2fx one thread", statisticsOf(totalsOf(other)).median /
                                                       statisticsOf(totalsOf(result)).median);
        }
    }
    return {};
}

std::string resultLines(const BenchReport& report, const BenchResult& result) {
    std::string lines =
        result.scene + ", " + result.motion + ": " +
        formatted("%llu triangles, %dx%d, %d thread%s, ",
                  static_cast<unsigned long long>(result.triangles), result.settings.width,
                  result.settings.height, result.threads, result.threads == 1 ? "" : "s") +
        std::string(name(result.settings.simd)) + ", " +
        formatted("%zu frames", result.frames.size()) + speedupOf(report, result) + "\n";
    lines += stageLines(result, limitsOf(report, result.threads)) + counterLines(result);
    if (result.scaling) {
        lines += scalingLine(*result.scaling);
    }
    if (result.peak_bytes > 0) {
        lines += formatted("  peak memory %.0f MB\n", double(result.peak_bytes) * 1e-6);
    }
    const BenchResult::Frame& last = result.frames.back();
    return lines + "  frame " + std::to_string(last.frame) + " output " + hex(last.hash) + "\n\n";
}

std::string machineLines(const BenchReport& report) {
    std::string lines = formatted("%-24s", "machine, 10^9/s; threads");
    for (const MachineLimits& limits : report.machine) {
        lines += formatted(" %8d", limits.threads);
    }
    lines += "\n";
    for (const LimitColumn& column : kLimits) {
        lines += formatted("  %-22s", column.label);
        for (const MachineLimits& limits : report.machine) {
            lines += formatted(" %8.1f", limits.*column.value);
        }
        lines += "\n";
    }
    return lines;
}

}  // namespace

std::string benchJson(const BenchReport& report) {
    Json json;
    json["results"] = Json::array();
    for (const BenchResult& result : report.results) {
        json["results"].push_back(resultJson(result, limitsOf(report, result.threads)));
    }
    json["machine"] = Json::array();
    for (const MachineLimits& limits : report.machine) {
        Json entry{{"threads", limits.threads}};
        for (const LimitColumn& column : kLimits) {
            entry[column.name] = limits.*column.value;
        }
        json["machine"].push_back(entry);
    }
    return text(json);
}

std::string benchLines(const BenchReport& report) {
    std::string lines;
    for (const BenchResult& result : report.results) {
        lines += resultLines(report, result);
    }
    return lines + machineLines(report);
}

}  // namespace still::command
