#pragma once
// Properties that hold for every random picture: seeds that are printed and can be played again,
// and a small picture to look at when one fails.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tests/support/minimize.h"

namespace still::test {

/// `count` seeds from `first` on; from the environment variable STILL_SEED on when it is set, one
/// unless STILL_SEEDS says how many.
std::vector<uint64_t> seeds(uint64_t first, int count);

/// Empty when `check` finds nothing wrong with the case that `make` makes of any of the seeds. Else
/// the first seed, what is wrong, how to play it again, and the minimised case as code.
std::string counterexample(const std::vector<uint64_t>& seeds,
                           const std::function<DrawCase(uint64_t seed)>& make,
                           const DrawCheck& check);

}  // namespace still::test
