// The command line. CLI11 is included here and nowhere else: it is slow to compile.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <new>

#include "demos/stillframe/compare.h"
#include "demos/stillframe/render.h"

namespace still::command {
namespace {

constexpr const char* kExitCodes =
    "Exit codes: 0 ok, 1 images differ or a check failed, 2 usage, 3 cannot read or write.";
constexpr int kMaxFrames = 1000000;

CLI::App* addRender(CLI::App& app, RenderOptions& o) {
    CLI::App* render = app.add_subcommand("render", "Render frames of a scene");
    render->add_option("scene", o.scene, "FILE.obj, FILE.json or builtin:NAME (builtin:courtyard)")
        ->required();
    render->add_option("-o,--output", o.output,
                       "NAME.png (several frames: NAME.0000.png …, or put {frame}, {frame:4} or "
                       "%04d into the name), NAME.gif, NAME.mp4 (needs ffmpeg), or - for a PNG on "
                       "standard output");
    render->add_option_function<std::string>(
        "--resolution",
        [&o](const std::string& text) {
            const auto size = parseResolution(text);
            if (!size) {
                throw CLI::ValidationError(size.error().message);
            }
            o.resolution = *size;
        },
        "WIDTHxHEIGHT or WIDTH,HEIGHT, default 1280x720 or the camera file's");
    render->add_option("--frames", o.frames, "Number of frames, default 1 or the camera file's")
        ->check(CLI::Range(1, kMaxFrames));
    render->add_option("--start", o.start, "First frame")->check(CLI::Range(0, kMaxFrames));
    render->add_option("--cameras", o.cameras, "JSON file with a view and a projection per frame");
    render->add_option("--view", o.view, "Camera out of the scene's views");
    render
        ->add_option("--orbit", o.orbit_deg,
                     "Degrees that the camera circles its target by over the frames")
        ->check(CLI::Range(-36000.0, 36000.0));
    render->add_option("--anti-aliasing,--aa", o.anti_aliasing,
                       "none, taa (temporal, the default), or ssaa:N (N samples, the reference)");
    render
        ->add_option("--samples", o.samples,
                     "Samples of a finished picture, i.e. one frame of a still scene; default 64")
        ->check(CLI::Range(1, 4096));
    render->add_option("--dump", o.dump,
                       "Also write planes as NAME.PLANE.png: color,depth,normal,motion,id,"
                       "confidence");
    render->add_option("--threads", o.threads, "Threads, default all cores")
        ->check(CLI::Range(1, 256));
    render->add_option("--simd", o.simd, "Instruction set, default the best; same bytes on all");
    render->add_option("--shading", o.shading, "deferred (default) or forward; same bytes")
        ->check(CLI::IsMember({"deferred", "forward"}));
    render->add_option("--tone-map", o.tone_map, "none (default) or reinhard")
        ->check(CLI::IsMember({"none", "reinhard"}));
    render->add_option("--fps", o.fps, "Frames per second of GIF and MP4, default 30")
        ->check(CLI::Range(1, 1000));
    render->add_flag("--hash", o.hash, "Print a 64-bit hash of every plane of every frame");
    render->add_flag("--json", o.json, "Print times, memory and hashes as one JSON object");
    return render;
}

CLI::App* addCompare(CLI::App& app, CompareOptions& o) {
    CLI::App* compare = app.add_subcommand(
        "compare", "Compare two pictures, or two frame patterns like a.{frame}.png");
    compare->add_option("A", o.a, "The expected picture or pattern")->required();
    compare->add_option("B", o.b, "The other one; must have all frames of A")->required();
    compare->add_option("--diff", o.diff, "Write a picture of the differences");
    compare->add_flag("--exact", o.exact, "List the first differing pixels");
    compare->add_flag("--json", o.json,
                      "Print {\"psnr\" (null when identical), \"ssim\", \"max_difference\", "
                      "\"identical\"}");
    return compare;
}

int report(const Failure& failure) {
    std::fprintf(stderr, "stillframe: %s\n", failure.message.c_str());
    return int(failure.code);
}

int run(int argc, char** argv) {
    CLI::App app("Renders scenes on the CPU, anti-aliased over time, to the same bytes everywhere");
    app.set_version_flag("--version", "stillframe " STILL_VERSION);
    app.require_subcommand(1);
    app.footer(kExitCodes);
    RenderOptions render_options;
    CompareOptions compare_options;
    const CLI::App* render_command = addRender(app, render_options);
    addCompare(app, compare_options);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) {
            return app.exit(error);  // --help or --version
        }
        return report({ExitCode::usage, error.what()});
    }
    Interruption interruption;
    const Outcome<ExitCode> outcome =
        render_command->parsed()
            ? render(render_options, interruption).map([] { return ExitCode::ok; })
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
