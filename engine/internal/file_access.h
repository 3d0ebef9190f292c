#pragma once
// Which files a scene may read: those in its folder, and others only where that was asked for.

#include <filesystem>
#include <string>

#include "engine/load.h"
#include "engine/result.h"

namespace still {

/// Judges names that stand in files. What people type is theirs to decide and is not asked about.
class FileAccess {
  public:
    /// Permits everything.
    FileAccess() : allow_outside_(true) {}
    /// Of what `file` names: the folder that counts is `options.folder`, or that of `file`.
    FileAccess(const LoadOptions& options, const std::filesystem::path& file);

    /// Whether `folder` / `name` lies in the scene's folder, symbolic links followed. A name is
    /// read as every system would: "..\x" leads out everywhere, and so does "C:\x" unless that is
    /// in the folder.
    bool permits(const std::filesystem::path& folder, const std::string& name) const;

    /// `folder` / `name` if it is permitted and an ordinary file or absent; opening a pipe would
    /// wait for ever. The error does not say where `name` stands.
    Result<std::filesystem::path> find(const std::filesystem::path& folder,
                                       const std::string& name) const;

    /// Tells apart what different answers can follow from.
    std::string key() const { return allow_outside_ ? "*" : root_.string(); }

    /// The end of messages about what is not permitted.
    static constexpr const char* kAdvice = "--allow-outside permits others";

  private:
    bool holds(const std::filesystem::path& file) const;

    std::filesystem::path root_;  ///< without links
    bool allow_outside_ = false;
};

}  // namespace still
