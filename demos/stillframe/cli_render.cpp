// stillframe render and info: their options.

#include <memory>

#include "demos/stillframe/cli.h"
#include "demos/stillframe/info.h"
#include "demos/stillframe/render.h"
#include "demos/stillframe/report.h"

namespace still::command {
namespace {

void addPictureOptions(CLI::App& render, RenderOptions& o) {
    render
        .add_option("-o,--output", o.output,
                    "NAME.png; several frames become NAME.0000.png and so on, or\n"
                    "put {frame}, {frame:4} or %04d where the number goes, and\n"
                    "{model} for the scene's name. All frames in one file:\n"
                    "NAME.apng (exact colours), NAME.gif, NAME.y4m, and NAME.mp4\n"
                    "(needs the ffmpeg program). - is standard output: a PNG,\n"
                    "or Y4M of several frames")
        ->type_name("NAME");
    render
        .add_option("--reference", o.reference,
                    "Compare with this PNG, or pattern of several as of --output.\n"
                    "The output is kept only where it differs, with NAME.diff.png\n"
                    "beside it, and the exit code is then 1")
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
    addLights(render, o.lights);
    render
        .add_option("--denoise", o.denoise,
                    "on (default) or off: whether light that is sampled, as of\n"
                    "soft shadows, is cleaned of noise; ssaa:N needs none")
        ->check(CLI::IsMember({"on", "off"}))
        ->type_name("SWITCH");
    render.add_option("--tone-map", o.tone_map, "none (default) or reinhard")
        ->check(CLI::IsMember({"none", "reinhard"}))
        ->type_name("NAME");
    render
        .add_option("--exposure", o.exposure_stops,
                    "Doubles light so many times before the tone map; default 0")
        ->check(between(-16.0, 16.0))
        ->type_name("STOPS");
    addParsed(render, "--background-color", o.background, parseColour,
              "R,G,B from 0 to 1, or #rrggbb; sRGB")
        ->type_name("COLOR");
    render.add_flag("--no-background", o.no_background,
                    "Alpha instead, in PNG and APNG; takes twice the time");
    render
        .add_option("--dump", o.dump,
                    "Also write planes as NAME.PLANE.png: color, depth, normal,\n"
                    "motion, id, confidence (several with commas)")
        ->type_name("PLANES");
}

void addTimeOptions(CLI::App& render, RenderOptions& o) {
    render
        .add_option("--frames", o.frames,
                    "How many; default 1, 60 of a turntable, or the camera file's")
        ->check(CLI::Range(1, kMaxFrames))
        ->type_name("N");
    render
        .add_option("--start", o.start,
                    "The first frame, default 0. Typed, the frames are part of a run: the\n"
                    "same bytes as among all others")
        ->check(CLI::Range(0, kMaxFrames))
        ->type_name("K");
    render.add_option("--fps", o.fps, "Speed of APNG, GIF, MP4 and Y4M, default 30")
        ->check(CLI::Range(1, 1000))
        ->type_name("N");
    render.add_option("--cameras", o.cameras, "JSON with a view and a projection for each frame")
        ->type_name("FILE");
    render.add_option("--view", o.view, "One of the scene's views")->type_name("VIEW");
    render
        .add_option("--orbit", o.orbit_deg,
                    "The camera circles its target by so much over the frames")
        ->check(between(-36000.0, 36000.0))
        ->type_name("DEGREES");
    render
        .add_option("--orbit-frames", o.orbit_frames,
                    "The frames that the orbit takes, default --frames; for parts of a run")
        ->check(CLI::Range(1, kMaxFrames))
        ->type_name("N");
    render.add_flag("--turntable", o.turntable,
                    "An orbit of 360 degrees, anti-aliased by ssaa:16 by default");
}

void addCameraOptions(CLI::App& render, CameraOptions& o) {
    const auto point = [&](const char* name, std::optional<glm::dvec3>& target, const char* text) {
        addParsed(render, name, target, parsePoint, text)->type_name("X,Y,Z");
    };
    const auto degrees = [&](const char* name, double& target, const char* text) {
        render.add_option(name, target, text)
            ->check(between(-36000.0, 36000.0))
            ->type_name("DEGREES");
    };
    addParsed(render, "--up", o.up, parseDirection,
              "Which way is up in the scene: +Z, -X … or X,Y,Z; default +Y.\n"
              "Automatic camera and light follow")
        ->type_name("AXIS");
    point("--camera-position", o.position, "Where the eye stands");
    point("--camera-focal-point", o.focal_point, "What it looks at");
    addParsed(render, "--camera-view-up", o.view_up, parseDirection,
              "What is up in the picture, as --up, for the camera alone")
        ->type_name("AXIS");
    render.add_option("--camera-view-angle", o.view_angle_deg, "From bottom to top")
        ->check(between(0.1, 170.0))
        ->type_name("DEGREES");
    degrees("--camera-azimuth-angle", o.azimuth_deg, "The eye goes around to the right by so much");
    degrees("--camera-elevation-angle", o.elevation_deg, "and then up");
    render
        .add_option("--camera-zoom-factor", o.zoom, "So many times as large, by a narrower angle")
        ->check(between(0.01, 1000.0))
        ->type_name("N");
    render.add_flag("--camera-orthographic", o.orthographic,
                    "Parallel projection, the focal point as large as before");
}

void addRunOptions(CLI::App& render, RenderOptions& o) {
    addMachineOptions(render, o.threads, o.simd);
    render
        .add_option("--shading", o.shading, "deferred (default) or forward. The bytes are the same")
        ->check(CLI::IsMember({"deferred", "forward"}))
        ->type_name("NAME");
    render.add_flag("--no-cache", o.no_cache,
                    "Read OBJ files anew, where otherwise large ones are kept ready in\n"
                    "$XDG_CACHE_HOME/stillframe or ~/.cache/stillframe (at most 2 GB)");
    render.add_flag("--hash", o.hash, "Print 64-bit hashes of all planes of each frame");
    render.add_flag("--json", o.json,
                    "Print times, memory, hashes and comparisons as one JSON object");
    addQuiet(render, o.quiet);
    addLimits(render, o.limits);
    render.add_flag("--watch", o.watch,
                    "Render again when a file of the scene changes, until Ctrl-C");
}

}  // namespace

Subcommand declareRender(CLI::App& app) {
    const auto o = std::make_shared<RenderOptions>();
    CLI::App* render = app.add_subcommand("render", "Render frames of a scene");
    render
        ->add_option("SCENE", o->scenes,
                     "FILE.obj, FILE.json, builtin:NAME, as builtin:courtyard, or - for\n"
                     "standard input; several with {model} in --output")
        ->required()
        ->type_name("");
    addPictureOptions(*render, *o);
    addTimeOptions(*render, *o);
    addCameraOptions(*render, o->camera);
    addRunOptions(*render, *o);
    render->footer("Settings of --taa:\n" + taaSettingsLines());
    return {render,
            [o](Interruption& interruption) { return still::command::render(*o, interruption); },
            &o->limits};
}

Subcommand declareInfo(CLI::App& app) {
    const auto o = std::make_shared<InfoOptions>();
    CLI::App* info =
        app.add_subcommand("info", "Tell what a scene holds, and which code it makes run");
    info->add_option("SCENE", o->scene, "FILE.obj, FILE.json, builtin:NAME or -")
        ->required()
        ->type_name("");
    info->add_flag("--no-cache", o->no_cache, "Read OBJ files anew, see render");
    info->add_flag("--json", o->json, "As one JSON object");
    addQuiet(*info, o->quiet);
    addLimits(*info, o->limits);
    return {
        info,
        [o](Interruption&) { return still::command::info(*o).map([] { return ExitCode::ok; }); },
        &o->limits};
}

}  // namespace still::command
