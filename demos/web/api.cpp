// What the page's worker calls. Text comes and goes as UTF-8 and JSON; what a call returns as text
// is valid until the next call with the same host.

#include <emscripten.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "demos/scenes/atlas.h"
#include "demos/scenes/builtin.h"
#include "demos/web/stage.h"
#include "engine/anti_aliasing.h"
#include "engine/hash.h"
#include "engine/load.h"

namespace {

using namespace still;
using nlohmann::json;

struct Host {
    explicit Host(int threads) : workers(threads) {}
    Workers workers;
    std::string text;

    const char* say(std::string words) {
        text = std::move(words);
        return text.c_str();
    }
};

web::Stage* open(Host& host, Result<Scene> scene, int width, int height) {
    if (!scene) {
        host.say(scene.error().message);
        return nullptr;
    }
    frameForAspect(*scene, width, height);
    return new web::Stage(std::move(*scene), width, height, host.workers);
}

/// One line per frame, as `stillframe render --hash` writes it.
Result<std::string> hashLines(Host& host, const json& job) {
    const auto scene = builtinScene(job.at("scene"));
    if (!scene) {
        return fail(scene.error().message);
    }
    const auto aa = parseAntiAliasing(job.value("aa", "taa"));
    if (!aa) {
        return fail(aa.error().message);
    }
    const auto policy = parseTaaSettings(job.value("taa", ""), aa->policy);
    if (!policy) {
        return fail(policy.error().message);
    }
    FrameSettings settings;
    settings.width = job.at("width");
    settings.height = job.at("height");
    settings.anti_aliasing = aa->mode;
    settings.ssaa_samples = aa->ssaa_samples;
    settings.policy = *policy;
    settings.planes = {.normal = true, .motion = true};
    settings.fresh_gbuffer = true;
    FrameLoop loop(*scene, settings, host.workers);
    std::string lines;
    for (int frame = 0; frame < job.at("frames"); ++frame) {
        const FrameResult result = loop.render(frame);
        const FrameHashes h = hashFrame(result.output, *result.gbuffer);
        lines += "frame " + std::to_string(frame) + " output " + hex(h.output) + " color " +
                 hex(h.color) + " depth " + hex(h.depth) + " normal " + hex(h.normal) + " motion " +
                 hex(h.motion) + " id " + hex(h.id) + "\n";
    }
    return lines;
}

json catalogue() {
    json told;
    for (const AtlasCase& each : atlasCases()) {
        told["atlas"].push_back({{"name", each.name}, {"failure", each.failure}});
    }
    for (const TaaPreset& preset : taaPresets()) {
        told["presets"].push_back({{"name", preset.name}, {"about", preset.about}});
    }
    for (const inspect::ViewInfo& view : inspect::allViews()) {
        told["views"].push_back({{"name", view.name}, {"about", view.about}});
    }
    told["plot_side"] = web::kPlotSide;
    return told;
}

}  // namespace

extern "C" {

/// `threads` ≥ 1 counts the calling one; a build without threads takes 1 only.
EMSCRIPTEN_KEEPALIVE Host* still_host(int threads) {
    return new Host(threads);
}

/// What the last call with this host said: an error, or what it was asked for.
EMSCRIPTEN_KEEPALIVE const char* still_text(Host* host) {
    return host->text.c_str();
}

EMSCRIPTEN_KEEPALIVE const char* still_catalogue(Host* host) {
    return host->say(catalogue().dump());
}

/// A built-in scene. Null: still_text() says why.
EMSCRIPTEN_KEEPALIVE web::Stage* still_open(Host* host, const char* scene, int width, int height) {
    return open(*host, builtinScene(scene), width, height);
}

/// An OBJ or scene file of the module's own file system.
EMSCRIPTEN_KEEPALIVE web::Stage* still_load(Host* host, const char* file, int width, int height) {
    return open(*host, loadScene(file), width, height);
}

EMSCRIPTEN_KEEPALIVE void still_close(web::Stage* stage) {
    delete stage;
}

/// Null when done, else what was wrong.
EMSCRIPTEN_KEEPALIVE const char* still_configure(Host* host, web::Stage* stage, const char* wish) {
    const auto parsed = json::parse(wish, nullptr, false);
    if (!parsed.is_object()) {
        return host->say("configure: expected a JSON object");
    }
    const auto done = stage->configure(parsed);
    return done ? nullptr : host->say(done.error().message);
}

EMSCRIPTEN_KEEPALIVE bool still_move(web::Stage* stage, const char* kind, double x, double y) {
    return stage->move(kind, x, y);
}

EMSCRIPTEN_KEEPALIVE void still_scrub(web::Stage* stage, int frame) {
    stage->scrub(frame);
}

EMSCRIPTEN_KEEPALIVE void still_pick(web::Stage* stage, int x, int y) {
    stage->pick(x, y);
}

/// True when still_pixels() are new.
EMSCRIPTEN_KEEPALIVE bool still_draw(web::Stage* stage) {
    return stage->draw();
}

EMSCRIPTEN_KEEPALIVE const uint8_t* still_pixels(web::Stage* stage) {
    return stage->pixels().data();
}

EMSCRIPTEN_KEEPALIVE const char* still_report(Host* host, web::Stage* stage) {
    return host->say(stage->report().dump());
}

/// "null" when no pixel is picked; see Stage::story().
EMSCRIPTEN_KEEPALIVE const char* still_story(Host* host, web::Stage* stage) {
    return host->say(stage->story().dump());
}

/// Made by the last still_story() that was not "null".
EMSCRIPTEN_KEEPALIVE const uint8_t* still_plot(web::Stage* stage) {
    return stage->plot().data();
}

/// {"scene":, "aa":, "taa":, "width":, "height":, "frames":} in, lines out, or null.
EMSCRIPTEN_KEEPALIVE const char* still_hashes(Host* host, const char* job) {
    auto lines = hashLines(*host, json::parse(job));
    const bool done = bool(lines);
    host->say(done ? std::move(*lines) : lines.error().message);
    return done ? host->text.c_str() : nullptr;
}
}
