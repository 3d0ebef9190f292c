#pragma once
// What is reported of repeated measurements.

#include <algorithm>
#include <cstddef>
#include <vector>

namespace still::command {

struct Statistics {
    double min = 0, median = 0, p95 = 0;
};

/// Nearest rank for the 95th percentile; the median of an even number is the mean of the middle
/// two. `values` is not empty.
inline Statistics statisticsOf(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const size_t count = values.size();
    return {values[0], (values[(count - 1) / 2] + values[count / 2]) / 2,
            values[(count * 95 + 99) / 100 - 1]};
}

}  // namespace still::command
