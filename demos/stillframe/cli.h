#pragma once
// The subcommands as CLI11 knows them, one function each, in few files: CLI11 is slow to compile.

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "demos/stillframe/interruption.h"
#include "demos/stillframe/limits.h"
#include "demos/stillframe/options.h"

namespace still::command {

/// Declared before the command line is parsed; `run` holds the options that parsing fills in.
struct Subcommand {
    const CLI::App* app = nullptr;
    std::function<Outcome<ExitCode>(Interruption&)> run;
    const Limits* limits = nullptr;  ///< of commands that open scenes; lives as long as `run`
};

// cli_render.cpp
Subcommand declareRender(CLI::App& app);
Subcommand declareInfo(CLI::App& app);
// cli_compare.cpp
Subcommand declareCompare(CLI::App& app);
Subcommand declarePresets(CLI::App& app);
// cli_laboratory.cpp
Subcommand declareAtlas(CLI::App& app);
Subcommand declareChart(CLI::App& app);
Subcommand declareBench(CLI::App& app);
// cli_golden.cpp
Subcommand declareGolden(CLI::App& app);
// cli_completion.cpp
Subcommand declareCompletion(CLI::App& app);
// cli_view.cpp, which is there with the build option STILL_VIEWER
Subcommand declareView(CLI::App& app);

constexpr int kMaxFrames = 1000000;

/// An option whose text `parse` turns into an Outcome of what `target` takes.
template <class Target, class Parse>
CLI::Option* addParsed(CLI::App& command, const std::string& name, Target& target, Parse parse,
                       const char* text) {
    return command.add_option_function<std::string>(
        name,
        [&target, parse, name](const std::string& typed) {
            const auto parsed = parse(typed);
            if (!parsed) {
                const std::string& message = parsed.error().message;
                throw CLI::ValidationError(message.starts_with("--") ? message
                                                                     : name + ": " + message);
            }
            target = *parsed;
        },
        text);
}

/// What changes no byte.
inline void addMachineOptions(CLI::App& command, int& threads, std::string& simd) {
    command.add_option("--threads", threads, "Default: all cores. The bytes are the same")
        ->check(CLI::Range(1, 256))
        ->type_name("N");
    command.add_option("--simd", simd, "Instruction set, default the best. The bytes are the same")
        ->type_name("TARGET");
}

/// CLI::Range lets NaN pass.
inline CLI::Validator between(double low, double high) {
    const auto check = [low, high](std::string& text) {
        double value = 0;
        const bool fits = CLI::detail::lexical_cast(text, value) && value >= low && value <= high;
        return fits ? std::string()
                    : text + ": expected a number from " + CLI::detail::to_string(low) + " to " +
                          CLI::detail::to_string(high);
    };
    return CLI::Validator(check, "");
}

/// `size` is a Size, which keeps its default, or an optional one.
template <class Target>
void addSize(CLI::App& command, Target& size, const char* text) {
    addParsed(command, "--resolution", size, parseResolution, text)->type_name("WIDTHxHEIGHT");
}

/// Of all scenes that the command opens.
inline void addLights(CLI::App& command, std::string& lights) {
    command
        .add_option("--lights", lights,
                    "Scene file whose lights and background are taken instead of\n"
                    "the scene's own, as demos/scenes/sun_and_sky.json")
        ->type_name("FILE");
}

/// Of all commands that open scenes.
inline void addLimits(CLI::App& command, Limits& limits) {
    command.add_flag("--allow-outside", limits.allow_outside,
                     "Scenes may name files outside of their folder");
    addParsed(command, "--max-memory", limits.max_memory_bytes, parseBytes,
              "As 512M or 1.5G: what would need more is refused, or ended with\n"
              "an error; default what the machine has")
        ->type_name("SIZE");
}

/// What every command has that may print warnings or progress.
inline void addQuiet(CLI::App& command, bool& quiet) {
    command.add_flag("--quiet", quiet, "No warnings and no progress; errors are told all the same");
}

}  // namespace still::command
