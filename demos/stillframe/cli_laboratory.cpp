// stillframe atlas, chart and bench: their options.

#include <memory>

#include "demos/scenes/bench_scenes.h"
#include "demos/stillframe/atlas.h"
#include "demos/stillframe/bench.h"
#include "demos/stillframe/chart.h"
#include "demos/stillframe/cli.h"

namespace still::command {
namespace {

/// What the programs of the laboratory share.
template <class Options>
void addLaboratoryOptions(CLI::App& command, Options& o) {
    command
        .add_option("-o,--output", o.output, "Folder for what is found, made when it is not there")
        ->required()
        ->type_name("DIR");
    command
        .add_option("--cache", o.cache,
                    "Folder for references, default $XDG_CACHE_HOME/stillframe\n"
                    "or ~/.cache/stillframe")
        ->type_name("DIR");
    command.add_flag("--json", o.json, "Print the results as one JSON object");
    addQuiet(command, o.quiet);
    addLimits(command, o.limits);
}

}  // namespace

Subcommand declareAtlas(CLI::App& app) {
    const auto o = std::make_shared<AtlasOptions>();
    CLI::App* atlas = app.add_subcommand(
        "atlas", "Measure ways of anti-aliasing on scenes on which such ways fail");
    addLaboratoryOptions(*atlas, *o);
    atlas
        ->add_option("--suite", o->suite,
                     "failures (default): on which temporal methods fail;\n"
                     "noise: with light that is sampled, against plain accumulation")
        ->check(CLI::IsMember({"failures", "noise"}))
        ->type_name("NAME");
    atlas->add_option("--scenes", o->scenes, "Cases with commas, default all that are quick")
        ->type_name("NAMES");
    atlas
        ->add_option("--model", o->models,
                     "FILE.obj, FILE.json or builtin:NAME as a further case of the suite of\n"
                     "noise, standing still")
        ->type_name("SCENE");
    addLights(*atlas, o->lights);
    atlas
        ->add_option("--presets", o->presets,
                     "Presets, raw, fxaa and ssaa:N with commas; default all but ssaa, or\n"
                     "raw and still with and without denoising of the suite of noise.\n"
                     "NAME:KEY=VALUE changes a setting, as --taa does, or denoise=off")
        ->type_name("NAMES");
    atlas
        ->add_option("--versus", o->versus,
                     "One of the presets: time all in turns with it, and print what they\n"
                     "gain and cost against it, on the mean of all cases")
        ->type_name("NAME");
    addParsed(*atlas, "--time-resolution", o->time_resolution, parseResolution,
              "At which --versus takes times, default that of the pictures")
        ->type_name("WIDTHxHEIGHT");
    atlas
        ->add_option("--samples", o->samples,
                     "At most so many of each reference: quick, and less exact")
        ->check(CLI::Range(1, 65536))
        ->type_name("N");
    addSize(*atlas, o->resolution, "Default 320x180");
    return {atlas,
            [o](Interruption& interruption) {
                return still::command::atlas(*o, interruption).map([] { return ExitCode::ok; });
            },
            &o->limits};
}

Subcommand declareChart(CLI::App& app) {
    const auto o = std::make_shared<ChartOptions>();
    CLI::App* chart = app.add_subcommand(
        "chart", "Draw milliseconds per frame against error, for all ways of anti-aliasing");
    chart->add_option("SCENE", o->scenes, "FILE.obj, FILE.json or builtin:NAME; one or several")
        ->required()
        ->type_name("");
    addLights(*chart, o->lights);
    addLaboratoryOptions(*chart, *o);
    addSize(*chart, o->resolution, "Default 640x360");
    chart->add_option("--frames", o->frames, "Of each segment, default 64")
        ->check(CLI::Range(4, 10000))
        ->type_name("N");
    chart
        ->add_option("--orbit", o->orbit_deg,
                     "The camera circles its target by so much each frame of the\n"
                     "moving segment, default 1/3")
        ->check(CLI::Range(-360.0, 360.0))
        ->type_name("DEGREES");
    chart
        ->add_option("--samples", o->reference_samples,
                     "Of the moving segment's references, default 256; the still\n"
                     "one's get four times as many")
        ->check(CLI::Range(1, 16384))
        ->type_name("N");
    return {chart,
            [o](Interruption& interruption) {
                return still::command::chart(*o, interruption).map([] { return ExitCode::ok; });
            },
            &o->limits};
}

Subcommand declareBench(CLI::App& app) {
    const auto o = std::make_shared<BenchOptions>();
    CLI::App* bench = app.add_subcommand(
        "bench",
        "Measure the stages of a frame: scenes at rest, under a moving camera, with\n"
        "moving objects");
    bench
        ->add_option("SCENE", o->scenes,
                     "FILE.obj, FILE.json or builtin:NAME; default those made for it,\n"
                     "and Sponza when it is in the folder STILL_DATA")
        ->type_name("");
    addSize(*bench, o->resolution, "Default 1920x1080, or the camera file's");
    bench
        ->add_option("--threads", o->threads,
                     "One number or several with commas, measured in turns;\n"
                     "default all cores")
        ->type_name("N,...");
    bench
        ->add_option("--frames", o->frames,
                     "Of each motion, the first quarter of them unmeasured; default 72:\n"
                     "a scene at rest is finished after 64")
        ->check(CLI::Range(4, kBenchFrames))
        ->type_name("N");
    bench->add_option("--cameras", o->cameras, "JSON with a view and a projection for each frame")
        ->type_name("FILE");
    bench->add_option("--simd", o->simd, "Instruction set, default the best")->type_name("TARGET");
    bench->add_flag("--json", o->json, "Print the results as one JSON object");
    addQuiet(*bench, o->quiet);
    addLimits(*bench, o->limits);
    return {
        bench,
        [o](Interruption&) { return still::command::bench(*o).map([] { return ExitCode::ok; }); },
        &o->limits};
}

}  // namespace still::command
