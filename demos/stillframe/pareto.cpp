#include "demos/stillframe/pareto.h"

#include <algorithm>
#include <tuple>

namespace still::command {
namespace {

bool beats(const Offer& a, const Offer& b, double tolerance) {
    const bool dearer = a.price > b.price * (1 + tolerance);
    const bool cheaper = a.price * (1 + tolerance) < b.price;
    return !dearer && a.error <= b.error && (cheaper || a.error < b.error);
}

}  // namespace

std::vector<size_t> paretoFront(std::span<const Offer> offers, double tolerance) {
    std::vector<size_t> front;
    for (size_t i = 0; i < offers.size(); ++i) {
        const bool beaten = std::any_of(offers.begin(), offers.end(), [&](const Offer& other) {
            return beats(other, offers[i], tolerance);
        });
        if (!beaten) {
            front.push_back(i);
        }
    }
    std::sort(front.begin(), front.end(), [&](size_t a, size_t b) {
        return std::tuple(offers[a].price, a) < std::tuple(offers[b].price, b);
    });
    return front;
}

}  // namespace still::command
