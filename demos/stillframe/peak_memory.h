#pragma once
// The most memory that was resident at once.

#include <cstdint>

namespace still::command {

/// Since the start of the process, or since the last reset.
uint64_t peakMemoryBytes();

/// Gives free memory back and starts anew, where the system allows it (Linux).
void resetPeakMemory();

}  // namespace still::command
