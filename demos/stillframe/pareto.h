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

/// Indices of the offers of which no other one is at most as dear and at most as far off, and
/// better in one of the two; by price, then by index. Of equal offers all are on the front.
std::vector<size_t> paretoFront(std::span<const Offer> offers);

}  // namespace still::command
