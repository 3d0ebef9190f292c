#pragma once
// What `stillframe bench` prints.

#include <string>

#include "demos/stillframe/bench_probe.h"
#include "demos/stillframe/bench_run.h"

namespace still::command {

struct BenchReport {
    std::vector<BenchResult> results;
    std::vector<MachineLimits> machine;  ///< one per number of threads
};

std::string benchJson(const BenchReport& report);
/// A table for every result.
std::string benchLines(const BenchReport& report);

}  // namespace still::command
