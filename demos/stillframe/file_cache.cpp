#include "demos/stillframe/file_cache.h"

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <system_error>

#include "demos/stillframe/output_file.h"
#include "engine/hash.h"

namespace still::command {
namespace {

namespace fs = std::filesystem;

/// An entry is this many hexadecimal digits, the hash of the rest, then the rest.
constexpr size_t kDigits = 16;

std::optional<std::string> wholeFile(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) {
        return std::nullopt;
    }
    std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    return stream.bad() ? std::nullopt : std::optional(std::move(bytes));
}

std::string environment(const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr ? value : "";
}

}  // namespace

uint64_t hashBytes(std::string_view bytes) {
    const auto* data = reinterpret_cast<const uint8_t*>(bytes.data());
    const int count = int(bytes.size());
    return hashPlane(ImageView<const uint8_t>{data, count, 1, count});
}

uint64_t programHash() {
    const auto bytes = wholeFile("/proc/self/exe");
    return bytes ? hashBytes(*bytes) : 0;
}

fs::path usersCacheFolder() {
    // The XDG base directory specification ignores relative paths.
    if (const fs::path xdg = environment("XDG_CACHE_HOME"); xdg.is_absolute()) {
        return xdg / "stillframe";
    }
    if (const fs::path home = environment("HOME"); home.is_absolute()) {
        return home / ".cache" / "stillframe";
    }
    return {};
}

FileCache::FileCache(fs::path folder, Interruption& interruption)
    : folder_(std::move(folder)), interruption_(&interruption) {}

Outcome<FileCache> FileCache::open(const std::string& folder, Interruption& interruption) {
    const fs::path path = folder.empty() ? usersCacheFolder() : fs::path(folder);
    if (path.empty()) {
        return usageError(
            "--cache: expected a folder, because neither XDG_CACHE_HOME nor HOME is set");
    }
    return makeFolder(path).map([&] { return FileCache(path, interruption); });
}

fs::path FileCache::pathOf(uint64_t key) const {
    return folder_ / (hex(key) + ".entry");
}

std::optional<std::string> FileCache::load(uint64_t key) const {
    auto bytes = wholeFile(pathOf(key));
    if (!bytes || bytes->size() < kDigits) {
        return std::nullopt;
    }
    std::string content = bytes->substr(kDigits);
    if (hex(hashBytes(content)) != bytes->substr(0, kDigits)) {
        return std::nullopt;
    }
    return content;
}

Outcome<void> FileCache::store(uint64_t key, std::string_view bytes) const {
    const std::lock_guard lock(*storing_);
    return OutputFile::create(pathOf(key), *interruption_).and_then([&](OutputFile file) {
        const std::string digits = hex(hashBytes(bytes));
        std::fwrite(digits.data(), 1, digits.size(), file.stream());
        std::fwrite(bytes.data(), 1, bytes.size(), file.stream());
        return file.commit();
    });
}

Outcome<void> makeFolder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    std::error_code ignored;
    if (!fs::is_directory(folder, ignored)) {
        const std::string reason = error ? error.message() : "it is not a folder";
        return fileError(folder.string() + ": cannot make the folder: " + reason);
    }
    return {};
}

}  // namespace still::command
