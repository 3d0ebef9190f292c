#pragma once
// Loaded OBJ models kept as files between runs. Losing them loses time only: whatever does not fit
// is as good as absent, and nothing here is an error.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "engine/internal/input_log.h"
#include "engine/internal/obj.h"

namespace still {

/// All files of a folder together stay below this; those not used for longest go first.
constexpr uint64_t kModelCacheBytes = uint64_t{2} << 30;

/// The entry of one OBJ file. Several processes may use the same folder.
class ModelCache {
  public:
    /// `folder` is made when it is needed. What `access` permits is part of the entry's name.
    ModelCache(std::filesystem::path folder, const std::filesystem::path& obj,
               const FileAccess& access);

    /// The model, if it was stored by this very program and no file that it was made of, or that
    /// was looked for in vain, has changed since: contents are compared, not dates.
    std::optional<ObjModel> load() const;

    /// Keeps a model that was read through `log`. It appears complete or not at all.
    void store(const ObjModel& model, const InputLog& log) const;

    const std::filesystem::path& file() const { return file_; }

  private:
    std::filesystem::path folder_;
    std::string key_;  ///< ModelOrigin::key
    std::filesystem::path file_;
};

/// Removes the oldest models in the folder until those left take at most `limit` bytes, and what a
/// process that was killed left half-written.
void pruneModels(const std::filesystem::path& folder, uint64_t limit_bytes);

}  // namespace still
