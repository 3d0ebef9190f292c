#include "tests/support/data_path.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <random>
#include <system_error>

namespace still {

std::filesystem::path dataFolder() {
    std::error_code error;
    const char* given = std::getenv("STILL_DATA");
    const std::filesystem::path folder =
        given != nullptr ? std::filesystem::path(given)
                         : std::filesystem::path(STILL_SOURCE_DIR) / ".." / "shared" / "data";
    return std::filesystem::is_directory(folder, error) ? folder : std::filesystem::path();
}

std::filesystem::path dataFile(const std::string& relative) {
    const std::filesystem::path folder = dataFolder();
    std::error_code error;
    if (!folder.empty() && std::filesystem::exists(folder / relative, error)) {
        return folder / relative;
    }
    WARN("skipped: " << relative << " is not there (set STILL_DATA)");
    return {};
}

std::vector<std::filesystem::path> dataFiles(const std::string& relative_folder,
                                             const std::vector<std::string>& extensions) {
    std::vector<std::filesystem::path> files;
    const std::filesystem::path folder = dataFile(relative_folder);
    if (folder.empty()) {
        return files;
    }
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        const std::string extension = entry.path().extension().string();
        const bool wanted = extensions.empty() || std::find(extensions.begin(), extensions.end(),
                                                            extension) != extensions.end();
        if (entry.is_regular_file() && wanted) {
            files.push_back(entry.path());
        }
    }
    std::sort(files.begin(), files.end());
    return files;
}

TempFolder::TempFolder() {
    std::random_device random;
    path_ = std::filesystem::temp_directory_path() /
            ("stillframe-test-" + std::to_string(random()) + "-" + std::to_string(random()));
    std::filesystem::create_directories(path_);
}

TempFolder::~TempFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
}

std::filesystem::path TempFolder::write(const std::string& name, const std::string& bytes) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
    return file;
}

bool isOneLineAbout(const std::string& message, const std::string& file_name) {
    return !message.empty() && message.find_first_of("\n\r") == std::string::npos &&
           message.find(file_name) != std::string::npos;
}

}  // namespace still
