#pragma once
// What the fuzz targets share. A target is LLVMFuzzerTestOneInput(): any bytes in, and no crash, no
// undefined behaviour, no broken promise.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

namespace still::fuzz {

/// Ends the program with `what`, in every kind of build, unless `holds`.
void require(bool holds, std::string_view what);

/// Takes values off the front of an input. There is always a next one: zeros behind the end.
class Bytes {
  public:
    explicit Bytes(std::span<const uint8_t> bytes) : bytes_(bytes) {}

    bool empty() const { return bytes_.empty(); }
    uint8_t byte();
    uint32_t word();
    /// 0 … bound − 1
    int below(int bound);
    bool flag() { return (byte() & 1) != 0; }
    /// Half of the time a number that geometry is made of, else one that arithmetic stumbles over,
    /// or any bits at all.
    float real();

  private:
    std::span<const uint8_t> bytes_;
};

/// The same small numbers for the same bytes.
uint64_t hashOf(std::span<const uint8_t> bytes);

inline std::string_view textOf(std::span<const uint8_t> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// A folder of this process, in memory where the system has such, that goes with it. It holds the
/// files that corpora name: quad.obj, quad.mtl, tile.png, cameras.json.
const std::filesystem::path& scratchFolder();
void writeScratch(std::string_view name, std::string_view text);

}  // namespace still::fuzz
