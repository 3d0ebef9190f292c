// stillframe golden: its options.

#include <memory>

#include "demos/stillframe/cli.h"
#include "demos/stillframe/golden.h"

namespace still::command {
namespace {

void addGoldenOptions(CLI::App& command, GoldenOptions& o) {
    command.add_option("DIR", o.folder, "The folder of golden.json")->required()->type_name("");
    command.add_option("--only", o.only, "Names of cases with commas")->type_name("NAMES");
    command
        .add_option("--shard", o.shard, "Part I of N of the cases, I from 1: for several machines")
        ->type_name("I/N");
    addMachineOptions(command, o.threads, o.simd);
    command.add_flag("--json", o.json, "Print the result as one JSON object");
    addLimits(command, o.limits);
}

}  // namespace

Subcommand declareGolden(CLI::App& app) {
    const auto o = std::make_shared<GoldenOptions>();
    CLI::App* golden = app.add_subcommand(
        "golden", "Record pictures of scenes, and verify that they stay the same bit for bit");
    golden->require_subcommand(1);
    CLI::App* record = golden->add_subcommand(
        "record", "Render the cases of DIR/golden.json and keep hashes and PNGs in DIR");
    addGoldenOptions(*record, *o);
    record->add_flag("--quiet", o->quiet, "No progress, no warnings, no list");
    CLI::App* verify = golden->add_subcommand(
        "verify", "Render again and compare; exit code 1 when anything differs");
    addGoldenOptions(*verify, *o);
    verify->add_flag("--quiet", o->quiet, "No progress, no warnings, nothing when all are equal");
    verify
        ->add_option("-o,--output", o->output,
                     "Folder for pictures and page of what differs, default DIR/out")
        ->type_name("FOLDER");
    return {golden,
            [o, record](Interruption& interruption) {
                return record->parsed() ? goldenRecord(*o, interruption)
                                        : goldenVerify(*o, interruption);
            },
            &o->limits};
}

}  // namespace still::command
