#include "demos/stillframe/limits.h"

#include <unistd.h>
#if defined(__linux__)
#include <sys/sysinfo.h>
#endif

#include <algorithm>
#include <charconv>
#include <fstream>
#include <initializer_list>
#include <limits>
#include <string_view>

namespace still::command {
namespace {

constexpr uint64_t kNoLimit = std::numeric_limits<uint64_t>::max();

/// The number in a file; none is no limit, as is the word "max".
uint64_t limitIn(const char* file) {
    uint64_t bytes = 0;
    return std::ifstream(file) >> bytes ? bytes : kNoLimit;
}

/// The power of 1024 that a suffix stands for, in bits; −1 for others.
int bitsOf(std::string_view suffix) {
    constexpr std::string_view kSuffixes = "KMGT";
    if (suffix.empty()) {
        return 0;
    }
    const char upper = char(suffix[0] & ~0x20);
    const size_t at = kSuffixes.find(upper);
    return suffix.size() > 1 || at == std::string_view::npos ? -1 : 10 * (int(at) + 1);
}

/// With swap, where that is known.
uint64_t installedBytes() {
#if defined(__linux__)
    struct sysinfo machine {};
    if (sysinfo(&machine) == 0) {
        return (uint64_t(machine.totalram) + machine.totalswap) * machine.mem_unit;
    }
#endif
    const long pages = sysconf(_SC_PHYS_PAGES), page_bytes = sysconf(_SC_PAGE_SIZE);
    return pages > 0 && page_bytes > 0 ? uint64_t(pages) * uint64_t(page_bytes) : kNoLimit;
}

}  // namespace

uint64_t machineMemoryBytes() {
    uint64_t bytes = installedBytes();
    // Of a container, version 2 and 1.
    for (const char* file :
         {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"}) {
        bytes = std::min(bytes, limitIn(file));
    }
    return bytes;
}

Outcome<uint64_t> parseBytes(const std::string& text) {
    constexpr double kLeast = 1 << 20, kMost = double(uint64_t{1} << 50);
    const char* const end = text.data() + text.size();
    double number = 0;
    const auto [stop, error] = std::from_chars(text.data(), end, number, std::chars_format::fixed);
    const int bits = error == std::errc() ? bitsOf({stop, size_t(end - stop)}) : -1;
    const double bytes = bits < 0 ? 0 : number * double(uint64_t{1} << bits);
    if (!(bytes >= kLeast && bytes <= kMost)) {
        return usageError("--max-memory: " + text +
                          ": expected bytes, or a number with K, M, G or T, at least 1M");
    }
    return uint64_t(bytes);
}

LoadOptions loadOptions(const Limits& limits, const std::filesystem::path& cache_folder) {
    return {.cache_folder = cache_folder,
            .allow_outside = limits.allow_outside,
            .folder = {},
            .max_memory_bytes = limits.max_memory_bytes};
}

}  // namespace still::command
