#include "engine/internal/input_log.h"

#include <fstream>
#include <string_view>

#include "engine/hash.h"
#include "engine/internal/obj_text.h"

namespace still {

namespace {

/// Fits the second-level cache, so that bytes are hashed before they leave it.
constexpr size_t kPieceBytes = size_t{256} << 10;

/// As inspect() does it, so that it comes to the same.
uint64_t hashInPieces(std::string_view bytes) {
    uint64_t hash = 0;
    for (size_t at = 0; at < bytes.size(); at += kPieceBytes) {
        hash = hashBytes(bytes.substr(at, kPieceBytes), hash);
    }
    return hash;
}

}  // namespace

Input inspect(const std::filesystem::path& file) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) {  // opening a pipe would wait for ever
        return {};
    }
    std::ifstream stream(file, std::ios::binary);
    Input input{.present = stream ? 1u : 0u, .bytes = 0, .hash = 0};
    std::string piece(kPieceBytes, '\0');
    while (stream) {
        stream.read(piece.data(), std::streamsize(piece.size()));
        const size_t count = size_t(stream.gcount());
        if (count > 0) {
            input.hash = hashBytes({piece.data(), count}, input.hash);
        }
        input.bytes += count;
    }
    return stream.bad() ? Input{} : input;
}

void InputLog::note(const std::filesystem::path& file, const Input& input) {
    const std::lock_guard lock(mutex_);
    inputs_.insert_or_assign(file.string(), input);
}

bool InputLog::isFile(const std::filesystem::path& file) {
    std::error_code error;
    const bool present = std::filesystem::is_regular_file(file, error);
    if (!present) {
        note(file, {});
    }
    return present;
}

Result<std::string> InputLog::read(const std::filesystem::path& file) {
    Result<std::string> bytes = readFile(file);
    note(file, bytes ? Input{1, bytes->size(), hashInPieces(*bytes)} : Input{});
    return bytes;
}

std::vector<InputLog::Entry> InputLog::entries() const {
    std::vector<Entry> entries;
    for (const auto& [file, input] : inputs_) {
        entries.push_back({file, input});
    }
    return entries;
}

}  // namespace still
