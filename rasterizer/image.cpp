#include "rasterizer/image.h"

#include <cstring>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace still {
namespace {

constexpr std::align_val_t kCacheLine{kPlaneAlignment};

#if defined(__linux__)
/// From here on a plane is a mapping of its own. Planes of a frame are made one after the other, so
/// their mappings become one, of which the system can make large pages: a first frame of 1080p
/// takes half as long, and later ones miss the translation buffers less often.
constexpr size_t kMappedBytes = size_t{256} << 10;

constexpr size_t kPageBytes = 4096;

/// Where in its first page a plane starts. Planes are read side by side; starting alike, they would
/// compete for the same few sets of the caches (gather of 1080p: 4 % slower). By the golden ratio
/// pages that follow one another get starts far apart.
size_t startOf(const void* mapping) {
    const uint64_t page = reinterpret_cast<uintptr_t>(mapping) / kPageBytes;
    return size_t((page * 0x9E3779B97F4A7C15u) >> 58) * 64;
}

/// No data when there is no room.
PlaneMemory mapZeros(size_t bytes) {
    const size_t mapped_bytes = bytes + kPageBytes;
    void* mapping =
        mmap(nullptr, mapped_bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (mapping == MAP_FAILED) {
        return {};
    }
#if defined(MADV_HUGEPAGE)
    madvise(mapping, mapped_bytes, MADV_HUGEPAGE);  // may be refused: then pages are small
#endif
    return {static_cast<char*>(mapping) + startOf(mapping), mapped_bytes};
}
#endif

}  // namespace

PlaneMemory allocateZeros(size_t bytes) {
#if defined(__linux__)
    if (bytes >= kMappedBytes) {
        if (const PlaneMemory memory = mapZeros(bytes); memory.data != nullptr) {
            return memory;
        }
    }
#endif
    void* memory = ::operator new(bytes, kCacheLine);
    std::memset(memory, 0, bytes);
    return {memory, 0};
}

void freePlane(PlaneMemory memory) {
#if defined(__linux__)
    if (memory.mapped_bytes > 0) {
        char* data = static_cast<char*>(memory.data);
        munmap(data - reinterpret_cast<uintptr_t>(data) % kPageBytes, memory.mapped_bytes);
        return;
    }
#endif
    ::operator delete(memory.data, kCacheLine);
}

}  // namespace still
