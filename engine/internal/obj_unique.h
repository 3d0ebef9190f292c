#pragma once
// Numbers equal keys alike, in order of first use.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace still {

/// Open-addressing hash table from keys of N words to 0, 1, 2, … in order of first use. The numbers
/// depend on the sequence of keys only, never on the hash.
template <size_t N>
class UniqueKeys {
  public:
    using Key = std::array<uint32_t, N>;

    explicit UniqueKeys(size_t expected) : slots_(std::bit_ceil(expected * 2 + 16), kFree) {}

    /// The number of `key`, a new one (= size() before the call) when it was not seen before.
    uint32_t numberOf(const Key& key) {
        if (keys_.size() * 2 >= slots_.size()) {
            grow();
        }
        const size_t slot = find(key);
        if (slots_[slot] == kFree) {
            slots_[slot] = uint32_t(keys_.size());
            keys_.push_back(key);
        }
        return slots_[slot];
    }

    size_t size() const { return keys_.size(); }

  private:
    static constexpr uint32_t kFree = UINT32_MAX;

    static size_t hashOf(const Key& key) {
        uint64_t h = 0;
        for (const uint32_t word : key) {
            h = (h ^ word) * 0x9E3779B97F4A7C15u;
            h ^= h >> 29;
        }
        return size_t(h);
    }

    size_t find(const Key& key) const {
        const size_t mask = slots_.size() - 1;
        size_t slot = hashOf(key) & mask;
        while (slots_[slot] != kFree && keys_[slots_[slot]] != key) {
            slot = (slot + 1) & mask;
        }
        return slot;
    }

    void grow() {
        slots_.assign(slots_.size() * 2, kFree);
        for (uint32_t i = 0; i < keys_.size(); ++i) {
            slots_[find(keys_[i])] = i;
        }
    }

    std::vector<uint32_t> slots_;
    std::vector<Key> keys_;
};

}  // namespace still
