// stillframe view: its options.

#include <memory>

#include "demos/stillframe/cli.h"
#include "demos/viewer/view.h"

namespace still::command {

Subcommand declareView(CLI::App& app) {
    const auto options = std::make_shared<viewer::ViewOptions>();
    viewer::ViewOptions& o = *options;
    CLI::App* view = app.add_subcommand("view", "Open a window on a scene; H lists all keys");
    view->add_option("SCENE", o.scene, "FILE.obj, FILE.json or builtin:NAME, as builtin:courtyard")
        ->required()
        ->type_name("");
    addSize(*view, o.resolution, "Of the window, default 1280x720");
    view->add_option("--anti-aliasing,--aa", o.anti_aliasing,
                     "none, taa, taa:PRESET, fxaa or ssaa:N, to begin with")
        ->type_name("MODE");
    view->add_option("--taa", o.taa, "Settings of taa, over those of the preset")
        ->type_name("KEY=VALUE,...");
    view->add_option("--tone-map", o.tone_map, "none (default) or reinhard")
        ->check(CLI::IsMember({"none", "reinhard"}))
        ->type_name("NAME");
    addLights(*view, o.lights);
    view->add_option("--threads", o.threads, "Default: all cores")
        ->check(CLI::Range(1, 256))
        ->type_name("N");
    view->add_option("--script", o.script,
                     "Keys, mouse and screenshots from a file, instead of people;\n"
                     "SDL_VIDEODRIVER=dummy needs no screen")
        ->type_name("FILE");
    view->add_flag("--no-cache", o.no_cache, "Read OBJ files anew, see stillframe render --help");
    addLimits(*view, o.limits);
    return {view,
            [options](Interruption& interruption) {
                return viewer::view(*options, interruption).map([] { return ExitCode::ok; });
            },
            &options->limits};
}

}  // namespace still::command
