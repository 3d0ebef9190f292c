// stillframe golden record

#include <algorithm>
#include <set>
#include <system_error>

#include "demos/stillframe/golden_report.h"
#include "demos/stillframe/golden_run.h"
#include "demos/stillframe/png.h"
#include "demos/stillframe/report.h"
#include "demos/stillframe/whole_file.h"
#include "engine/hash.h"
#include "engine/image_file.h"

namespace still::command {
namespace {

namespace fs = std::filesystem;
using golden::Record;

uint64_t outputHash(const Record::Frame& frame) {
    return frame.stages[size_t(Stage::output)].whole;
}

/// Whether the file is a picture of exactly these pixels.
bool shows(const fs::path& file, uint64_t output_hash) {
    std::error_code error;
    if (!fs::exists(file, error)) {
        return false;
    }
    const auto image = readImageFile(file);
    return image && hashPlane(std::as_const(*image).view()) == output_hash;
}

/// Takes away pictures of an earlier recording, except of `kept` frames, and whatever else has
/// such a name but other pixels.
int removePictures(const golden::Manifest& manifest, const std::string& name, const Record& record,
                   const std::set<int>& kept) {
    int removed = 0;
    for (const Record::Frame& frame : record.frames) {
        const fs::path file = golden::pictureFile(manifest, name, frame.frame);
        std::error_code error;
        if (kept.count(frame.frame) == 0 && shows(file, outputHash(frame))) {
            removed += fs::remove(file, error) ? 1 : 0;
        }
    }
    return removed;
}

/// Recordings of cases that are not in the manifest any more. A file that is not a recording, word
/// for word, is not ours.
std::vector<std::string> removeForgotten(const golden::Manifest& manifest) {
    std::vector<std::string> names;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(manifest.folder, error)) {
        const std::string name = entry.path().stem().string();
        const bool known =
            std::any_of(manifest.cases.begin(), manifest.cases.end(),
                        [&](const golden::Case& golden_case) { return golden_case.name == name; });
        if (entry.path().extension() == ".hashes" && !known) {
            names.push_back(name);
        }
    }
    std::sort(names.begin(), names.end());
    std::erase_if(names, [&](const std::string& name) {
        const fs::path file = golden::recordFile(manifest, name);
        const auto record = golden::readRecord(file);
        if (!record) {
            return true;
        }
        removePictures(manifest, name, *record, {});
        return !fs::remove(file, error);
    });
    return names;
}

/// Renders one case and writes what is not right yet, the hashes last: an interrupted recording
/// does not pass for a finished one.
class CaseRecorder {
  public:
    CaseRecorder(const GoldenRun& run, const golden::Case& golden_case, Interruption& interruption)
        : run_(run), case_(golden_case), interruption_(interruption) {}

    Outcome<RecordedCase> record();

  private:
    Result<void> keep(const Record::Frame& frame, const FrameResult& result);
    Outcome<RecordedCase> write(const Record& record);

    const GoldenRun& run_;
    const golden::Case& case_;
    Interruption& interruption_;
    std::vector<WholeFile> pictures_;
};

Result<void> CaseRecorder::keep(const Record::Frame& frame, const FrameResult& result) {
    const fs::path file = golden::pictureFile(run_.manifest, case_.name, frame.frame);
    if (shows(file, outputHash(frame))) {
        return {};
    }
    return pngBytes(result.output)
        .map([&](std::string bytes) {
            pictures_.push_back({file, std::move(bytes)});
        })
        .map_error([](const Failure& failure) { return Error{failure.message}; });
}

Outcome<RecordedCase> CaseRecorder::write(const Record& record) {
    RecordedCase recorded{case_.name, int(record.frames.size()), Recorded::unchanged};
    const fs::path file = golden::recordFile(run_.manifest, case_.name);
    std::error_code error;
    const bool existed = fs::exists(file, error);
    const auto before = existed ? golden::readRecord(file) : fail("");
    if (!before || *before != record) {
        recorded.what = existed ? Recorded::changed : Recorded::made;
        pictures_.push_back({file, golden::recordText(record)});
    } else if (!pictures_.empty()) {
        recorded.what = Recorded::changed;
    }
    for (WholeFile& whole : pictures_) {
        if (auto written = writeWholeFiles({std::move(whole)}, interruption_); !written) {
            return tl::make_unexpected(written.error());
        }
    }
    if (before) {
        removePictures(run_.manifest, case_.name, *before,
                       {case_.frames.begin(), case_.frames.end()});
    }
    return recorded;
}

Outcome<RecordedCase> CaseRecorder::record() {
    return fromResult(
               golden::renderCase(run_.manifest, case_, run_.options,
                                  [&](const Record::Frame& frame, const FrameResult& result) {
                                      return keep(frame, result);
                                  }))
        .and_then([&](const Record& record) { return write(record); });
}

}  // namespace

Outcome<ExitCode> goldenRecord(const GoldenOptions& options, Interruption& interruption) {
    auto run = openGolden(options);
    if (!run) {
        return tl::make_unexpected(run.error());
    }
    RecordReport report;
    for (const golden::Case* golden_case : (*run)->cases) {
        auto recorded = CaseRecorder(**run, *golden_case, interruption).record();
        if (!recorded) {
            (*run)->finish();
            return tl::make_unexpected(recorded.error());
        }
        report.cases.push_back(std::move(*recorded));
    }
    (*run)->finish();
    if (options.only.empty() && (*run)->options.shard == 1) {
        report.removed = removeForgotten((*run)->manifest);
    }
    const std::string text = options.json ? recordJson(report) : recordLines(report);
    return (options.quiet && !options.json ? Outcome<void>() : print(text)).map([] {
        return ExitCode::ok;
    });
}

}  // namespace still::command
