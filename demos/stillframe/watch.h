#pragma once
// Waits until files change, by looking at them a few times a second: works on every file system,
// and for editors that write a new file and rename it.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace still::command {

/// What is known of each file; one that is not there counts, too.
class Watch {
  public:
    /// Files as they are now; those that are watched already stay as they were.
    void add(const std::vector<std::string>& files);
    /// Whether some file is not as it was when it was added or at the last call of this.
    bool changed();
    /// Returns when some file has changed and none has changed since for a moment.
    void wait();

  private:
    struct State {
        bool there = false;
        std::uintmax_t bytes = 0;
        std::filesystem::file_time_type time;
        friend bool operator==(const State&, const State&) = default;
    };
    static State stateOf(const std::string& file);

    std::map<std::string, State> files_;
};

}  // namespace still::command
