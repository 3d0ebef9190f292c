// The command line: finds the subcommand and gives its options to the function that does the work.

#include <algorithm>
#include <exception>
#include <vector>

#include "demos/stillframe/cli.h"
#include "demos/stillframe/memory_limit.h"
#include "demos/stillframe/report.h"

namespace still::command {
namespace {

constexpr const char* kExitCodes =
    "Exit codes: 0 ok, 1 images differ or a check failed, 2 usage, 3 cannot read or write.";

int report(const Failure& failure) {
    printFailure(failure);
    return int(failure.code);
}

int run(int argc, char** argv) {
    CLI::App app("Renders scenes on the CPU, anti-aliased over time, to the same bytes everywhere",
                 "stillframe");
    app.set_version_flag("--version", "stillframe " STILL_VERSION);
    app.require_subcommand(1);
    app.footer(kExitCodes);
    std::vector<Subcommand> subcommands{
        declareRender(app), declareCompare(app), declareAtlas(app),
        declareChart(app),  declareBench(app),   declarePresets(app),
        declareGolden(app), declareInfo(app),    declareCompletion(app)};
#if STILL_VIEWER
    subcommands.push_back(declareView(app));
#endif
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) {
            return app.exit(error);  // --help or --version
        }
        return report({ExitCode::usage, error.what() + std::string("; see stillframe --help")});
    }
    const auto chosen =
        std::find_if(subcommands.begin(), subcommands.end(),
                     [](const Subcommand& subcommand) { return subcommand.app->parsed(); });
    Interruption interruption;
    const MemoryLimit memory(
        chosen->limits != nullptr ? chosen->limits->max_memory_bytes : machineMemoryBytes(),
        interruption);
    const Outcome<ExitCode> outcome = chosen->run(interruption);
    return outcome ? int(*outcome) : report(outcome.error());
}

}  // namespace
}  // namespace still::command

int main(int argc, char** argv) {
    try {
        return still::command::run(argc, argv);
    } catch (const std::exception& exception) {
        return still::command::report(still::command::failureOf(exception));
    }
}
