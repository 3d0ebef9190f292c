#include "demos/stillframe/output_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

namespace still::command {
namespace {

namespace fs = std::filesystem;

constexpr int kNameAttempts = 100;

/// Says early and clearly what rename() would say late.
Outcome<void> checkTarget(const fs::path& path) {
    std::error_code error;
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    if (!fs::is_directory(folder, error)) {
        return fileError(path.string() + ": the folder " + folder.string() + " does not exist");
    }
    if (fs::exists(path, error) && !fs::is_regular_file(path, error)) {
        return fileError(path.string() + ": exists and is not an ordinary file");
    }
    return {};
}

/// A short name of its own, because the final one may be as long as the file system allows.
fs::path temporaryName(const fs::path& path, int attempt) {
    return path.parent_path() /
           (".stillframe-" + std::to_string(getpid()) + "-" + std::to_string(attempt) + ".tmp");
}

}  // namespace

std::string systemMessage(const fs::path& file, const std::string& what) {
    return file.string() + ": " + what + ": " + std::strerror(errno);
}

OutputFile::Temporary::Temporary(fs::path path_in, Interruption& interruption_in)
    : path(std::move(path_in)), interruption(interruption_in) {}

OutputFile::Temporary::~Temporary() {
    std::error_code ignored;
    fs::remove(path, ignored);
    interruption.forgetFile(path);
}

Outcome<OutputFile> OutputFile::create(const fs::path& path, Interruption& interruption) {
    if (auto checked = checkTarget(path); !checked) {
        return tl::make_unexpected(checked.error());
    }
    OutputFile file;
    file.path_ = path;
    for (int attempt = 0; attempt < kNameAttempts && !file.stream_; ++attempt) {
        const fs::path name = temporaryName(path, attempt);
        interruption.addFile(name);  // before it exists, so that no signal falls in between
        const int descriptor = open(name.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
        if (descriptor >= 0) {
            file.temporary_ = std::make_unique<Temporary>(name, interruption);
            file.stream_.reset(fdopen(descriptor, "wb"));
            continue;
        }
        const int reason = errno;
        interruption.forgetFile(name);
        errno = reason;
        if (reason != EEXIST) {
            break;
        }
    }
    if (!file.stream_) {
        return fileError(systemMessage(path, "cannot write"));
    }
    return file;
}

OutputFile::~OutputFile() = default;

Outcome<void> OutputFile::commit() {
    const bool written = std::ferror(stream_.get()) == 0 && std::fflush(stream_.get()) == 0;
    const bool closed = std::fclose(stream_.release()) == 0;
    if (!written || !closed || rename(temporary_->path.c_str(), path_.c_str()) != 0) {
        return fileError(systemMessage(path_, "cannot write"));
    }
    temporary_.reset();
    return {};
}

}  // namespace still::command
