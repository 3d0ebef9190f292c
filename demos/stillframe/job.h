#pragma once
// A rendering job: the options of `stillframe render` with every question answered for one scene.

#include <vector>

#include "demos/stillframe/name_pattern.h"
#include "demos/stillframe/options.h"
#include "demos/stillframe/sink.h"

namespace still::command {

/// `settings` points into the job, so a job stays where it was made. The options must outlive it.
struct Job {
    const RenderOptions& options;
    std::string scene_name;  ///< as typed
    Scene scene;
    CameraFile cameras;
    FrameSettings settings;
    std::string anti_aliasing;  ///< as it would be typed
    std::string preset;         ///< of TAA
    std::vector<DumpPlane> dump;
    SinkKind sink = SinkKind::none;
    NamePattern name;  ///< of the pictures; with a number when there are several
    std::optional<NamePattern> reference;  ///< with a number when there are several pictures
    int start = 0, frames = 1;
    int threads = 1;

    Job(const RenderOptions& options_in, std::string scene_name_in)
        : options(options_in), scene_name(std::move(scene_name_in)) {}
    Job(const Job&) = delete;
    Job& operator=(const Job&) = delete;
};

/// What can be said of the options alone, before any job: values, and what excludes what.
Outcome<void> checkOptions(const RenderOptions& options);

/// Checks the options, reads scene and cameras (their warnings go to standard error), decides the
/// rest. Options that are wrong by themselves are refused before a file is touched.
Outcome<void> prepare(Job& job);

}  // namespace still::command
