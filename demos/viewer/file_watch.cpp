#include "demos/viewer/file_watch.h"

#include <algorithm>
#include <system_error>

#include "demos/scenes/builtin.h"

namespace still::viewer {
namespace {

namespace fs = std::filesystem;
constexpr const char* kBuiltin = "builtin:";

bool isSceneFile(const fs::directory_entry& entry) {
    std::string extension = entry.path().extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
    std::error_code error;
    return (extension == ".obj" || extension == ".json") && entry.is_regular_file(error);
}

}  // namespace

std::vector<FileWatch::State> FileWatch::look() const {
    std::vector<State> states;
    for (const std::string& file : files_) {
        State& state = states.emplace_back();
        std::error_code error;
        state.present = fs::is_regular_file(file, error);
        if (state.present) {
            state.time = fs::last_write_time(file, error);
            state.bytes = fs::file_size(file, error);
        }
    }
    return states;
}

void FileWatch::watch(std::vector<std::string> files) {
    std::sort(files.begin(), files.end());
    files.erase(std::unique(files.begin(), files.end()), files.end());
    files_ = std::move(files);
    known_ = last_ = look();
}

bool FileWatch::poll() {
    std::vector<State> now = look();
    const bool settled = now == last_;
    last_ = std::move(now);
    if (!settled || last_ == known_) {
        return false;
    }
    known_ = last_;
    return true;
}

std::vector<std::string> neighboursOf(const std::string& scene) {
    std::vector<std::string> names;
    if (scene.starts_with(kBuiltin)) {
        for (const std::string& name : builtinSceneNames()) {
            names.push_back(kBuiltin + name);
        }
    } else {
        const fs::path folder = fs::path(scene).parent_path();
        std::error_code error;
        for (const fs::directory_entry& entry :
             fs::directory_iterator(folder.empty() ? "." : folder, error)) {
            if (isSceneFile(entry)) {
                names.push_back((folder / entry.path().filename()).string());
            }
        }
        std::sort(names.begin(), names.end());
    }
    if (std::find(names.begin(), names.end(), scene) == names.end()) {
        names.push_back(scene);
    }
    return names;
}

}  // namespace still::viewer
