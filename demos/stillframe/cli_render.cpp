// stillframe render: its options.

#include <memory>

#include "demos/stillframe/cli.h"
#include "demos/stillframe/render.h"
#include "demos/stillframe/report.h"

namespace still::command {
namespace {

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
    render
        .add_option("--start", o.start,
                    "The first frame, default 0. Typed, the frames are part of a run: the\n"
                    "same bytes as among all others")
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
    render
        .add_option("--orbit-frames", o.orbit_frames,
                    "The frames that the orbit takes, default --frames; for parts of a run")
        ->check(CLI::Range(1, kMaxFrames))
        ->type_name("N");
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

}  // namespace

Subcommand declareRender(CLI::App& app) {
    const auto o = std::make_shared<RenderOptions>();
    CLI::App* render = app.add_subcommand("render", "Render frames of a scene");
    render
        ->add_option("SCENE", o->scene, "FILE.obj, FILE.json or builtin:NAME, as builtin:courtyard")
        ->required()
        ->type_name("");
    addPictureOptions(*render, *o);
    addTimeOptions(*render, *o);
    addMachineOptions(*render, *o);
    render->footer("Settings of --taa:\n" + taaSettingsLines());
    return {render, [o](Interruption& interruption) {
                return still::command::render(*o, interruption).map([] { return ExitCode::ok; });
            }};
}

}  // namespace still::command
