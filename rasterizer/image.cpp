#include "rasterizer/image.h"

#include <cstring>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace still {
namespace {

constexpr std::align_val_t kCacheLine{64};

#if defined(__linux__)
/// From here on a plane is a mapping of its own. Planes of a frame are made one after the other, so
/// their mappings become one, of which the system can make large pages: a first frame of 1080p
/// takes half as long, and later ones miss the translation buffers less often.
constexpr size_t kMappedBytes = size_t{256} << 10;

/// Null when there is no room.
void* mapZeros(size_t bytes) {
    void* memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) {
        return nullptr;
    }
#if defined(MADV_HUGEPAGE)
    madvise(memory, bytes, MADV_HUGEPAGE);  // may be refused: then pages are small
#endif
    return memory;
}
#endif

}  // namespace

PlaneMemory allocateZeros(size_t bytes) {
#if defined(__linux__)
    if (bytes >= kMappedBytes) {
        if (void* memory = mapZeros(bytes)) {
            return {memory, bytes};
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
        munmap(memory.data, memory.mapped_bytes);
        return;
    }
#endif
    ::operator delete(memory.data, kCacheLine);
}

}  // namespace still
