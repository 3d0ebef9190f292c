#pragma once
// Results that are dear to make, kept as files between runs. Losing the folder loses time only.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "demos/stillframe/interruption.h"
#include "demos/stillframe/outcome.h"

namespace still::command {

/// 64-bit hash of bytes, in which a key of the cache is made of all that decides a result.
uint64_t hashBytes(std::string_view bytes);

/// Hash of the running program's file: another build, another number. 0 when it cannot be read.
uint64_t programHash();

/// $XDG_CACHE_HOME/stillframe, or ~/.cache/stillframe, which need not be there; empty when neither
/// variable is set.
std::filesystem::path usersCacheFolder();

/// May be used by several threads, and by several processes in the same folder.
class FileCache {
  public:
    /// `folder`, or usersCacheFolder() when that is empty; made when it is not there.
    /// `interruption` must outlive the cache.
    static Outcome<FileCache> open(const std::string& folder, Interruption& interruption);

    /// What was stored under the key; nothing when there is no such entry or it is damaged.
    std::optional<std::string> load(uint64_t key) const;
    /// An entry appears complete or not at all.
    Outcome<void> store(uint64_t key, std::string_view bytes) const;

  private:
    FileCache(std::filesystem::path folder, Interruption& interruption);
    std::filesystem::path pathOf(uint64_t key) const;

    std::filesystem::path folder_;
    Interruption* interruption_;
    /// An OutputFile's temporary name is only safe from other processes.
    std::unique_ptr<std::mutex> storing_ = std::make_unique<std::mutex>();
};

/// Makes a folder and those above it.
Outcome<void> makeFolder(const std::filesystem::path& folder);

}  // namespace still::command
