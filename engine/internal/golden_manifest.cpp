#include <algorithm>
#include <limits>
#include <numeric>
#include <set>

#include "engine/anti_aliasing.h"
#include "engine/golden.h"
#include "engine/internal/json.h"
#include "engine/internal/obj_text.h"

namespace still::golden {
namespace {

constexpr int kMaxFrame = 1000000;
constexpr size_t kMaxFrames = 4000000;  ///< of all cases together
constexpr int kMaxSamples = 4096;
constexpr size_t kMaxCases = 100000;
constexpr size_t kMaxName = 100;

/// Frames "start" … of the number "frames", or the list "frames".
std::vector<int> framesFrom(const JsonCursor& cursor) {
    const auto start = cursor.find("start");
    const auto frames = cursor.find("frames");
    std::vector<int> list;
    if (frames && frames->is(JsonValue::Type::array)) {
        for (const JsonCursor& item : frames->items(1, kMaxFrame)) {
            const int frame = item.integer(0, kMaxFrame);
            if (!list.empty() && frame <= list.back()) {
                item.expected("a frame after the one before");
            }
            list.push_back(frame);
        }
        if (start) {
            start->refuse("expected no start where the frames are a list");
        }
        return list;
    }
    list.resize(size_t(frames ? frames->integer(1, kMaxFrame) : 1));
    std::iota(list.begin(), list.end(), start ? start->integer(0, kMaxFrame) : 0);
    return list;
}

/// Control characters become '?', for the text will stand in messages.
std::string oneLine(const JsonCursor& cursor) {
    return shownPath(cursor.text());
}

/// The value of `result`, or an error at the cursor.
template <class T>
T valueOr(const JsonCursor& cursor, Result<T> result, T otherwise) {
    if (!result) {
        cursor.refuse(result.error().message);
        return otherwise;
    }
    return std::move(*result);
}

void readAntiAliasing(const JsonCursor& cursor, FrameSettings& settings) {
    AntiAliasingChoice choice;
    if (const auto mode = cursor.find("anti_aliasing")) {
        choice = valueOr(*mode, parseAntiAliasing(oneLine(*mode)), choice);
    }
    settings.anti_aliasing = choice.mode;
    settings.ssaa_samples = choice.ssaa_samples;
    settings.policy = choice.policy;
    if (const auto taa = cursor.find("taa")) {
        settings.policy =
            valueOr(*taa, parseTaaSettings(oneLine(*taa), choice.policy), choice.policy);
        if (choice.mode != AntiAliasing::taa) {
            taa->refuse("expected \"anti_aliasing\" to be a kind of taa");
        }
    }
}

void readPicture(const JsonCursor& cursor, Case& golden_case) {
    FrameSettings& settings = golden_case.settings;
    const auto sides = cursor.require("resolution").items(2, 2);
    if (sides.size() == 2) {
        settings.width = sides[0].integer(1, kMaxTargetSize);
        settings.height = sides[1].integer(1, kMaxTargetSize);
    }
    readAntiAliasing(cursor, settings);
    if (const auto tone_map = cursor.find("tone_map")) {
        const std::string name = tone_map->text();
        settings.tone_map = name == "reinhard" ? ToneMap::reinhard : ToneMap::none;
        if (name != "reinhard" && name != "none") {
            tone_map->expected("none or reinhard");
        }
    }
    if (const auto samples = cursor.find("samples")) {
        golden_case.samples = samples->integer(1, kMaxSamples);
        if (settings.anti_aliasing != AntiAliasing::taa) {
            samples->refuse("expected \"anti_aliasing\" to be a kind of taa");
        }
    }
}

void readCamera(const JsonCursor& cursor, Case& golden_case) {
    const auto view = cursor.find("view"), cameras = cursor.find("cameras"),
               orbit = cursor.find("orbit_deg");
    if (view) {
        golden_case.view = view->text();
    }
    if (cameras) {
        golden_case.cameras = cameras->text();
        if (view || orbit) {
            cameras->refuse("expected neither view nor orbit_deg beside a camera file");
        }
    }
    if (orbit && !golden_case.frames.empty()) {
        golden_case.settings.camera.orbit_deg = orbit->number(-36000, 36000);
        golden_case.settings.camera.orbit_frames = golden_case.frames.back() + 1;
    }
}

bool isPlainName(const std::string& name) {
    return name.size() <= kMaxName && std::all_of(name.begin(), name.end(), [](char c) {
               return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                      c == '-' || c == '_';
           });
}

Case caseFrom(const JsonCursor& cursor, const std::string& file) {
    cursor.expectKeys({"name", "scene", "resolution", "frames", "start", "anti_aliasing", "taa",
                       "samples", "tone_map", "view", "cameras", "orbit_deg"},
                      {"notes", "comment"});
    Case golden_case;
    const JsonCursor name = cursor.require("name");
    golden_case.name = name.text();
    golden_case.place = file + ": " + cursor.path();
    if (!isPlainName(golden_case.name)) {
        name.expected("a name of at most 100 letters, digits, - and _");
    }
    golden_case.scene = cursor.require("scene").text();
    golden_case.frames = framesFrom(cursor);
    readPicture(cursor, golden_case);
    readCamera(cursor, golden_case);
    golden_case.settings.planes = {.normal = true, .motion = true};
    golden_case.settings.fresh_gbuffer = true;
    return golden_case;
}

/// Names that differ in case only would be one file on some systems.
std::string lower(std::string name) {
    for (char& c : name) {
        c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
    }
    return name;
}

}  // namespace

Result<Manifest> readManifest(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / "golden.json";
    const Result<JsonValue> tree = readJson(file);
    if (!tree) {
        return tl::make_unexpected(tree.error());
    }
    JsonReport report{.file = shownPath(file), .error = {}, .warnings = {}};
    const JsonCursor root(*tree, report);
    root.expectKeys({"cases"}, {"notes", "comment"});
    Manifest manifest{folder, {}, {}};
    std::vector<std::string> names;
    size_t frames = 0;
    for (const JsonCursor& cursor : root.require("cases").items(1, kMaxCases)) {
        manifest.cases.push_back(caseFrom(cursor, report.file));
        names.push_back(lower(manifest.cases.back().name));
        frames += manifest.cases.back().frames.size();
        if (frames > kMaxFrames) {
            cursor.refuse("expected at most " + std::to_string(kMaxFrames) +
                          " frames in all cases");
            break;
        }
    }
    std::set<std::string> known;
    for (size_t i = 0; i < names.size() && !report.error; ++i) {
        if (!known.insert(names[i]).second) {
            root.refuse("expected cases with different names, found two called " +
                        manifest.cases[i].name);
        }
    }
    if (report.error) {
        return tl::make_unexpected(*report.error);
    }
    manifest.warnings = std::move(report.warnings);
    return manifest;
}

Result<std::vector<const Case*>> chosenCases(const Manifest& manifest, const Options& options) {
    std::string known;
    std::vector<const Case*> chosen;
    for (const Case& golden_case : manifest.cases) {
        const auto& only = options.only;
        known += (known.empty() ? "" : ", ") + golden_case.name;
        if (only.empty() || std::count(only.begin(), only.end(), golden_case.name) > 0) {
            chosen.push_back(&golden_case);
        }
    }
    for (const std::string& name : options.only) {
        if (std::none_of(chosen.begin(), chosen.end(),
                         [&](const Case* golden_case) { return golden_case->name == name; })) {
            return fail(shownText(name) + ": expected names of cases out of " + known);
        }
    }
    std::vector<const Case*> part;
    for (size_t i = size_t(options.shard - 1); i < chosen.size(); i += size_t(options.shards)) {
        part.push_back(chosen[i]);
    }
    return part;
}

}  // namespace still::golden
