#pragma once
// A rendering job: the options of `stillframe render` with every question answered.

#include <vector>

#include "demos/stillframe/name_pattern.h"
#include "demos/stillframe/options.h"
#include "demos/stillframe/sink.h"

namespace still::command {

/// `settings` points into the job, so a job stays where it was made.
struct Job {
    RenderOptions options;
    Scene scene;
    CameraFile cameras;
    FrameSettings settings;
    std::string preset;  ///< of TAA
    std::vector<DumpPlane> dump;
    SinkKind sink = SinkKind::none;
    NamePattern name;  ///< of the pictures; with a number when there are several
    int start = 0, frames = 1;
    int threads = 1;

    explicit Job(RenderOptions options_in) : options(std::move(options_in)) {}
    Job(const Job&) = delete;
    Job& operator=(const Job&) = delete;
};

/// Checks the options, reads scene and cameras (their warnings go to standard error), decides the
/// rest. Options that are wrong by themselves are refused before a file is touched.
Outcome<void> prepare(Job& job);

}  // namespace still::command
