// stillframe compare and presets: their options.

#include <memory>

#include "demos/stillframe/cli.h"
#include "demos/stillframe/compare.h"
#include "demos/stillframe/report.h"

namespace still::command {

Subcommand declareCompare(CLI::App& app) {
    const auto o = std::make_shared<CompareOptions>();
    CLI::App* compare = app.add_subcommand(
        "compare", "Compare two pictures, or two frame patterns like a.{frame}.png");
    compare->add_option("A", o->a, "The expected picture or pattern")->required()->type_name("");
    compare->add_option("B", o->b, "The other one; it must have all frames of A")
        ->required()
        ->type_name("");
    compare->add_option("--diff", o->diff, "Write a picture of the differences")
        ->type_name("NAME.png");
    compare->add_flag("--exact", o->exact, "List the first differing pixels");
    compare->add_flag("--json", o->json,
                      "Print psnr (null when identical), ssim, max_difference and\n"
                      "identical as one JSON object");
    compare->add_flag("--quiet", o->quiet, "Print nothing, tell by the exit code");
    return {compare,
            [o](Interruption& interruption) { return still::command::compare(*o, interruption); }};
}

Subcommand declarePresets(CLI::App& app) {
    const auto json = std::make_shared<bool>(false);
    CLI::App* presets =
        app.add_subcommand("presets", "List the presets of temporal anti-aliasing, its settings");
    presets->add_flag("--json", *json, "As one JSON object");
    return {
        presets, [json](Interruption&) {
            return print(*json ? presetsJson() : presetsLines()).map([] { return ExitCode::ok; });
        }};
}

}  // namespace still::command
