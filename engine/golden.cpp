#include "engine/golden.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ostream>
#include <thread>

#include "engine/hash.h"
#include "engine/image_file.h"
#include "engine/internal/file_access.h"
#include "engine/internal/obj_text.h"
#include "engine/jitter.h"
#include "engine/load.h"
#include "engine/memory_need.h"
#include "postfx/metrics.h"

namespace still::golden {
namespace {

Image<Rgb8> copyOf(ImageView<const Rgb8> from) {
    Image<Rgb8> image(from.width, from.height);
    for (int y = 0; y < from.height; ++y) {
        std::copy_n(from.row(y), from.width, image.view().row(y));
    }
    return image;
}

std::string sizeText(int width, int height) {
    return std::to_string(width) + "x" + std::to_string(height);
}

/// "frame 3", "frames 0 to 7" or "frames 0, 30, 59".
std::string framesText(const std::vector<int>& frames) {
    constexpr size_t kMost = 12;
    std::string text = std::to_string(frames.front());
    if (frames.size() == 1) {
        return "frame " + text;
    }
    if (size_t(frames.back() - frames.front()) + 1 == frames.size()) {
        return "frames " + text + " to " + std::to_string(frames.back());
    }
    for (size_t i = 1; i < std::min(frames.size(), kMost); ++i) {
        text += ", " + std::to_string(frames[i]);
    }
    return "frames " + text + (frames.size() > kMost ? ", …" : "");
}

std::string shown(Rgb8 colour) {
    return std::to_string(colour.r) + " " + std::to_string(colour.g) + " " +
           std::to_string(colour.b);
}

LoadOptions loadOptions(const Manifest& manifest, const Options& options) {
    const std::filesystem::path& folder = manifest.folder;
    return {.cache_folder = options.cache_folder,
            .allow_outside = options.allow_outside,
            .folder = folder.empty() ? "." : folder,
            .max_memory_bytes = options.max_memory_bytes};
}

/// The file that the manifest names as the case's `key`.
Result<std::filesystem::path> findFile(const Manifest& manifest, const Case& golden_case,
                                       const Options& options, const char* key,
                                       const std::string& name) {
    return FileAccess(loadOptions(manifest, options), {})
        .find(manifest.folder, name)
        .map_error([&](const Error& error) {
            return Error{golden_case.place + "/" + key + ": " + error.message};
        });
}

Result<Scene> openScene(const Manifest& manifest, const Case& golden_case, const Options& options) {
    constexpr std::string_view kBuiltin = "builtin:";
    if (!golden_case.scene.starts_with(kBuiltin)) {
        const LoadOptions load = loadOptions(manifest, options);
        return findFile(manifest, golden_case, options, "scene", golden_case.scene)
            .and_then([&](const std::filesystem::path& file) { return loadScene(file, load); });
    }
    if (!options.builtin) {
        return fail(golden_case.place + "/scene: expected a file, found " +
                    shownText(golden_case.scene) + ": no built-in scenes are known here");
    }
    return options.builtin(golden_case.scene.substr(kBuiltin.size()))
        .map_error([&](const Error& error) {
            return Error{golden_case.place + "/scene: " + error.message};
        });
}

Result<int> findView(const Scene& scene, const Case& golden_case) {
    std::string known;
    for (size_t i = 0; i < scene.views.size(); ++i) {
        if (scene.views[i].name == golden_case.view) {
            return int(i);
        }
        known += (i == 0 ? "" : ", ") + shownText(scene.views[i].name);
    }
    if (golden_case.view.empty()) {
        return -1;
    }
    return fail(golden_case.place + "/view: " + shownText(golden_case.view) + ": the scene has " +
                (known.empty() ? "no views" : "the views " + known));
}

/// What a case needs to be rendered; `settings` points into it.
struct Opened {
    Scene scene;
    CameraFile cameras;
    FrameSettings settings;
};

/// Everything that comes from files.
Result<void> open(const Manifest& manifest, const Case& golden_case, const Options& options,
                  Opened& opened) {
    opened.settings = golden_case.settings;
    opened.settings.simd = options.simd;
    auto scene = openScene(manifest, golden_case, options);
    if (!scene) {
        return tl::make_unexpected(scene.error());
    }
    opened.scene = std::move(*scene);
    frameForAspect(opened.scene, opened.settings.width, opened.settings.height);
    const auto view = findView(opened.scene, golden_case);
    if (!view) {
        return tl::make_unexpected(view.error());
    }
    CameraChoice& camera = opened.settings.camera;
    camera.view = *view;
    if (!golden_case.cameras.empty()) {
        auto cameras = findFile(manifest, golden_case, options, "cameras", golden_case.cameras)
                           .and_then(loadCameraFile);
        if (!cameras) {
            return tl::make_unexpected(cameras.error());
        }
        opened.cameras = std::move(*cameras);
        camera.file = &opened.cameras;
    }
    const bool finished = golden_case.frames == std::vector<int>{0} &&
                          opened.settings.anti_aliasing == AntiAliasing::taa &&
                          isStill(opened.scene, camera);
    if (auto fits = checkFrameMemory(golden_case.place, opened.scene, opened.settings,
                                     options.max_memory_bytes);
        !fits) {
        return fits;
    }
    opened.settings.subframes =
        golden_case.samples.value_or(finished ? finishingSamples(opened.settings.policy) : 1);
    return {};
}

/// Number of different pixels in the rectangle; the first one, if any, goes into `difference`.
uint64_t countDifferences(ImageView<const Rgb8> a, ImageView<const Rgb8> b,
                          const TileRectangle& rectangle, FrameDifference& difference) {
    uint64_t pixels = 0;
    for (int y = rectangle.y; y < rectangle.y + rectangle.height; ++y) {
        for (int x = rectangle.x; x < rectangle.x + rectangle.width; ++x) {
            if (a.at(x, y) != b.at(x, y) && pixels++ == 0) {
                difference.first_x = x;
                difference.first_y = y;
            }
        }
    }
    return pixels;
}

/// Takes the expected picture in if it is the recorded one, and compares.
void comparePictures(const std::filesystem::path& file, const StageHash& recorded,
                     FrameDifference& difference) {
    auto expected = readImageFile(file);
    if (!expected || hashPlane(std::as_const(*expected).view()) != recorded.whole) {
        return;
    }
    difference.expected = std::move(*expected);
    const ImageView<const Rgb8> a = std::as_const(difference.expected).view();
    const ImageView<const Rgb8> b = std::as_const(difference.actual).view();
    difference.pixels = countDifferences(a, b, {0, 0, 0, 0, a.width, a.height}, difference);
    if (!difference.stages.tiles.empty()) {
        countDifferences(a, b, tileRectangle(difference, difference.stages.tiles.front()),
                         difference);
    }
    difference.psnr_db = psnrDb(pixelError(a, b));
}

std::string placeText(const FrameDifference& difference) {
    const StageDifference& stages = difference.stages;
    std::string text = "frame " + std::to_string(difference.frame) + ": " + name(stages.stage) +
                       " is the first stage that differs";
    if (stages.tiles.empty()) {
        return text;
    }
    const TileRectangle tile = tileRectangle(difference, stages.tiles.front());
    text += ", in tile (" + std::to_string(tile.tile_x) + ", " + std::to_string(tile.tile_y) +
            "), pixels " + std::to_string(tile.x) + "," + std::to_string(tile.y) + " to " +
            std::to_string(tile.x + tile.width - 1) + "," +
            std::to_string(tile.y + tile.height - 1);
    const size_t more = stages.tiles.size() - 1;
    return more == 0 ? text
                     : text + " and " + std::to_string(more) + " more tile" + (more > 1 ? "s" : "");
}

std::string pixelsText(const Manifest& manifest, const std::string& name,
                       const FrameDifference& difference) {
    if (!difference.pixels) {
        return shownPath(pictureFile(manifest, name, difference.frame)) +
               " is not there or not as recorded, so no pixels are compared";
    }
    if (*difference.pixels == 0) {
        return "no pixel of the picture differs";
    }
    const int x = difference.first_x, y = difference.first_y;
    char psnr[32];
    std::snprintf(psnr, sizeof psnr, "%.1f", difference.psnr_db);
    return std::to_string(*difference.pixels) + (*difference.pixels > 1 ? " pixels" : " pixel") +
           ", first at " + std::to_string(x) + "," + std::to_string(y) + ": " +
           shown(difference.actual.at(x, y)) + ", expected " + shown(difference.expected.at(x, y)) +
           "; PSNR " + psnr + " dB";
}

/// Compares frame by frame while a case is rendered.
class Comparison {
  public:
    Comparison(const Manifest& manifest, const Case& golden_case, const Record& record,
               CaseVerdict& verdict)
        : manifest_(manifest), case_(golden_case), record_(record), verdict_(verdict) {}

    void add(const Record::Frame& actual, const FrameResult& result) {
        const Record::Frame& expected = record_.frames[size_t(verdict_.frames++)];
        auto stages = firstDifference(expected.stages, actual.stages);
        if (!stages || verdict_.differing++ > 0) {
            return;
        }
        verdict_.finding = Finding::differs;
        FrameDifference& first = verdict_.first.emplace();
        first.frame = actual.frame;
        first.width = record_.width;
        first.height = record_.height;
        first.frame_width = result.gbuffer->width();
        first.frame_height = result.gbuffer->height();
        first.stages = std::move(*stages);
        first.actual = copyOf(result.output);
        comparePictures(pictureFile(manifest_, case_.name, actual.frame),
                        expected.stages[size_t(Stage::output)], first);
    }

    std::string message() const {
        const std::string some = std::to_string(verdict_.differing) + " of " +
                                 std::to_string(verdict_.frames) + " frames differ";
        return case_.name + ": " + placeText(*verdict_.first) + "; " +
               pixelsText(manifest_, case_.name, *verdict_.first) +
               (verdict_.frames > 1 ? "; " + some : "");
    }

  private:
    const Manifest& manifest_;
    const Case& case_;
    const Record& record_;
    CaseVerdict& verdict_;
};

CaseVerdict found(const Case& golden_case, Finding finding, const std::string& what) {
    CaseVerdict verdict;
    verdict.name = golden_case.name;
    verdict.finding = finding;
    verdict.message = golden_case.name + ": " + what;
    return verdict;
}

/// Whether the recording is of what the manifest asks for; else what is wrong with it.
std::string mismatch(const Case& golden_case, const Record& record) {
    const FrameSettings& settings = golden_case.settings;
    if (settings.width != record.width || settings.height != record.height) {
        return "recorded at " + sizeText(record.width, record.height) + ", expected " +
               sizeText(settings.width, settings.height);
    }
    std::vector<int> frames;
    for (const Record::Frame& frame : record.frames) {
        frames.push_back(frame.frame);
    }
    return frames == golden_case.frames
               ? ""
               : "recorded " + framesText(frames) + ", expected " + framesText(golden_case.frames);
}

/// A word for the shell.
std::string quoted(const std::string& word) {
    const bool plain = !word.empty() && std::all_of(word.begin(), word.end(), [](char c) {
        return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
               std::string_view("-_./,:+").find(c) != std::string_view::npos;
    });
    std::string text = "'";
    for (const char c : word) {
        text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    }
    return plain ? word : text + "'";
}

}  // namespace

std::filesystem::path recordFile(const Manifest& manifest, const std::string& name) {
    return manifest.folder / (name + ".hashes");
}

std::filesystem::path pictureFile(const Manifest& manifest, const std::string& name, int frame) {
    char number[16];
    std::snprintf(number, sizeof number, ".%04d.png", frame);
    return manifest.folder / (name + number);
}

TileRectangle tileRectangle(int tile, int width, int height) {
    const int across = (width + kTileSize - 1) / kTileSize;
    TileRectangle r{.tile_x = tile % across, .tile_y = tile / across};
    r.x = r.tile_x * kTileSize;
    r.y = r.tile_y * kTileSize;
    r.width = std::min(kTileSize, width - r.x);
    r.height = std::min(kTileSize, height - r.y);
    return r;
}

TileRectangle tileRectangle(const FrameDifference& difference, int tile) {
    const int width = difference.width, height = difference.height;
    const int frame_width = difference.frame_width, frame_height = difference.frame_height;
    if (difference.stages.stage >= Stage::linear || frame_width == width) {
        return tileRectangle(tile, width, height);
    }
    TileRectangle r = tileRectangle(tile, frame_width, frame_height);
    const int right = ((r.x + r.width) * width + frame_width - 1) / frame_width;
    const int bottom = ((r.y + r.height) * height + frame_height - 1) / frame_height;
    r.x = r.x * width / frame_width;
    r.y = r.y * height / frame_height;
    r.width = right - r.x;
    r.height = bottom - r.y;
    return r;
}

Result<Record> renderCase(const Manifest& manifest, const Case& golden_case, const Options& options,
                          const FrameSink& sink) {
    Opened opened;
    if (auto done = open(manifest, golden_case, options, opened); !done) {
        return tl::make_unexpected(done.error());
    }
    for (const auto* warnings : {&opened.scene.warnings, &opened.cameras.warnings}) {
        for (const std::string& warning : *warnings) {
            if (options.warn) {
                options.warn(warning);
            }
        }
    }
    const int cores = std::max(1, int(std::thread::hardware_concurrency()));
    Workers workers(options.threads > 0 ? options.threads : cores);
    FrameLoop loop(opened.scene, opened.settings, workers);
    Record record{opened.settings.width, opened.settings.height, {}};
    for (const int frame : golden_case.frames) {
        const FrameResult result = loop.render(frame);
        record.frames.push_back({frame, hashStages(result)});
        if (sink) {
            if (auto taken = sink(record.frames.back(), result); !taken) {
                return tl::make_unexpected(taken.error());
            }
        }
        if (options.frame_done) {
            options.frame_done();
        }
    }
    return record;
}

CaseVerdict verifyCase(const Manifest& manifest, const Case& golden_case, const Options& options) {
    const std::filesystem::path file = recordFile(manifest, golden_case.name);
    std::error_code error;
    if (!std::filesystem::exists(file, error)) {
        return found(golden_case, Finding::no_golden, shownPath(file) + " is not there");
    }
    const Result<Record> record = readRecord(file);
    if (!record) {
        return found(golden_case, Finding::error, record.error().message);
    }
    if (const std::string wrong = mismatch(golden_case, *record); !wrong.empty()) {
        return found(golden_case, Finding::no_golden, shownPath(file) + ": " + wrong);
    }
    CaseVerdict verdict;
    verdict.name = golden_case.name;
    Comparison comparison(manifest, golden_case, *record, verdict);
    const auto rendered = renderCase(manifest, golden_case, options,
                                     [&](const Record::Frame& frame, const FrameResult& result) {
                                         comparison.add(frame, result);
                                         return Result<void>();
                                     });
    if (!rendered) {
        return found(golden_case, Finding::error, rendered.error().message);
    }
    if (verdict.finding == Finding::differs) {
        verdict.message = comparison.message();
    }
    return verdict;
}

std::string acceptCommand(const std::filesystem::path& folder,
                          const std::vector<std::string>& names) {
    std::string list;
    for (const std::string& name : names) {
        list += (list.empty() ? "" : ",") + name;
    }
    return "stillframe golden record " + quoted(folder.string()) + " --only " + list;
}

std::ostream& operator<<(std::ostream& stream, const Verdict& verdict) {
    return stream << verdict.message;
}

Verdict verify(const std::filesystem::path& folder, const Options& options) {
    const Result<Manifest> manifest = readManifest(folder);
    if (!manifest) {
        return {false, manifest.error().message, {}};
    }
    const auto chosen = chosenCases(*manifest, options);
    if (!chosen) {
        return {false, chosen.error().message, {}};
    }
    Verdict verdict;
    for (const std::string& warning : manifest->warnings) {
        verdict.message += "warning: " + warning + "\n";
    }
    for (const Case* golden_case : *chosen) {
        const CaseVerdict one = verifyCase(*manifest, *golden_case, options);
        if (one.finding != Finding::equal) {
            verdict.failed.push_back(one.name);
            verdict.message += one.message + "\n";
        }
    }
    verdict.ok = verdict.failed.empty();
    verdict.message += verdict.ok ? "golden: " + std::to_string(chosen->size()) + " equal"
                                  : "accept with: " + acceptCommand(folder, verdict.failed);
    return verdict;
}

}  // namespace still::golden
