#include "demos/web/stage.h"

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

#include "engine/anti_aliasing.h"
#include "engine/hash.h"

namespace still::web {
namespace {

using nlohmann::json;

double nowMs() {
    using std::chrono::duration, std::chrono::steady_clock;
    return duration<double, std::milli>(steady_clock::now().time_since_epoch()).count();
}

inspect::SessionSettings settingsFor(int width, int height) {
    inspect::SessionSettings settings;
    settings.width = width;
    settings.height = height;
    settings.clock_ms = nowMs;
    return settings;
}

Result<inspect::Mode> modeOf(const json& wish) {
    return parseAntiAliasing(wish.value("aa", "taa")).and_then([&](const AntiAliasingChoice& aa) {
        return parseTaaSettings(wish.value("taa", ""), aa.policy).map([&](const TaaPolicy& policy) {
            return inspect::Mode{aa.mode, policy, aa.ssaa_samples};
        });
    });
}

Result<void> configurePane(const json& wish, inspect::PaneSettings& pane) {
    const auto mode = modeOf(wish);
    if (!mode) {
        return fail(mode.error().message);
    }
    const std::string name = wish.value("view", "picture");
    const auto view = inspect::viewNamed(name);
    if (!view) {
        return fail("view: " + name + ": there is no such view");
    }
    pane = {*mode, *view};
    return {};
}

void configureLook(const json& wish, inspect::Look& look) {
    look.split = wish.value("split", look.split);
    look.divider = wish.value("divider", look.divider);
    if (const auto found = wish.find("magnifier"); found != wish.end()) {
        look.magnifier.on = found->is_object();
        if (look.magnifier.on) {
            look.magnifier.x = found->value("x", 0);
            look.magnifier.y = found->value("y", 0);
            look.magnifier.factor = found->value("factor", 8);
        }
    }
    if (const auto found = wish.find("overlays"); found != wish.end()) {
        const auto has = [&](const char* name) {
            return std::count(found->begin(), found->end(), name) > 0;
        };
        look.overlays = {.grid = has("grid"),
                         .axes = has("axes"),
                         .edges = has("edges"),
                         .tiles = has("tiles"),
                         .arrows = has("arrows")};
    }
}

void toRgba(ImageView<const Rgb8> image, std::vector<uint8_t>& out) {
    out.resize(size_t(image.width) * size_t(image.height) * 4, 255);
    uint8_t* to = out.data();
    for (int y = 0; y < image.height; ++y) {
        const Rgb8* row = image.row(y);
        for (int x = 0; x < image.width; ++x, to += 4) {
            to[0] = row[x].r;
            to[1] = row[x].g;
            to[2] = row[x].b;
        }
    }
}

json reportOf(const inspect::Session& session, int pane) {
    const inspect::PaneReport& report = session.report(pane);
    json told{{"hash", hex(session.hash(pane))},
              {"ms", report.total_ms},
              {"raster_ms", report.times.transform_bin_ms + report.times.raster_ms},
              {"taa_ms", report.times.taa_ms},
              {"frames", report.frames},
              {"samples", report.samples},
              {"at_rest", report.at_rest}};
    if (report.psnr_db) {
        told["psnr_db"] = *report.psnr_db;
    }
    return told;
}

}  // namespace

Stage::Stage(Scene scene, int width, int height, Workers& workers)
    : session_(std::move(scene), settingsFor(width, height), workers) {}

Result<void> Stage::configure(const json& wish) {
    for (int i = 0; i < 2; ++i) {
        const char* name = i == 0 ? "left" : "right";
        if (wish.contains(name)) {
            if (auto done = configurePane(wish[name], session_.pane(i)); !done) {
                return done;
            }
        }
    }
    configureLook(wish, session_.look());
    session_.play(wish.value("playing", session_.playing()));
    return {};
}

bool Stage::move(const std::string& kind, double x, double y) {
    if (kind == "orbit") {
        session_.steer().orbit(x, y);
    } else if (kind == "dolly") {
        session_.steer().dolly(std::clamp(x, 0.1, 10.0));
    } else if (kind == "reset") {
        session_.resetCamera();
    } else {
        return false;
    }
    return true;
}

bool Stage::draw() {
    const inspect::Drawn drawn = session_.draw();
    if (!drawn.changed) {
        return false;
    }
    toRgba(drawn.image, pixels_);
    return true;
}

json Stage::story() {
    const auto picked = session_.pickedStory();
    if (!picked) {
        return nullptr;
    }
    toRgba(inspect::storyPlot(*picked, kPlotSide).view(), plot_);
    json lines = json::array();
    for (const inspect::StoryLine& line : inspect::storyLines(*picked)) {
        lines.push_back({{"heading", line.heading}, {"text", line.text}});
        if (line.swatch) {
            lines.back()["swatch"] = {line.swatch->r, line.swatch->g, line.swatch->b};
        }
    }
    const inspect::PickedPixel& pixel = picked->pixel;
    return {{"pane", pixel.pane}, {"x", pixel.x}, {"y", pixel.y}, {"lines", lines}};
}

json Stage::report() const {
    json told{{"frame", session_.sceneFrame()},
              {"last_frame", session_.lastSceneFrame()},
              {"own_camera", session_.followsScene()},
              {"left", reportOf(session_, 0)}};
    if (!session_.picture(1).empty()) {
        told["right"] = reportOf(session_, 1);
    }
    return told;
}

}  // namespace still::web
