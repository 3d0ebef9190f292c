#include "memory.h"

#include <new>

#include "platform.h"
#include "spinner.h"

namespace spin {
namespace {

#if STILL_BOARD
constexpr size_t kSpareBytes = 0;
#else
constexpr size_t kSpareBytes = 256 << 10;  // what the desktop's libraries and threads ask for
#endif

alignas(64) std::byte bytes[kArenaBytes + kSpareBytes];
constinit still::Arena the_arena{bytes};

void* allocate(size_t size, size_t alignment) {
    void* memory = the_arena.allocate(size, alignment);
    if (memory == nullptr) {
        fail(the_arena.sealed() ? "memory was asked for after set-up" : "the arena is too small");
    }
    return memory;
}

}  // namespace

void sealArena() {
    the_arena.seal();
}

const still::Arena& arena() {
    return the_arena;
}

}  // namespace spin

void* operator new(size_t size) {
    return spin::allocate(size, still::kArenaAlignment);
}
void* operator new[](size_t size) {
    return spin::allocate(size, still::kArenaAlignment);
}
void* operator new(size_t size, std::align_val_t alignment) {
    return spin::allocate(size, size_t(alignment));
}
void* operator new[](size_t size, std::align_val_t alignment) {
    return spin::allocate(size, size_t(alignment));
}
void operator delete(void*) noexcept {}
void operator delete[](void*) noexcept {}
void operator delete(void*, size_t) noexcept {}
void operator delete[](void*, size_t) noexcept {}
void operator delete(void*, std::align_val_t) noexcept {}
void operator delete[](void*, std::align_val_t) noexcept {}
void operator delete(void*, size_t, std::align_val_t) noexcept {}
void operator delete[](void*, size_t, std::align_val_t) noexcept {}
