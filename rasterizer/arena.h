#pragma once
// Memory for programs without a heap: the caller's bytes, handed out from front to back. Both
// modules take all their memory from operator new; a program that replaces it by an arena, as
// demos/embedded does, decides where everything lies, and how much of it there is.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "rasterizer/image.h"

namespace still {

/// What the operator new of the language aligns to.
constexpr size_t kArenaAlignment = __STDCPP_DEFAULT_NEW_ALIGNMENT__;

/// What `bytes` of this alignment, a power of 2, take of an arena at most: with the gaps before and
/// behind them.
constexpr size_t arenaBytes(size_t bytes, size_t alignment = kArenaAlignment) {
    const size_t gap = alignment > kArenaAlignment ? alignment - kArenaAlignment : 0;
    return gap + (bytes + kArenaAlignment - 1) / kArenaAlignment * kArenaAlignment;
}

/// What a plane takes.
template <class T>
constexpr size_t planeArenaBytes(int width, int height) {
    return arenaBytes(planeElements(width, height) * sizeof(T), kPlaneAlignment);
}

/// Hands its bytes out and never takes them back: for what is made once.
class Arena {
  public:
    /// `memory` begins at a multiple of kArenaAlignment.
    constexpr explicit Arena(std::span<std::byte> memory) : memory_(memory) {}

    /// `alignment` is a power of 2. Null when there is no room, and after seal().
    void* allocate(size_t bytes, size_t alignment) {
        const auto start = reinterpret_cast<uintptr_t>(memory_.data());
        const size_t aligned = alignment < kArenaAlignment ? kArenaAlignment : alignment;
        const size_t from = size_t((start + used_ + aligned - 1) / aligned * aligned - start);
        const size_t taken = arenaBytes(bytes);
        if (sealed_ || taken < bytes || from > memory_.size() || taken > memory_.size() - from) {
            return nullptr;
        }
        used_ = from + taken;
        return memory_.data() + from;
    }

    /// Set-up is over: nothing is handed out any more.
    void seal() { sealed_ = true; }
    bool sealed() const { return sealed_; }

    /// Bytes handed out, gaps included.
    size_t used() const { return used_; }
    size_t size() const { return memory_.size(); }

  private:
    std::span<std::byte> memory_;
    size_t used_ = 0;
    bool sealed_ = false;
};

}  // namespace still
