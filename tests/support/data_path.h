#pragma once
// Files for tests: the shared models and images, and folders for files a test writes itself.

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

/// A folder of its own for one test, removed with everything in it at the end.
class TempFolder {
  public:
    TempFolder();
    ~TempFolder();
    TempFolder(const TempFolder&) = delete;
    TempFolder& operator=(const TempFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    /// Writes a file (folders in `name` are made) and returns its path.
    std::filesystem::path write(const std::string& name, const std::string& bytes) const;

  private:
    std::filesystem::path path_;
};

/// Whether an error or warning is one line, not empty, and names the file.
bool isOneLineAbout(const std::string& message, const std::string& file_name);

}  // namespace still
