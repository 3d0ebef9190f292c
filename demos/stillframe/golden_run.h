#pragma once
// What recording and verifying have in common: the manifest, the chosen cases, progress.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "demos/stillframe/golden.h"
#include "demos/stillframe/progress.h"
#include "engine/golden.h"

namespace still::command {

/// `options` points into the run, so a run stays where it was made.
struct GoldenRun {
    golden::Manifest manifest;
    std::vector<const golden::Case*> cases;
    golden::Options options;
    std::optional<ProgressBar> progress;  ///< counts frames
    int frames_done = 0;
    std::vector<std::string> warnings;  ///< of manifest and scenes; printed when the bar is gone

    GoldenRun() = default;
    GoldenRun(const GoldenRun&) = delete;
    GoldenRun& operator=(const GoldenRun&) = delete;

    /// Takes the bar away and prints the warnings.
    void finish();
};

/// Reads the manifest and chooses the cases. Quiet runs have neither progress nor warnings.
Outcome<std::unique_ptr<GoldenRun>> openGolden(const GoldenOptions& options);

}  // namespace still::command
