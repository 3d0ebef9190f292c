#pragma once
// Where the shared models and images are, for the tests that use them.

#include <filesystem>
#include <string>
#include <vector>

namespace still {

/// The folder named by the environment variable STILL_DATA, else ../shared/data beside the
/// repository; empty when there is none, and such tests say so and pass.
std::filesystem::path dataFolder();

/// Path of a file in it, or empty (and a Catch2 warning that the test is skipped) when absent.
std::filesystem::path dataFile(const std::string& relative);

/// Regular files under a folder of it with one of the extensions (".obj"; all files when none is
/// given), sorted by path.
std::vector<std::filesystem::path> dataFiles(const std::string& relative_folder,
                                             const std::vector<std::string>& extensions = {});

}  // namespace still
