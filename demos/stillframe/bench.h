#pragma once
// stillframe bench

#include <optional>
#include <string>
#include <vector>

#include "demos/stillframe/options.h"

namespace still::command {

/// As it was typed.
struct BenchOptions {
    std::vector<std::string> scenes;  ///< empty: the built-in ones, and Sponza when it is found
    std::optional<Size> resolution;   ///< empty: 1920x1080, or the camera file's
    std::string threads;              ///< comma-separated numbers; empty: all cores
    int frames = 72;
    std::string cameras;
    std::string simd;  ///< empty: the best
    bool json = false;
    bool quiet = false;
    Limits limits;
};

/// "1,2,4", each 1 … 256.
Outcome<std::vector<int>> parseThreads(const std::string& text);

/// Measures every scene in every motion that it has and prints times, counters, traffic, scaling
/// and hashes.
Outcome<void> bench(const BenchOptions& options);

}  // namespace still::command
