#include "engine/read_file.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <limits>
#include <system_error>

namespace still {

Result<std::string> readFile(const std::filesystem::path& file) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(file, error);
    if (!std::filesystem::exists(status)) {
        return fail(shownPath(file) + ": no such file");
    }
    if (std::filesystem::is_directory(status)) {
        return fail(shownPath(file) + ": is a folder, expected a file");
    }
    std::ifstream stream(file, std::ios::binary);
    if (!stream) {
        return fail(shownPath(file) + ": cannot be opened for reading");
    }
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    std::string bytes;
    if (!error) {
        if (size > std::uintmax_t(std::numeric_limits<int>::max())) {
            return fail(shownPath(file) + ": larger than 2 GiB, expected a smaller file");
        }
        bytes.reserve(size_t(size) + 1);  // normaliseLines() adds one
        bytes.resize(size_t(size));
        stream.read(bytes.data(), std::streamsize(size));
        bytes.resize(size_t(stream.gcount()));
        if (stream.bad() || bytes.size() != size) {
            return fail(shownPath(file) + ": cannot be read");
        }
        return bytes;
    }
    bytes.assign(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
    return bytes;
}

std::string shownPath(const std::filesystem::path& file) {
    std::string text = file.string();
    std::replace_if(
        text.begin(), text.end(), [](char c) { return uint8_t(c) < 32 || c == 127; }, '?');
    return text;
}

}  // namespace still
