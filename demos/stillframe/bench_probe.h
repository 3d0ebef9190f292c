#pragma once
// What this machine can do at best, measured in the same run as what is held against it.

#include <vector>

namespace still::command {

/// Billions a second. Copies count bytes read and bytes written.
struct MachineLimits {
    int threads = 1;
    double copy = 0, stream = 0;      ///< through memory: ordinary and streaming stores
    double l3_copy = 0, l2_copy = 0;  ///< within 8 MB and 512 KB per thread
    double mul_high = 0, add = 0;     ///< 16-bit lanes
    double divide = 0;                ///< float lanes
    double gather = 0;                ///< 32-bit texels from 1 MB, by a vector of indices
};

/// About a third of a second for each of the thread counts.
std::vector<MachineLimits> measureMachine(const std::vector<int>& threads);

}  // namespace still::command
