// stillframe golden verify

#include <cstdio>
#include <system_error>

#include "demos/stillframe/difference.h"
#include "demos/stillframe/file_cache.h"
#include "demos/stillframe/golden_report.h"
#include "demos/stillframe/golden_run.h"
#include "demos/stillframe/png.h"
#include "demos/stillframe/report.h"
#include "demos/stillframe/whole_file.h"

namespace still::command {
namespace {

namespace fs = std::filesystem;
using golden::Finding;

fs::path outputFolder(const GoldenOptions& options) {
    return options.output.empty() ? fs::path(options.folder) / "out" : fs::path(options.output);
}

/// Shards may share the folder, so each has its own page.
fs::path pageFile(const GoldenOptions& options, const golden::Options& chosen) {
    const std::string part = chosen.shards == 1 ? ""
                                                : "-" + std::to_string(chosen.shard) + "-of-" +
                                                      std::to_string(chosen.shards);
    return outputFolder(options) / ("report" + part + ".html");
}

fs::path pictureOf(const GoldenOptions& options, const std::string& name, const char* kind) {
    return outputFolder(options) / (name + "." + kind + ".png");
}

/// What an earlier run found out about these cases is not true any more.
void removeOld(const GoldenOptions& options, const GoldenRun& run) {
    std::error_code ignored;
    fs::remove(pageFile(options, run.options), ignored);
    for (const golden::Case* golden_case : run.cases) {
        for (const char* kind : {"expected", "actual", "diff"}) {
            fs::remove(pictureOf(options, golden_case->name, kind), ignored);
        }
    }
}

/// Makes PNGs of the pictures, which then give their memory back.
Outcome<void> encodePictures(VerifiedCase& verified) {
    if (!verified.verdict.first) {
        return {};
    }
    golden::FrameDifference& first = *verified.verdict.first;
    const auto actual = std::as_const(first.actual).view();
    const auto expected = std::as_const(first.expected).view();
    const auto encode = [](ImageView<const Rgb8> image, std::string& png) {
        return pngBytes(image).map([&](std::string bytes) { png = std::move(bytes); });
    };
    return encode(actual, verified.actual_png)
        .and_then([&]() -> Outcome<void> {
            if (expected.empty()) {
                return {};
            }
            const Image<Rgb8> diff = differencePicture(expected, actual);
            return encode(expected, verified.expected_png).and_then([&] {
                return encode(diff.view(), verified.diff_png);
            });
        })
        .map([&] {
            first.actual = Image<Rgb8>();
            first.expected = Image<Rgb8>();
        });
}

Outcome<void> writePictures(const GoldenOptions& options, const VerifiedCase& verified,
                            Interruption& interruption) {
    const std::string& name = verified.verdict.name;
    std::vector<WholeFile> files;
    const auto add = [&](const char* kind, const std::string& png) {
        if (!png.empty()) {
            files.push_back({pictureOf(options, name, kind), png});
        }
    };
    add("expected", verified.expected_png);
    add("actual", verified.actual_png);
    add("diff", verified.diff_png);
    return writeWholeFiles(files, interruption);
}

Outcome<void> writeReport(const GoldenOptions& options, const GoldenRun& run, VerifyReport& report,
                          Interruption& interruption) {
    std::vector<std::string> failed;
    for (const VerifiedCase& verified : report.cases) {
        if (verified.verdict.finding == Finding::differs ||
            verified.verdict.finding == Finding::no_golden) {
            failed.push_back(verified.verdict.name);
        }
    }
    if (!failed.empty()) {
        report.accept = golden::acceptCommand(options.folder, failed);
    }
    if (report.count(Finding::differs) == 0) {
        return {};
    }
    if (auto made = makeFolder(outputFolder(options)); !made) {
        return made;
    }
    for (const VerifiedCase& verified : report.cases) {
        if (auto written = writePictures(options, verified, interruption); !written) {
            return written;
        }
    }
    report.page = pageFile(options, run.options).string();
    return writeWholeFiles({{report.page, goldenPage(report)}}, interruption);
}

/// Cases that cannot be rendered are errors, which belong on standard error.
void printErrors(const VerifyReport& report) {
    for (const VerifiedCase& verified : report.cases) {
        if (verified.verdict.finding == Finding::error) {
            std::fprintf(stderr, "stillframe: %s\n", verified.verdict.message.c_str());
        }
    }
}

ExitCode exitCodeOf(const VerifyReport& report) {
    return report.count(Finding::error) > 0 ? ExitCode::file_error
           : report.ok()                    ? ExitCode::ok
                                            : ExitCode::differs;
}

}  // namespace

Outcome<ExitCode> goldenVerify(const GoldenOptions& options, Interruption& interruption) {
    auto opened = openGolden(options);
    if (!opened) {
        return tl::make_unexpected(opened.error());
    }
    GoldenRun& run = **opened;
    removeOld(options, run);
    VerifyReport report;
    Outcome<void> done;
    for (size_t i = 0; i < run.cases.size() && done; ++i) {
        report.cases.push_back({golden::verifyCase(run.manifest, *run.cases[i], run.options)});
        done = encodePictures(report.cases.back());
    }
    run.finish();
    printErrors(report);
    return done.and_then([&] { return writeReport(options, run, report, interruption); })
        .and_then([&]() -> Outcome<void> {
            if (options.json) {
                return print(verifyJson(report));
            }
            return options.quiet && report.ok() ? Outcome<void>() : print(verifyLines(report));
        })
        .map([&] { return exitCodeOf(report); });
}

}  // namespace still::command
