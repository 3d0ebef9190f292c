// The command line. CLI11 is included here and nowhere else: it is slow to compile.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <new>
#include <string>

#include "demos/scenes/bench_scenes.h"
#include "demos/stillframe/atlas.h"
#include "demos/stillframe/bench.h"
#include "demos/stillframe/chart.h"
#include "demos/stillframe/compare.h"
#include "demos/stillframe/render.h"
#include "demos/stillframe/report.h"

namespace still::command {
namespace {

constexpr const char* kExitCodes =
    "Exit codes: 0 ok, 1 images differ or a check failed, 2 usage, 3 cannot read or write.";
constexpr int kMaxFrames = 1000000;

/// `size` is a Size, which keeps its default, or an optional one.
template <class Target>
void addSize(CLI::App& command, Target& size, const char* text) {
    command
        .add_option_function<std::string>(
            "--resolution",
            [&size](const std::string& typed) {
                const auto parsed = parseResolution(typed);
                if (!parsed) {
                    throw CLI::ValidationError(parsed.error().message);
                }
                size = *parsed;
            },
            text)
        ->type_name("WIDTHxHEIGHT");
}

void addPictureOptions(CLI::App& render, RenderOptions& o) {
    render
        .add_option("-o,--output", o.output,
                    "NAME.png; several frames become NAME.0000.png and so on, or\n"
                    "put {frame}, {frame:4} or %04d where the number goes.\n"
                    "NAME.gif, NAME.mp4 (needs the ffmpeg program).\n"
                    "- writes a PNG to standard output")
        ->type_name("NAME");
    addSize(render, o.resolution, "Also WIDTH,HEIGHT; default 1280x720, or the camera file's");
    render
        .add_option("--anti-aliasing,--aa", o.anti_aliasing,
                    "none; taa: temporal, the default, which is taa:still;\n"
                    "taa:PRESET: another method, see stillframe presets;\n"
                    "fxaa: edges smoothed in each frame alone;\n"
                    "ssaa:N: N samples a pixel, the reference")
        ->type_name("MODE");
    render.add_option("--taa", o.taa, "Settings of taa, over those of the preset; listed below")
        ->type_name("KEY=VALUE,...");
    render
        .add_option("--samples", o.samples,
                    "Samples of a finished picture, which is what one frame of a\n"
                    "scene without motion becomes; default 64")
        ->check(CLI::Range(1, 4096))
        ->type_name("N");
    render.add_option("--tone-map", o.tone_map, "none (default) or reinhard")
        ->check(CLI::IsMember({"none", "reinhard"}))
        ->type_name("NAME");
    render
        .add_option("--dump", o.dump,
                    "Also write planes as NAME.PLANE.png: color, depth, normal,\n"
                    "motion, id, confidence (several with commas)")
        ->type_name("PLANES");
}

void addTimeOptions(CLI::App& render, RenderOptions& o) {
    render.add_option("--frames", o.frames, "How many; default 1, or the camera file's")
        ->check(CLI::Range(1, kMaxFrames))
        ->type_name("N");
    render.add_option("--start", o.start, "The first frame, default 0")
        ->check(CLI::Range(0, kMaxFrames))
        ->type_name("K");
    render.add_option("--fps", o.fps, "Speed of GIF and MP4, default 30")
        ->check(CLI::Range(1, 1000))
        ->type_name("N");
    render.add_option("--cameras", o.cameras, "JSON with a view and a projection for each frame")
        ->type_name("FILE");
    render.add_option("--view", o.view, "One of the scene's views")->type_name("NAME");
    render
        .add_option("--orbit", o.orbit_deg,
                    "The camera circles its target by so much over the frames")
        ->check(CLI::Range(-36000.0, 36000.0))
        ->type_name("DEGREES");
}

void addMachineOptions(CLI::App& render, RenderOptions& o) {
    render.add_option("--threads", o.threads, "Default: all cores. The bytes are the same")
        ->check(CLI::Range(1, 256))
        ->type_name("N");
    render
        .add_option("--simd", o.simd, "Instruction set, default the best. The bytes are the same")
        ->type_name("TARGET");
    render
        .add_option("--shading", o.shading, "deferred (default) or forward. The bytes are the same")
        ->check(CLI::IsMember({"deferred", "forward"}))
        ->type_name("NAME");
    render.add_flag("--no-cache", o.no_cache,
                    "Read OBJ files anew, where otherwise large ones are kept ready in\n"
                    "$XDG_CACHE_HOME/stillframe or ~/.cache/stillframe (at most 2 GB)");
    render.add_flag("--hash", o.hash, "Print 64-bit hashes of all planes of each frame");
    render.add_flag("--json", o.json, "Print times, memory and hashes as one JSON object");
}

CLI::App* addRender(CLI::App& app, RenderOptions& o) {
    CLI::App* render = app.add_subcommand("render", "Render frames of a scene");
    render
        ->add_option("SCENE", o.scene, "FILE.obj, FILE.json or builtin:NAME, as builtin:courtyard")
        ->required()
        ->type_name("");
    addPictureOptions(*render, o);
    addTimeOptions(*render, o);
    addMachineOptions(*render, o);
    render->footer("Settings of --taa:\n" + taaSettingsLines());
    return render;
}

CLI::App* addCompare(CLI::App& app, CompareOptions& o) {
    CLI::App* compare = app.add_subcommand(
        "compare", "Compare two pictures, or two frame patterns like a.{frame}.png");
    compare->add_option("A", o.a, "The expected picture or pattern")->required()->type_name("");
    compare->add_option("B", o.b, "The other one; it must have all frames of A")
        ->required()
        ->type_name("");
    compare->add_option("--diff", o.diff, "Write a picture of the differences")
        ->type_name("NAME.png");
    compare->add_flag("--exact", o.exact, "List the first differing pixels");
    compare->add_flag("--json", o.json,
                      "Print psnr (null when identical), ssim, max_difference and\n"
                      "identical as one JSON object");
    return compare;
}

CLI::App* addPresets(CLI::App& app, bool& json) {
    CLI::App* presets =
        app.add_subcommand("presets", "List the presets of temporal anti-aliasing, its settings");
    presets->add_flag("--json", json, "As one JSON object");
    return presets;
}

/// What the programs of the laboratory share.
void addLaboratoryOptions(CLI::App& command, std::string& output, std::string& cache, bool& json) {
    command
        .add_option("-o,--output", output, "Folder for what is found, made when it is not there")
        ->required()
        ->type_name("DIR");
    command
        .add_option("--cache", cache,
                    "Folder for references, default $XDG_CACHE_HOME/stillframe\n"
                    "or ~/.cache/stillframe")
        ->type_name("DIR");
    command.add_flag("--json", json, "Print the results as one JSON object");
}

CLI::App* addAtlas(CLI::App& app, AtlasOptions& o) {
    CLI::App* atlas = app.add_subcommand(
        "atlas", "Measure ways of anti-aliasing on scenes on which such ways fail");
    addLaboratoryOptions(*atlas, o.output, o.cache, o.json);
    atlas->add_option("--scenes", o.scenes, "Cases with commas, default all that are quick")
        ->type_name("NAMES");
    atlas
        ->add_option("--presets", o.presets,
                     "Presets, raw, fxaa and ssaa:N with commas; default all but ssaa")
        ->type_name("NAMES");
    addSize(*atlas, o.resolution, "Default 320x180");
    return atlas;
}

CLI::App* addChart(CLI::App& app, ChartOptions& o) {
    CLI::App* chart = app.add_subcommand(
        "chart", "Draw milliseconds per frame against error, for all ways of anti-aliasing");
    chart->add_option("SCENE", o.scenes, "FILE.obj, FILE.json or builtin:NAME; one or several")
        ->required()
        ->type_name("");
    addLaboratoryOptions(*chart, o.output, o.cache, o.json);
    addSize(*chart, o.resolution, "Default 640x360");
    chart->add_option("--frames", o.frames, "Of each segment, default 64")
        ->check(CLI::Range(4, 10000))
        ->type_name("N");
    chart
        ->add_option("--orbit", o.orbit_deg,
                     "The camera circles its target by so much each frame of the\n"
                     "moving segment, default 1/3")
        ->check(CLI::Range(-360.0, 360.0))
        ->type_name("DEGREES");
    chart
        ->add_option("--samples", o.reference_samples,
                     "Of the moving segment's references, default 256; the still\n"
                     "one's get four times as many")
        ->check(CLI::Range(1, 16384))
        ->type_name("N");
    return chart;
}

CLI::App* addBench(CLI::App& app, BenchOptions& o) {
    CLI::App* bench = app.add_subcommand(
        "bench",
        "Measure the stages of a frame: scenes at rest, under a moving camera, with\n"
        "moving objects");
    bench
        ->add_option("SCENE", o.scenes,
                     "FILE.obj, FILE.json or builtin:NAME; default those made for it,\n"
                     "and Sponza when it is in the folder STILL_DATA")
        ->type_name("");
    addSize(*bench, o.resolution, "Default 1920x1080, or the camera file's");
    bench
        ->add_option("--threads", o.threads,
                     "One number or several with commas, measured in turns;\n"
                     "default all cores")
        ->type_name("N,...");
    bench
        ->add_option("--frames", o.frames,
                     "Of each motion, the first quarter of them unmeasured; default 72:\n"
                     "a scene at rest is finished after 64")
        ->check(CLI::Range(4, kBenchFrames))
        ->type_name("N");
    bench->add_option("--cameras", o.cameras, "JSON with a view and a projection for each frame")
        ->type_name("FILE");
    bench->add_option("--simd", o.simd, "Instruction set, default the best")->type_name("TARGET");
    bench->add_flag("--json", o.json, "Print the results as one JSON object");
    return bench;
}

/// One line, whatever the file's name is made of.
int report(const Failure& failure) {
    std::string line = failure.message;
    std::replace_if(
        line.begin(), line.end(), [](unsigned char c) { return c < 32; }, '?');
    std::fprintf(stderr, "stillframe: %s\n", line.c_str());
    return int(failure.code);
}

int run(int argc, char** argv) {
    CLI::App app("Renders scenes on the CPU, anti-aliased over time, to the same bytes everywhere",
                 "stillframe");
    app.set_version_flag("--version", "stillframe " STILL_VERSION);
    app.require_subcommand(1);
    app.footer(kExitCodes);
    RenderOptions render_options;
    CompareOptions compare_options;
    bool presets_json = false;
    const CLI::App* render_command = addRender(app, render_options);
    addCompare(app, compare_options);
    AtlasOptions atlas_options;
    const CLI::App* atlas_command = addAtlas(app, atlas_options);
    ChartOptions chart_options;
    const CLI::App* chart_command = addChart(app, chart_options);
    BenchOptions bench_options;
    const CLI::App* bench_command = addBench(app, bench_options);
    const CLI::App* presets_command = addPresets(app, presets_json);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) {
            return app.exit(error);  // --help or --version
        }
        return report({ExitCode::usage, error.what() + std::string("; see stillframe --help")});
    }
    if (presets_command->parsed()) {
        const auto printed = print(presets_json ? presetsJson() : presetsLines());
        return printed ? int(ExitCode::ok) : report(printed.error());
    }
    Interruption interruption;
    const auto ok = [] { return ExitCode::ok; };
    const Outcome<ExitCode> outcome =
        render_command->parsed()  ? render(render_options, interruption).map(ok)
        : atlas_command->parsed() ? atlas(atlas_options, interruption).map(ok)
        : chart_command->parsed() ? chart(chart_options, interruption).map(ok)
        : bench_command->parsed() ? bench(bench_options).map(ok)
                                  : compare(compare_options, interruption);
    return outcome ? int(*outcome) : report(outcome.error());
}

}  // namespace
}  // namespace still::command

int main(int argc, char** argv) {
    try {
        return still::command::run(argc, argv);
    } catch (const std::bad_alloc&) {
        return still::command::report({still::command::ExitCode::file_error, "not enough memory"});
    }
}
