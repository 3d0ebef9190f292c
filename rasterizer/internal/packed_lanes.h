#pragma once
// Moving the lanes of a mask to the front.

#include <array>
#include <cstddef>
#include <cstdint>

namespace still::internal {

/// For each set of up to 8 lanes their numbers in order.
constexpr std::array<std::array<uint8_t, 8>, 256> kPackedLanes = [] {
    std::array<std::array<uint8_t, 8>, 256> table{};
    for (size_t set = 0; set < table.size(); ++set) {
        size_t count = 0;
        for (uint8_t lane = 0; lane < 8; ++lane) {
            if ((set >> lane & 1) != 0) {
                table[set][count++] = lane;
            }
        }
    }
    return table;
}();

}  // namespace still::internal
