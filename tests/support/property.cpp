#include "tests/support/property.h"

#include <cstdlib>
#include <numeric>

namespace still::test {

std::vector<uint64_t> seeds(uint64_t first, int count) {
    if (const char* given = std::getenv("STILL_SEED")) {
        const char* given_count = std::getenv("STILL_SEEDS");
        first = std::strtoull(given, nullptr, 10);
        count = given_count == nullptr ? 1 : std::max(1, std::atoi(given_count));
    }
    std::vector<uint64_t> all(size_t(count), 0);
    std::iota(all.begin(), all.end(), first);
    return all;
}

std::string counterexample(const std::vector<uint64_t>& seeds,
                           const std::function<DrawCase(uint64_t seed)>& make,
                           const DrawCheck& check) {
    for (const uint64_t seed : seeds) {
        DrawCase found = make(seed);
        const std::string wrong = check(found);
        if (!wrong.empty()) {
            DrawCase small = minimized(std::move(found), check);
            return "seed " + std::to_string(seed) + ": " + wrong +
                   "\nagain: the same test with STILL_SEED=" + std::to_string(seed) +
                   "\nthe smallest case found, in which " + check(small) + ":\n" + asCode(small);
        }
    }
    return {};
}

}  // namespace still::test
