#include "demos/stillframe/pareto.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

namespace still::command {

std::vector<size_t> paretoFront(std::span<const Offer> offers) {
    std::vector<size_t> order(offers.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::sort(order.begin(), order.end(), [&](size_t a, size_t b) {
        return std::tuple(offers[a].price, offers[a].error, a) <
               std::tuple(offers[b].price, offers[b].error, b);
    });
    std::vector<size_t> front;
    Offer last{0, std::numeric_limits<double>::infinity()};
    for (size_t i : order) {
        const Offer& offer = offers[i];
        const bool equal = offer.error == last.error && offer.price == last.price;
        if (offer.error < last.error || (equal && !front.empty())) {
            front.push_back(i);
            last = offer;
        }
    }
    return front;
}

}  // namespace still::command
