#pragma once
// What a loader has read and looked for: all that decides its result besides the program.

#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "engine/internal/file_access.h"
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
    /// Every file may be read.
    InputLog() = default;
    /// Files that `file` may name.
    InputLog(const LoadOptions& options, const std::filesystem::path& file)
        : access_(options, file), max_memory_bytes_(options.max_memory_bytes) {}

    const FileAccess& access() const { return access_; }
    uint64_t maxMemoryBytes() const { return max_memory_bytes_; }

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

    FileAccess access_;
    uint64_t max_memory_bytes_ = std::numeric_limits<uint64_t>::max();
    std::mutex mutex_;
    std::map<std::string, Input> inputs_;
};

}  // namespace still
