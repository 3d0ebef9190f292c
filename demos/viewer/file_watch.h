#pragma once
// Whether files have changed on disk.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace still::viewer {

/// Asks for dates and sizes; the contents are not read.
class FileWatch {
  public:
    /// From now on these, as they are now. Names may be of files that do not exist.
    void watch(std::vector<std::string> files);

    /// True once after a file has changed, appeared or gone, as soon as nothing has changed since
    /// the call before: who writes a file has had time to finish.
    bool poll();

  private:
    struct State {
        bool present = false;
        std::filesystem::file_time_type time{};
        uintmax_t bytes = 0;
        friend bool operator==(const State&, const State&) = default;
    };
    std::vector<State> look() const;

    std::vector<std::string> files_;
    std::vector<State> known_, last_;
};

/// Scene files (OBJ, JSON) of the file's folder in the order of their names, and the file itself;
/// for "builtin:NAME" the built-in scenes.
std::vector<std::string> neighboursOf(const std::string& scene);

}  // namespace still::viewer
