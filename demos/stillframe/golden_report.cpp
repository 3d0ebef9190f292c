#include "demos/stillframe/golden_report.h"

#include <algorithm>

#include "demos/stillframe/golden_page.h"
#include "demos/stillframe/json_report.h"
#include "demos/stillframe/page_parts.h"

namespace still::command {
namespace {

using golden::CaseVerdict;
using golden::Finding;

const char* wordOf(Recorded what) {
    constexpr const char* kWords[] = {"made", "changed", "unchanged"};
    return kWords[int(what)];
}

const char* wordOf(Finding finding) {
    constexpr const char* kWords[] = {"equal", "differs", "no_golden", "error"};
    return kWords[int(finding)];
}

Json firstJson(const golden::FrameDifference& first) {
    Json json{{"frame", first.frame}, {"stage", name(first.stages.stage)}};
    if (!first.stages.tiles.empty()) {
        const auto tile = golden::tileRectangle(first, first.stages.tiles.front());
        json["tile"] = {tile.tile_x, tile.tile_y};
        json["rectangle"] = {tile.x, tile.y, tile.width, tile.height};
    } else {
        json["tile"] = json["rectangle"] = nullptr;
    }
    json["tiles"] = first.stages.tiles.size();
    json["first_pixel"] = first.first_x >= 0 ? Json{first.first_x, first.first_y} : Json(nullptr);
    json["pixels"] = first.pixels ? Json(*first.pixels) : Json(nullptr);
    json["psnr"] = first.first_x >= 0 ? Json(first.psnr_db) : Json(nullptr);
    return json;
}

Json caseJson(const CaseVerdict& verdict) {
    Json json{{"name", verdict.name}, {"result", wordOf(verdict.finding)}};
    json["message"] = verdict.message.empty() ? Json(nullptr) : Json(verdict.message);
    json["frames"] = verdict.frames;
    json["differing_frames"] = verdict.differing;
    if (verdict.first) {
        json.update(firstJson(*verdict.first));
    }
    return json;
}

/// A case as the page wants it.
Json pageJson(const VerifiedCase& verified) {
    Json json = caseJson(verified.verdict);
    if (const auto& first = verified.verdict.first) {
        json["width"] = first->width;
        json["height"] = first->height;
        json["rectangles"] = Json::array();
        for (const int tile : first->stages.tiles) {
            const auto r = golden::tileRectangle(*first, tile);
            json["rectangles"].push_back({r.x, r.y, r.width, r.height});
        }
    }
    json["pictures"] = Json::object();
    const auto add = [&](const char* key, const std::string& png) {
        if (!png.empty()) {
            json["pictures"][key] = pngDataUri(png);
        }
    };
    add("expected", verified.expected_png);
    add("actual", verified.actual_png);
    add("diff", verified.diff_png);
    return json;
}

Json orNull(const std::string& text) {
    return text.empty() ? Json(nullptr) : Json(text);
}

}  // namespace

std::string recordLines(const RecordReport& report) {
    std::string text;
    for (const RecordedCase& recorded : report.cases) {
        text += recorded.name + ": " + wordOf(recorded.what) + ", " +
                std::to_string(recorded.frames) + (recorded.frames == 1 ? " frame\n" : " frames\n");
    }
    for (const std::string& name : report.removed) {
        text += name + ": removed\n";
    }
    return text;
}

std::string recordJson(const RecordReport& report) {
    Json json{{"cases", Json::array()}, {"removed", report.removed}};
    for (const RecordedCase& recorded : report.cases) {
        json["cases"].push_back({{"name", recorded.name},
                                 {"frames", recorded.frames},
                                 {"result", wordOf(recorded.what)}});
    }
    return text(json);
}

int VerifyReport::count(Finding finding) const {
    return int(std::count_if(cases.begin(), cases.end(), [&](const VerifiedCase& verified) {
        return verified.verdict.finding == finding;
    }));
}

bool VerifyReport::ok() const {
    return count(Finding::equal) == int(cases.size());
}

std::string verifyLines(const VerifyReport& report) {
    std::string text;
    for (const VerifiedCase& verified : report.cases) {
        const CaseVerdict& verdict = verified.verdict;
        if (verdict.finding == Finding::differs || verdict.finding == Finding::no_golden) {
            text += verdict.message + "\n";
        }
    }
    text += std::to_string(report.cases.size()) + (report.cases.size() == 1 ? " case" : " cases");
    const char* separator = ": ";
    const auto add = [&](Finding finding, const char* words) {
        if (const int count = report.count(finding); count > 0) {
            text += separator + std::to_string(count) + words;
            separator = ", ";
        }
    };
    add(Finding::equal, " equal");
    add(Finding::differs, " different");
    add(Finding::no_golden, " not recorded");
    add(Finding::error, " with errors");
    text += "\n";
    text += report.page.empty() ? "" : "report: " + report.page + "\n";
    text += report.accept.empty() ? "" : "accept with: " + report.accept + "\n";
    return text;
}

std::string verifyJson(const VerifyReport& report) {
    Json json{{"ok", report.ok()}, {"cases", Json::array()}};
    for (const VerifiedCase& verified : report.cases) {
        json["cases"].push_back(caseJson(verified.verdict));
    }
    json["report"] = orNull(report.page);
    json["accept"] = orNull(report.accept);
    return text(json);
}

std::string goldenPage(const VerifyReport& report) {
    Json json{{"compared", report.cases.size()}, {"cases", Json::array()}};
    for (const VerifiedCase& verified : report.cases) {
        if (verified.verdict.finding != Finding::equal) {
            json["cases"].push_back(pageJson(verified));
        }
    }
    json["accept"] = orNull(report.accept);
    return goldenPageAround(scriptText(json.dump(-1, ' ', false, Json::error_handler_t::replace)));
}

}  // namespace still::command
