#pragma once
// Which of several offers nobody beats in both price and error.

#include <cstddef>
#include <span>
#include <vector>

namespace still::command {

struct Offer {
    double price = 0;
    double error = 0;
};

/// Indices of the offers that no other one beats; by price, then by index. Prices that differ by at
/// most `tolerance` (0.03 = 3 %) count as equal, because they are measured. An offer is beaten by
/// one that is not dearer and not farther off, and better in one of the two; of equal offers all
/// stay.
std::vector<size_t> paretoFront(std::span<const Offer> offers, double tolerance = 0);

}  // namespace still::command
