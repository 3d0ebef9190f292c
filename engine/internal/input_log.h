#pragma once
// What a loader has read and looked for: all that decides its result besides the program.

#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "engine/result.h"

namespace still {

/// One file name that was asked for.
struct Input {
    uint64_t present = 0;  ///< 1, or 0: looked for, and there is no such file
    uint64_t bytes = 0;
    uint64_t hash = 0;  ///< of the contents
    friend bool operator==(const Input&, const Input&) = default;
};

/// The input as it is now: contents are hashed in pieces, not kept. A file that cannot be read is
/// not present.
Input inspect(const std::filesystem::path& file);

/// Answers a loader's questions about files and takes notes. May be used by several threads.
class InputLog {
  public:
    bool isFile(const std::filesystem::path& file);
    /// readFile().
    Result<std::string> read(const std::filesystem::path& file);

    struct Entry {
        std::string file;
        Input input;
    };
    /// In order of the names.
    std::vector<Entry> entries() const;

  private:
    void note(const std::filesystem::path& file, const Input& input);

    std::mutex mutex_;
    std::map<std::string, Input> inputs_;
};

}  // namespace still
