#include "tests/board/counted_memory.h"

#include <cstdlib>
#include <mutex>
#include <new>
#include <optional>

namespace still::test {
namespace {

constexpr size_t kMemoryBytes = size_t{64} << 20;
alignas(64) std::byte memory[kMemoryBytes];
std::optional<Arena> arena;
size_t unmet_requests = 0;
bool paused = false;
std::mutex mutex;  // tests of threads

void* allocate(size_t bytes, size_t alignment) {
    {
        const std::lock_guard lock(mutex);
        if (arena.has_value() && !paused) {
            if (void* const from_arena = arena->allocate(bytes, alignment)) {
                return from_arena;
            }
            ++unmet_requests;
        }
    }
    const size_t aligned = alignment < kArenaAlignment ? kArenaAlignment : alignment;
    void* const from_heap = std::aligned_alloc(aligned, (bytes + aligned) / aligned * aligned);
    if (from_heap == nullptr) {
        std::abort();
    }
    return from_heap;
}

void release(void* pointer) {
    const auto* byte = static_cast<const std::byte*>(pointer);
    if (byte < memory || byte >= memory + kMemoryBytes) {
        std::free(pointer);
    }
}

}  // namespace

ArenaInUse::ArenaInUse(size_t bytes) {
    unmet_requests = 0;
    paused = false;
    arena.emplace(std::span(memory).first(bytes));
}

ArenaInUse::~ArenaInUse() {
    arena.reset();
}

size_t ArenaInUse::used() const {
    return arena->used();
}

void ArenaInUse::seal() {
    arena->seal();
}

void ArenaInUse::pause() {
    paused = true;
}

void ArenaInUse::goOn() {
    paused = false;
}

size_t ArenaInUse::unmet() const {
    return unmet_requests;
}

}  // namespace still::test

void* operator new(size_t bytes) {
    return still::test::allocate(bytes, still::kArenaAlignment);
}
void* operator new[](size_t bytes) {
    return still::test::allocate(bytes, still::kArenaAlignment);
}
void* operator new(size_t bytes, std::align_val_t alignment) {
    return still::test::allocate(bytes, size_t(alignment));
}
void* operator new[](size_t bytes, std::align_val_t alignment) {
    return still::test::allocate(bytes, size_t(alignment));
}
void operator delete(void* pointer) noexcept {
    still::test::release(pointer);
}
void operator delete[](void* pointer) noexcept {
    still::test::release(pointer);
}
void operator delete(void* pointer, size_t) noexcept {
    still::test::release(pointer);
}
void operator delete[](void* pointer, size_t) noexcept {
    still::test::release(pointer);
}
void operator delete(void* pointer, std::align_val_t) noexcept {
    still::test::release(pointer);
}
void operator delete[](void* pointer, std::align_val_t) noexcept {
    still::test::release(pointer);
}
void operator delete(void* pointer, size_t, std::align_val_t) noexcept {
    still::test::release(pointer);
}
void operator delete[](void* pointer, size_t, std::align_val_t) noexcept {
    still::test::release(pointer);
}
