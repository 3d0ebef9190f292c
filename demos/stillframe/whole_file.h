#pragma once
// Whole files, written together.

#include <filesystem>
#include <string>
#include <vector>

#include "demos/stillframe/interruption.h"
#include "demos/stillframe/outcome.h"

namespace still::command {

struct WholeFile {
    std::filesystem::path path;
    std::string bytes;
};

/// Writes all under temporary names before the first gets its own.
Outcome<void> writeWholeFiles(const std::vector<WholeFile>& files, Interruption& interruption);

/// Makes a folder and tries to write into it, so that a long job does not fail at its end.
Outcome<void> tryFolder(const std::filesystem::path& folder, Interruption& interruption);

}  // namespace still::command
