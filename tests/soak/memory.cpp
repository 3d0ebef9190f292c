#include "tests/soak/memory.h"

#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

#if defined(__has_feature)
#define STILL_HAS_FEATURE(feature) __has_feature(feature)
#else
#define STILL_HAS_FEATURE(feature) 0
#endif
/// Sanitizers watch over memory by themselves, and keep what was freed.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || \
    STILL_HAS_FEATURE(address_sanitizer) || STILL_HAS_FEATURE(thread_sanitizer)
#define STILL_COUNTS_MEMORY 0
#else
#define STILL_COUNTS_MEMORY 1
#endif

#if STILL_COUNTS_MEMORY
namespace still::soak {
namespace {

std::atomic<int64_t> live_bytes{0};

/// The size that was asked for stands before the memory, so that the count is exact.
constexpr size_t kUnit = __STDCPP_DEFAULT_NEW_ALIGNMENT__;

void* allocate(size_t bytes, size_t alignment) {
    const size_t whole = alignment + (bytes + alignment - 1) / alignment * alignment;
    auto* memory = static_cast<char*>(std::aligned_alloc(alignment, whole));
    if (memory == nullptr) {
        throw std::bad_alloc();
    }
    std::memcpy(memory + alignment - sizeof(bytes), &bytes, sizeof(bytes));
    live_bytes += int64_t(bytes);
    return memory + alignment;
}

void release(void* memory, size_t alignment) {
    if (memory == nullptr) {
        return;
    }
    size_t bytes = 0;
    std::memcpy(&bytes, static_cast<char*>(memory) - sizeof(bytes), sizeof(bytes));
    live_bytes -= int64_t(bytes);
    std::free(static_cast<char*>(memory) - alignment);
}

}  // namespace

int64_t liveBytes() {
    return live_bytes;
}

int64_t residentBytes() {
    long pages = 0, resident = 0;
    if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
        if (std::fscanf(file, "%ld %ld", &pages, &resident) != 2) {
            resident = 0;
        }
        std::fclose(file);
    }
    return int64_t{resident} * sysconf(_SC_PAGESIZE);
}

}  // namespace still::soak

void* operator new(size_t bytes) {
    return still::soak::allocate(bytes, still::soak::kUnit);
}
void* operator new(size_t bytes, std::align_val_t alignment) {
    return still::soak::allocate(bytes, size_t(alignment));
}
void operator delete(void* memory) noexcept {
    still::soak::release(memory, still::soak::kUnit);
}
void operator delete(void* memory, size_t) noexcept {
    still::soak::release(memory, still::soak::kUnit);
}
void operator delete(void* memory, std::align_val_t alignment) noexcept {
    still::soak::release(memory, size_t(alignment));
}
void operator delete(void* memory, size_t, std::align_val_t alignment) noexcept {
    still::soak::release(memory, size_t(alignment));
}

#else

namespace still::soak {

int64_t liveBytes() {
    return 0;
}
int64_t residentBytes() {
    return 0;
}

}  // namespace still::soak

#endif
