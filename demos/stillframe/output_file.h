#pragma once
// Files that appear complete or not at all: written under a temporary name in the same folder and
// renamed at the end.

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "demos/stillframe/interruption.h"
#include "demos/stillframe/outcome.h"

namespace still::command {

/// "FILE: what: reason", the reason from errno.
std::string systemMessage(const std::filesystem::path& file, const std::string& what);

class OutputFile {
  public:
    /// Opens the temporary file. The folder must exist; what stands at `path`, if anything, must be
    /// an ordinary file. `interruption` must outlive the object.
    static Outcome<OutputFile> create(const std::filesystem::path& path,
                                      Interruption& interruption);
    OutputFile(OutputFile&&) = default;
    OutputFile& operator=(OutputFile&&) = delete;
    /// Removes the temporary file unless commit() has succeeded.
    ~OutputFile();

    std::FILE* stream() const { return stream_.get(); }
    const std::filesystem::path& path() const { return path_; }
    const std::filesystem::path& temporary() const { return temporary_->path; }

    /// Closes and renames; any error of earlier writes shows here at the latest.
    Outcome<void> commit();

  private:
    struct CloseStream {
        void operator()(std::FILE* stream) const { std::fclose(stream); }
    };
    /// Removes the file when it goes.
    struct Temporary {
        std::filesystem::path path;
        Interruption& interruption;
        Temporary(std::filesystem::path path_in, Interruption& interruption_in);
        ~Temporary();
    };
    OutputFile() = default;

    std::filesystem::path path_;
    std::unique_ptr<Temporary> temporary_;
    std::unique_ptr<std::FILE, CloseStream> stream_;
};

}  // namespace still::command
