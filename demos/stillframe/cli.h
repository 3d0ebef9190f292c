#pragma once
// The subcommands as CLI11 knows them, one function each, in few files: CLI11 is slow to compile.

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "demos/stillframe/interruption.h"
#include "demos/stillframe/options.h"

namespace still::command {

/// Declared before the command line is parsed; `run` holds the options that parsing fills in.
struct Subcommand {
    const CLI::App* app = nullptr;
    std::function<Outcome<ExitCode>(Interruption&)> run;
};

// cli_render.cpp
Subcommand declareRender(CLI::App& app);
// cli_compare.cpp
Subcommand declareCompare(CLI::App& app);
Subcommand declarePresets(CLI::App& app);
// cli_laboratory.cpp
Subcommand declareAtlas(CLI::App& app);
Subcommand declareChart(CLI::App& app);
Subcommand declareBench(CLI::App& app);
// cli_golden.cpp
Subcommand declareGolden(CLI::App& app);

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

}  // namespace still::command
