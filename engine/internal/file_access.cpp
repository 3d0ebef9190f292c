#include "engine/internal/file_access.h"

#include <algorithm>
#include <system_error>

#include "engine/internal/obj_text.h"
#include "engine/read_file.h"

namespace still {
namespace {

namespace fs = std::filesystem;

fs::path orHere(const fs::path& folder) {
    return folder.empty() ? fs::path(".") : folder;
}

/// The path without links and dots, as far as it exists; empty when that cannot be told.
fs::path realPath(const fs::path& path) {
    std::error_code error;
    const fs::path absolute = fs::absolute(path, error);
    if (error) {
        return {};
    }
    const fs::path result = fs::weakly_canonical(absolute, error);
    return error ? fs::path() : result;
}

/// "C:" or "C:name", which is no place of its own here but one elsewhere.
bool namesDrive(const std::string& name) {
    const char letter = name.empty() ? '\0' : char(name[0] | 0x20);
    return name.size() > 1 && letter >= 'a' && letter <= 'z' && name[1] == ':';
}

}  // namespace

FileAccess::FileAccess(const LoadOptions& options, const fs::path& file)
    : root_(realPath(orHere(options.folder.empty() ? file.parent_path() : options.folder))),
      allow_outside_(options.allow_outside) {}

bool FileAccess::holds(const fs::path& file) const {
    const fs::path real = realPath(file);
    return !root_.empty() && !real.empty() &&
           std::mismatch(root_.begin(), root_.end(), real.begin(), real.end()).first == root_.end();
}

bool FileAccess::permits(const fs::path& folder, const std::string& name) const {
    if (name.find('\0') != std::string::npos) {  // the system would read the name only up to there
        return false;
    }
    if (allow_outside_) {
        return true;
    }
    std::string slashes = name;
    std::replace(slashes.begin(), slashes.end(), '\\', '/');
    if (namesDrive(name) && !fs::path(name).is_absolute()) {
        return false;
    }
    return holds(orHere(folder) / name) && holds(orHere(folder) / slashes);
}

Result<fs::path> FileAccess::find(const fs::path& folder, const std::string& name) const {
    if (!permits(folder, name)) {
        return fail("expected a file in the scene's folder, found " + shownText(name) + "; " +
                    kAdvice);
    }
    const fs::path file = folder / name;
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status)) {
        return fail(shownPath(file) + ": is not an ordinary file, expected one");
    }
    return file;
}

}  // namespace still
