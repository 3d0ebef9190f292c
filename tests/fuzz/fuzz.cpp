#include "tests/fuzz/fuzz.h"

#include <unistd.h>

#include <array>
#include <bit>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>
#include <system_error>

namespace still::fuzz {

namespace {

constexpr std::string_view kQuadObj =
    "mtllib quad.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "vn 0 0 1\nusemtl grey\nf 1/1/1 2/2/1 3/3/1 4/4/1\n";
constexpr std::string_view kQuadMtl = "newmtl grey\nKd 0.5 0.5 0.5\nmap_Kd tile.png\n";
constexpr std::string_view kCameras =
    "{\"width\":32,\"height\":18,\"frames\":[{\"view\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,-4,1],"
    "\"proj\":[1,0,0,0,0,1.7,0,0,0,0,-1.002,-1,0,0,-0.2,0]}]}";
/// A grey 2 × 2 TGA does where a decoder goes by contents.
constexpr std::array<uint8_t, 22> kTile{0, 0, 3, 0, 0, 0, 0, 0, 0,  0,   0,
                                        0, 2, 0, 2, 0, 8, 0, 9, 90, 180, 255};

class ScratchFolder {
  public:
    ScratchFolder() {
        std::error_code error;
        const std::filesystem::path memory = "/dev/shm";
        const auto base = std::filesystem::is_directory(memory, error)
                              ? memory
                              : std::filesystem::temp_directory_path();
        std::string name = (base / "stillframe-fuzz-XXXXXX").string();
        require(mkdtemp(name.data()) != nullptr, "a folder for files");
        path = name;
    }
    ~ScratchFolder() {
        std::error_code error;
        std::filesystem::remove_all(path, error);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    void write(std::string_view name, std::string_view text) const {
        std::ofstream(path / name, std::ios::binary) << text;
    }

    std::filesystem::path path;
};

const ScratchFolder& folder() {
    static const ScratchFolder made;
    static const bool filled = [] {
        made.write("quad.obj", kQuadObj);
        made.write("quad.mtl", kQuadMtl);
        made.write("cameras.json", kCameras);
        made.write("tile.png", textOf(kTile));
        return true;
    }();
    static_cast<void>(filled);
    return made;
}

}  // namespace

void require(bool holds, std::string_view what) {
    if (!holds) {
        std::fprintf(stderr, "broken promise: %.*s\n", int(what.size()), what.data());
        std::abort();
    }
}

uint8_t Bytes::byte() {
    if (bytes_.empty()) {
        return 0;
    }
    const uint8_t first = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return first;
}

uint32_t Bytes::word() {
    uint32_t value = 0;
    for (int i = 0; i < 4; ++i) {
        value |= uint32_t{byte()} << (8 * i);
    }
    return value;
}

int Bytes::below(int bound) {
    const uint32_t value = bound <= 256 ? byte() : uint32_t{byte()} << 8 | byte();
    return int(value % uint32_t(bound));
}

float Bytes::real() {
    using Limits = std::numeric_limits<float>;
    constexpr std::array kHard{0.0f,
                               -0.0f,
                               1.0f,
                               -1.0f,
                               0.5f,
                               1e-20f,
                               1e-30f,
                               -1e-45f,
                               65536.0f,
                               1e9f,
                               -1e9f,
                               1e18f,
                               -1e18f,
                               Limits::max(),
                               Limits::lowest(),
                               Limits::infinity(),
                               -Limits::infinity(),
                               Limits::quiet_NaN()};
    const uint8_t kind = byte();
    if (kind < 0xA0) {
        return float(int(byte()) - 128) / 64.0f;
    }
    if (kind < 0xC0) {
        return float(int(byte()) - 128) * 4.0f;
    }
    return kind < 0xE0 ? kHard[kind % kHard.size()] : std::bit_cast<float>(word());
}

uint64_t hashOf(std::span<const uint8_t> bytes) {
    uint64_t hash = 0xCBF29CE484222325u;  // FNV-1a
    for (const uint8_t byte : bytes) {
        hash = (hash ^ byte) * 0x100000001B3u;
    }
    return hash ^ hash >> 32;
}

const std::filesystem::path& scratchFolder() {
    return folder().path;
}

void writeScratch(std::string_view name, std::string_view text) {
    folder().write(name, text);
}

}  // namespace still::fuzz
